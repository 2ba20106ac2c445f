// SPDX-License-Identifier: MIT
#pragma once

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
