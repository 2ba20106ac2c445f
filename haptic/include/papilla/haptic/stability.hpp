// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"

namespace papilla {

/// Largest stiffness in N/m of a sampled wall that a device holds passively:
///     K ≤ min( 2(b − |B|)/(T + 2·t_d), 2·f_c/Δ )
/// b device damping, B wall damping, T period, t_d delay [Colgate and Brown 1994], f_c Coulomb friction, Δ encoder step
/// [Abbott and Okamura 2005]. 0 when b ≤ |B|; without encoder steps only the first term counts.
double stiffness_limit(const DeviceDynamics& device, double period_s, double wall_damping) noexcept;

/// Watches the energy that a contact has given to the hand, and softens it while that is too much: the observer of
/// time-domain passivity control [Hannaford and Ryu 2002]. With F the force that acted on the hand (as it was written
/// t_d before), Δx the way of the device in a period T and b the damping of the device itself, which burns some of it,
///     E ← E − F·Δx + b·|Δx|²/T
/// is what the hand has put in. Each time that it falls below zero all forces become a tenth smaller and E starts again
/// from zero; without that they recover over ten seconds. (The damping that the paper adds arrives too late on a bus
/// with frames and makes things worse.) Only an estimate when the position is read in steps: it helps where a limit was
/// stated too high, it replaces none. noexcept, no allocation.
class PassivityController {
 public:
  explicit PassivityController(const DeviceDynamics& device) noexcept
      : damping_(device.damping), delay_s_(device.delay_s) {}

  /// @param force_n the force that is to be written. @param moved_m the way since the position before.
  /// @returns the force, softened by share().
  Vec3 apply(Vec3 force_n, Vec3 moved_m, double period_s) noexcept;

  double energy_j() const noexcept { return energy_; }
  double share() const noexcept { return share_; }                         ///< Of the force that is let through.
  std::uint64_t interventions() const noexcept { return interventions_; }  ///< How often it was made smaller.

 private:
  static constexpr std::size_t k_history = 64;
  double damping_, delay_s_, energy_ = 0, share_ = 1;
  std::uint64_t interventions_ = 0, tick_ = 0;
  std::array<Vec3, k_history> written_{};
};

/// What was taken back of one material.
struct StabilityClamp {
  std::uint32_t material = 0;
  double stiffness_wanted = 0, stiffness = 0;
  double damping_wanted = 0, damping = 0;
};

/// Makes every material of the surface stable: damping down to b/2 where it is more, then stiffness to the limit.
/// @returns the materials that were changed, in order.
std::vector<StabilityClamp> clamp_to_stable(ContactSurface& surface, const DeviceDynamics& device, double period_s);

}  // namespace papilla
