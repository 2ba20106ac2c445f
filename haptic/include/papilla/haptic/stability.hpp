// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/device.hpp"

namespace papilla {

/// Largest stiffness in N/m of a sampled wall that is passive on a device:
///     K ≤ min( 2(b − |B|)/(T + 2·t_d), 2·f_c/Δ )
/// b device damping, B wall damping, T period, t_d delay [Colgate and Brown 1994], f_c Coulomb friction, Δ encoder step
/// [Abbott and Okamura 2005]. 0 when b ≤ |B|; only the first term when Δ = 0.
double stiffness_limit(const DeviceDynamics& device, double period_s, double wall_damping) noexcept;

/// Observes the energy of a contact and softens it when it is active: the passivity observer of time-domain passivity
/// control [Hannaford and Ryu 2002]. With F the force acting on the hand (written t_d before), Δx the displacement of
/// the device in a period T and b its damping, which dissipates,
///     E ← E − F·Δx + b·|Δx|²/T
/// is the energy that the hand has put in. When E < 0, all forces are scaled by a further 0.9 and E is set to 0;
/// otherwise the scale recovers to 1 over ten seconds. (The damping injected in the paper arrives too late on a bus
/// with frames and destabilises.) With quantised positions it is an estimate: it helps where the device's numbers are
/// stated too well, and does not replace clamp_to_stable(). noexcept, no allocation.
class PassivityController {
 public:
  explicit PassivityController(const DeviceDynamics& device) noexcept
      : damping_(device.damping), delay_s_(device.delay_s) {}

  /// @param force_n the force to be written. @param moved_m displacement since the last position.
  /// @returns the force, softened by share().
  Vec3 apply(Vec3 force_n, Vec3 moved_m, double period_s) noexcept;

  double energy_j() const noexcept { return energy_; }
  double share() const noexcept { return share_; }                         ///< Present scale of the forces.
  std::uint64_t interventions() const noexcept { return interventions_; }  ///< How often the scale was reduced.

 private:
  static constexpr std::size_t k_history = 64;
  double damping_, delay_s_, energy_ = 0, share_ = 1;
  std::uint64_t interventions_ = 0, tick_ = 0;
  std::array<Vec3, k_history> written_{};
};

/// The reduction of one material: of the stiffest and the most damped place of its maps, of the stiffer one of skin and
/// backing.
struct StabilityClamp {
  std::uint32_t material = 0;
  double stiffness_wanted = 0, stiffness = 0;
  double damping_wanted = 0, damping = 0;
};

/// Makes every material of the surface stable: damping is limited to b/2, then stiffness to the stiffness_limit() of
/// the largest damping that is left; so are those of maps, and of backings, with the stiffness of which a contact is
/// felt beyond their depth. What is below the limit stays as it is.
/// @returns the reduced materials, in order.
std::vector<StabilityClamp> clamp_to_stable(ContactSurface& surface, const DeviceDynamics& device, double period_s);

}  // namespace papilla
