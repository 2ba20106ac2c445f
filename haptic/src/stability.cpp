// SPDX-License-Identifier: MIT
#include "papilla/haptic/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace papilla {

double stiffness_limit(const DeviceDynamics& d, double period_s, double wall_damping) noexcept {
  const double held = 2 * (d.damping - std::abs(wall_damping)) / (period_s + 2 * d.delay_s);
  const double rounded =
      d.encoder_step_m > 0 ? 2 * d.friction_n / d.encoder_step_m : std::numeric_limits<double>::infinity();
  return std::max(0.0, std::min(held, rounded));
}

std::vector<StabilityClamp> clamp_to_stable(ContactSurface& surface, const DeviceDynamics& device, double period_s) {
  std::vector<StabilityClamp> clamps;
  for (std::uint32_t i = 0; i < surface.material_count(); ++i) {
    ContactMaterial& material = surface.material(i);
    StabilityClamp clamp{i, material.stiffness, 0, material.damping, 0};
    material.damping = std::min(material.damping, device.damping / 2);
    material.stiffness = std::min(material.stiffness, stiffness_limit(device, period_s, material.damping));
    clamp.stiffness = material.stiffness;
    clamp.damping = material.damping;
    if (clamp.stiffness < clamp.stiffness_wanted || clamp.damping < clamp.damping_wanted) clamps.push_back(clamp);
  }
  return clamps;
}

}  // namespace papilla
