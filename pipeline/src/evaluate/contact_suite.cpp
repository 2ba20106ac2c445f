// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "evaluate/suite.hpp"
#include "evaluate/wall_press.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"

namespace papilla {
namespace {

/// Stabilization of a wall.
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

void press(const Case& input, const Guard& guard, StabilityCell& cell) {
  DeviceCaps caps = device_preset("touch").caps();
  if (input.delay_s > 0) caps.dynamics.delay_s = input.delay_s;
  const double limit =
      stiffness_limit(caps.dynamics, 1 / input.rate_hz, std::min(input.damping, caps.dynamics.damping / 2));
  const WallResponse response = press_wall(
      caps, {input.stiffness, input.damping, input.rate_hz, WallPress{}.seconds, guard.clamp, guard.control});
  cell.error = response.rest_speed_m_per_s;
  cell.residual = response.given_j.back();
  cell.note = fmt::format("passive up to {:.4g} N/m; felt {:.4g} N/m, {:.3g} N·s/m; largest force {:.3g} N", limit,
                          response.stiffness, response.damping, response.largest_force_n);
  if (*cell.error > k_still_m_per_s) cell.outcome = Outcome::breaks;
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

}  // namespace papilla
