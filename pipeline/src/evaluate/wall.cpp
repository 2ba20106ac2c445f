// SPDX-License-Identifier: MIT

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "evaluate/kinds.hpp"
#include "evaluate/wall_press.hpp"
#include "papilla/haptic/sim_device.hpp"
#include "papilla/haptic/stability.hpp"

namespace papilla {
namespace {

constexpr double k_rate_hz = 1000;
constexpr const char* k_limit_error = "stiffness at which a wall shakes / closed form - 1";
/// Bisection of the logarithm of the stiffness between the closed form and a wall that is unstable.
constexpr double k_most_times = 4096;
constexpr int k_steps = 8;
constexpr double k_press_s = 1.5;
/// Passivity is tested at this multiple of the limit, for this time.
constexpr double k_too_stiff = 8, k_seconds = 4;
constexpr std::array k_report_times_s = {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0};

struct Guard {
  const char* name;
  bool clamp, control;
};
constexpr std::array<Guard, 3> k_guards = {
    {{"as asked", false, false}, {"controller", false, true}, {"limit", true, false}}};

struct Wall {
  std::string device;
  DeviceCaps caps;
  double damping, limit;
};

bool is_unstable(const Wall& wall, double stiffness) {
  return press_wall(wall.caps, {.stiffness = stiffness, .damping = wall.damping, .seconds = k_press_s})
             .rest_speed_m_per_s > k_still_m_per_s;
}

EvaluationRun stability_limit_run(const EvaluationInput& input, const Wall& wall) {
  EvaluationRun run{"stability-limit", wall.device, input.name, k_limit_error, {}, "direct"};
  const Stopwatch clock;
  double holds = wall.limit, breaks = wall.limit;
  const auto record = [&] { run.trace.push_back({clock.seconds(), std::sqrt(holds * breaks) / wall.limit - 1}); };
  while (breaks < k_most_times * wall.limit && !input.budget.spent()) {
    if (is_unstable(wall, breaks)) break;
    holds = breaks, breaks *= 2;
  }
  if (holds == breaks) {
    run.notes = fmt::format("closed form {:.4g} N/m: shakes there already, for the hand has no damping", wall.limit);
    run.valid = false;
  }
  for (int step = 0; step < k_steps && holds < breaks && !input.budget.spent(); ++step) {
    record();
    const double middle = std::sqrt(holds * breaks);
    (is_unstable(wall, middle) ? breaks : holds) = middle;
  }
  if (holds < breaks) {
    record();
    run.notes = fmt::format("closed form {:.4g} N/m; pressed for {:g} s, {:.4g} N/m holds and {:.4g} N/m shakes",
                            wall.limit, k_press_s, holds, breaks);
  }
  return run;
}

EvaluationRun passivity_run(const EvaluationInput& input, const Wall& wall, const Guard& guard) {
  EvaluationRun run{"passivity", wall.device + ", " + guard.name, input.name, "energy given to the hand [J]", {},
                    "direct"};
  const Stopwatch clock;
  const WallResponse response =
      press_wall(wall.caps, {k_too_stiff * wall.limit, wall.damping, k_rate_hz, k_seconds, guard.clamp, guard.control});
  const double seconds = clock.seconds();
  for (const double at : k_report_times_s) {
    const auto tick = std::min(static_cast<std::size_t>(at * k_rate_hz), response.given_j.size()) - 1;
    run.trace.push_back({seconds * at / k_seconds, response.given_j[tick]});
  }
  run.notes = fmt::format("{:.4g} N/m asked for, {:.4g} N/m felt, {:g} s of the wall, largest force {:.3g} N",
                          k_too_stiff * wall.limit, response.stiffness, k_seconds, response.largest_force_n);
  run.valid = response.rest_speed_m_per_s <= k_still_m_per_s;
  return run;
}

}  // namespace

std::vector<EvaluationRun> wall_runs(const EvaluationInput& input, double damping) {
  std::vector<EvaluationRun> runs;
  const auto presets = device_presets();
  for (std::size_t i = 0; i < presets.size(); ++i) {
    const DevicePreset& preset = presets[i];
    EvaluationInput own = input;
    own.budget = input.budget.share(presets.size() - i);
    Wall wall{std::string(preset.name), preset.caps(), 0, 0};
    wall.damping = std::min(damping, wall.caps.dynamics.damping / 2);
    wall.limit = stiffness_limit(wall.caps.dynamics, 1 / k_rate_hz, wall.damping);
    if (!(wall.limit > 0) || own.budget.spent()) {
      runs.push_back({"stability-limit",
                      wall.device,
                      input.name,
                      k_limit_error,
                      {},
                      wall.limit > 0 ? k_time_spent : "no wall is passive: the device has no damping"});
      continue;
    }
    runs.push_back(stability_limit_run(own, wall));
    for (const Guard& guard : k_guards) runs.push_back(passivity_run(own, wall, guard));
  }
  return runs;
}

}  // namespace papilla
