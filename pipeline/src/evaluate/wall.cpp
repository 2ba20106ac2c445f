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
/// The bisection: from the closed form up, until the wall shakes, then halving the logarithm.
constexpr double k_most_times = 4096;
constexpr int k_steps = 8;
constexpr double k_press_s = 1.5;
/// Walls this many times as stiff as the limit, pressed for so long.
constexpr double k_too_stiff = 8, k_seconds = 4;
constexpr std::array k_told_at_s = {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0};

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

bool shakes(const Wall& wall, double stiffness) {
  return press_wall(wall.caps, {.stiffness = stiffness, .damping = wall.damping, .seconds = k_press_s})
             .rest_speed_m_per_s > k_still_m_per_s;
}

EvaluationRun bisected(const EvaluationInput& input, const Wall& wall) {
  EvaluationRun run{"stability-limit", wall.device, input.name, k_limit_error, {}, "direct"};
  const Stopwatch clock;
  double holds = wall.limit, breaks = wall.limit;
  const auto tell = [&] { run.trace.push_back({clock.seconds(), std::sqrt(holds * breaks) / wall.limit - 1}); };
  while (breaks < k_most_times * wall.limit && !input.budget.spent()) {
    if (shakes(wall, breaks)) break;
    holds = breaks, breaks *= 2;
  }
  if (holds == breaks) {
    run.notes = fmt::format("closed form {:.4g} N/m: shakes there already, for the hand has no damping", wall.limit);
    run.valid = false;
  }
  for (int step = 0; step < k_steps && holds < breaks && !input.budget.spent(); ++step) {
    tell();
    const double middle = std::sqrt(holds * breaks);
    (shakes(wall, middle) ? breaks : holds) = middle;
  }
  if (holds < breaks) {
    tell();
    run.notes = fmt::format("closed form {:.4g} N/m; pressed for {:g} s, {:.4g} N/m holds and {:.4g} N/m shakes",
                            wall.limit, k_press_s, holds, breaks);
  }
  return run;
}

EvaluationRun energy(const EvaluationInput& input, const Wall& wall, const Guard& guard) {
  EvaluationRun run{"passivity", wall.device + ", " + guard.name, input.name, "energy given to the hand [J]", {},
                    "direct"};
  const Stopwatch clock;
  const WallFelt felt =
      press_wall(wall.caps, {k_too_stiff * wall.limit, wall.damping, k_rate_hz, k_seconds, guard.clamp, guard.control});
  const double seconds = clock.seconds();
  for (const double at : k_told_at_s) {
    const auto tick = std::min(static_cast<std::size_t>(at * k_rate_hz), felt.given_j.size()) - 1;
    run.trace.push_back({seconds * at / k_seconds, felt.given_j[tick]});
  }
  run.notes = fmt::format("{:.4g} N/m asked for, {:.4g} N/m felt, {:g} s of the wall, largest force {:.3g} N",
                          k_too_stiff * wall.limit, felt.stiffness, k_seconds, felt.largest_force_n);
  run.valid = felt.rest_speed_m_per_s <= k_still_m_per_s;
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
    runs.push_back(bisected(own, wall));
    for (const Guard& guard : k_guards) runs.push_back(energy(own, wall, guard));
  }
  return runs;
}

}  // namespace papilla
