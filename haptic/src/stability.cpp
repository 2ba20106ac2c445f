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

Vec3 PassivityController::apply(Vec3 force_n, Vec3 moved_m, double period_s) noexcept {
  constexpr double k_softer = 0.9, k_least = 0.05, k_recovery_s = 10;
  const auto late = std::min<std::uint64_t>(k_history - 1, 1 + static_cast<std::uint64_t>(delay_s_ / period_s + 0.5));
  const Vec3 acted = tick_ >= late ? written_[(tick_ - late) % k_history] : Vec3{};
  energy_ += damping_ * dot(moved_m, moved_m) / period_s - dot(acted, moved_m);
  if (energy_ < 0) {
    share_ = std::max(k_least, k_softer * share_);
    energy_ = 0;
    ++interventions_;
  } else {
    share_ = std::min(1.0, share_ + period_s / k_recovery_s);
  }
  const Vec3 softened = share_ < 1 ? share_ * force_n : force_n;
  written_[tick_++ % k_history] = softened;
  return softened;
}

std::vector<StabilityClamp> clamp_to_stable(ContactSurface& surface, const DeviceDynamics& device, double period_s) {
  std::vector<StabilityClamp> clamps;
  for (std::uint32_t i = 0; i < surface.material_count(); ++i) {
    ContactMaterial& material = surface.material(i);
    const bool has_backing = std::isfinite(material.backing_depth_m);
    StabilityClamp clamp{i, surface.most(i, Quantity::stiffness), 0, surface.most(i, Quantity::damping), 0};
    if (has_backing) clamp.stiffness_wanted = std::max(clamp.stiffness_wanted, material.backing_stiffness);
    clamp.damping = std::min(clamp.damping_wanted, device.damping / 2);
    const double limit = stiffness_limit(device, period_s, clamp.damping);
    clamp.stiffness = std::min(clamp.stiffness_wanted, limit);
    material.most_damping = clamp.damping;
    material.damping = std::min(material.damping, clamp.damping);
    material.most_stiffness = limit;
    material.stiffness = std::min(material.stiffness, limit);
    material.backing_stiffness = std::min(material.backing_stiffness, limit);
    if (clamp.stiffness < clamp.stiffness_wanted || clamp.damping < clamp.damping_wanted) clamps.push_back(clamp);
  }
  return clamps;
}

}  // namespace papilla
