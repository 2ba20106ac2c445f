// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "evaluate/stability/stability.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"

namespace papilla::app {
namespace {

/// What keeps a wall from shaking the hand.
struct Guard {
  const char* name;
  bool clamp, control;
};
constexpr std::array<Guard, 4> k_guards = {{{"as asked", false, false},
                                            {"limit", true, false},
                                            {"passivity controller", false, true},
                                            {"limit and controller", true, true}}};

struct Case {
  std::string name;
  double stiffness = 500, damping = 0, rate_hz = 1000, delay_s = 0;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double k : {1e0, 1e2, 1e3, 1e4, 1e6}) all.push_back({fmt::format("{:g} N/m", k), k});
  for (const double rate : {100.0, 2000.0, 4000.0, 10000.0})
    all.push_back({fmt::format("2000 N/m at {:g} Hz", rate), 2000, 0, rate});
  for (const double delay : {0.001, 0.005, 0.02})
    all.push_back({fmt::format("500 N/m, {:g} ms late", 1e3 * delay), 500, 0, 1000, delay});
  for (const double damping : {0.1, 1.0, 100.0, 1e4})
    all.push_back({fmt::format("500 N/m, {:g} N·s/m", damping), 500, damping});
  return all;
}

ContactMesh square(double side_m) {
  ContactMesh mesh;
  mesh.positions = {{0, 0, 0}, {side_m, 0, 0}, {side_m, side_m, 0}, {0, side_m, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// A light hand comes down on the wall at half a metre a second and rests there for three seconds.
void press(const Case& input, const Guard& guard, StabilityCell& cell) {
  constexpr double side = 0.2, seconds = 3, last_s = 0.3, still_m_per_s = 1e-2;
  const double period = 1 / input.rate_hz;
  DeviceCaps caps = device_preset("touch").caps();
  if (input.delay_s > 0) caps.dynamics.delay_s = input.delay_s;
  ContactMaterial wall;
  wall.stiffness = input.stiffness;
  wall.damping = input.damping;
  ContactSurface surface(square(side), {wall}, {}, 0);
  const double limit = stiffness_limit(caps.dynamics, period, std::min(input.damping, caps.dynamics.damping / 2));
  if (guard.clamp) clamp_to_stable(surface, caps.dynamics, period);
  const Trajectory hand(
      std::vector<Trajectory::Sample>{{0, {side / 2, side / 2, 5e-3}}, {0.03, {side / 2, side / 2, -1e-2}}});
  SimDevice device(caps, hand, period, {.stiffness = 300, .damping = 0});
  SafetyLimits limits = safety_limits(1e6);
  limits.soft_start_s = 0;
  const auto tick = std::make_unique<HapticTick>(surface, limits, period);
  if (guard.control) tick->control_passivity(caps.dynamics);
  const auto ticks = static_cast<long>(seconds * input.rate_hz),
             from = static_cast<long>((seconds - last_s) * input.rate_hz);
  double sum = 0, least_j = 0, largest_n = 0;
  for (long i = 0; i < ticks; ++i) {
    DeviceState state;
    device.read(state);
    const Vec3 force = (*tick)(state);
    largest_n = std::max(largest_n, norm(force));
    device.write(force);
    least_j = std::min(least_j, device.hand_work_j());
    if (i >= from) sum += dot(device.velocity(), device.velocity());
  }
  cell.error = std::sqrt(sum / static_cast<double>(ticks - from));
  cell.residual = -least_j;
  cell.note = fmt::format("passive up to {:.4g} N/m; felt {:.4g} N/m, {:.3g} N·s/m; largest force {:.3g} N", limit,
                          surface.material(0).stiffness, surface.material(0).damping, largest_n);
  if (*cell.error > still_m_per_s) cell.outcome = Outcome::breaks;
}

}  // namespace

StabilitySuite contact_stability(const StabilityRun& run) {
  StabilitySuite suite{"contact",
                       "Contact with a wall, simulated Touch",
                       "speed of the handle once the hand should rest in m/s, rms",
                       "energy that the hand was given in J",
                       {}};
  fill_suite(suite, run, cases(), k_guards,
             [](const Guard& guard, const Case& input, StabilityCell& cell) { press(input, guard, cell); });
  return suite;
}

}  // namespace papilla::app
