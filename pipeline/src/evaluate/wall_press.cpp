// SPDX-License-Identifier: MIT
#include "evaluate/wall_press.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"

namespace papilla {
namespace {

constexpr double k_side_m = 0.2, k_last_s = 0.3, k_guard_n = 1e6;

ContactSurface wall_surface(const WallPress& press) {
  ContactMesh square;
  square.positions = {{0, 0, 0}, {k_side_m, 0, 0}, {k_side_m, k_side_m, 0}, {0, k_side_m, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  ContactMaterial material;
  material.stiffness = press.stiffness;
  material.damping = press.damping;
  return {std::move(square), {material}, {}, 0};
}

}  // namespace

WallResponse press_wall(const DeviceCaps& caps, const WallPress& press) {
  const double period = 1 / press.rate_hz;
  ContactSurface surface = wall_surface(press);
  if (press.clamp) clamp_to_stable(surface, caps.dynamics, period);
  const Trajectory hand(std::vector<Trajectory::Sample>{{0, {k_side_m / 2, k_side_m / 2, 5e-3}},
                                                        {0.03, {k_side_m / 2, k_side_m / 2, -1e-2}}});
  SimDevice device(caps, hand, period, {.stiffness = 300, .damping = 0});
  SafetyLimits limits = safety_limits(k_guard_n);
  limits.soft_start_s = 0;
  const auto tick = std::make_unique<HapticTick>(surface, limits, period);
  if (press.control) tick->control_passivity(caps.dynamics);
  const auto ticks = static_cast<long>(press.seconds * press.rate_hz),
             from = std::max(0L, static_cast<long>((press.seconds - k_last_s) * press.rate_hz));
  WallResponse response{0, 0, surface.material(0).stiffness, surface.material(0).damping, {}};
  double sum = 0, least_j = 0;
  for (long i = 0; i < ticks; ++i) {
    DeviceState state;
    device.read(state);
    const Vec3 force = (*tick)(state);
    response.largest_force_n = std::max(response.largest_force_n, norm(force));
    device.write(force);
    least_j = std::min(least_j, device.hand_work_j());
    response.given_j.push_back(std::abs(least_j));
    if (i >= from) sum += dot(device.velocity(), device.velocity());
  }
  response.rest_speed_m_per_s = ticks > from ? std::sqrt(sum / static_cast<double>(ticks - from)) : 0;
  return response;
}

}  // namespace papilla
