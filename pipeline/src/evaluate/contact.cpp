// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>

#include "evaluate/kinds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/haptic/stroke.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace papilla {
namespace {

/// Forces are compared at this rate: every rate has a tick at each of its ticks.
constexpr double k_base_hz = 1000;
constexpr std::array k_rates_hz = {1000.0, 2000.0, 4000.0, 8000.0, 16000.0};
constexpr double k_reference_hz = 64000;
/// Shortest wavelengths left in the relief.
constexpr std::array k_waves_mm = {4.0, 2.0, 1.0, 0.5, 0.2, 0.1};
constexpr const char* k_rate_error = "rms force error against the same stroke at 64 kHz [N]";
constexpr double k_seconds = 1, k_ball_m = k_default_probe_radius_m, k_growth = 2;

struct StrokeForces {
  std::vector<Vec3> at_base_rate;  ///< At k_base_hz, N.
  double tick_seconds = 0;         ///< All ticks of the run, per second of contact.
  int lost = 0;                    ///< Contacts lost.
};

/// Runs the ticks along a prescribed path of the hand, on which the forces have no influence.
StrokeForces run_stroke(const ContactSurface& surface, const Trajectory& hand, double rate_hz) {
  SafetyLimits limits = safety_limits(1e6);
  limits.soft_start_s = 0;
  const double period = 1 / rate_hz;
  const auto tick = std::make_unique<HapticTick>(surface, limits, period);
  const auto ticks = static_cast<long>(std::llround((hand.end_s() - hand.start_s()) * rate_hz));
  const long every = std::lround(rate_hz / k_base_hz);
  StrokeForces forces;
  tick->reset(hand.position(hand.start_s()));
  const Stopwatch clock;
  for (long i = 1; i <= ticks; ++i) {
    const Vec3 force = (*tick)({hand.position(hand.start_s() + static_cast<double>(i) * period)});
    forces.lost += tick->lost();
    if (i % every == 0) forces.at_base_rate.push_back(force);
  }
  forces.tick_seconds = clock.seconds() / (hand.end_s() - hand.start_s());
  return forces;
}

double rms_difference(const StrokeForces& a, const StrokeForces& b) {
  double sum = 0;
  const std::size_t n = std::min(a.at_base_rate.size(), b.at_base_rate.size());
  for (std::size_t i = 0; i < n; ++i)
    sum += dot(a.at_base_rate[i] - b.at_base_rate[i], a.at_base_rate[i] - b.at_base_rate[i]);
  return n == 0 ? 0 : std::sqrt(sum / static_cast<double>(n));
}

double rms(const StrokeForces& forces) {
  return rms_difference(forces, {std::vector<Vec3>(forces.at_base_rate.size()), 0, 0});
}

struct ContactCase {
  ContactSurface surface;
  std::uint32_t material;
  Vec3 centre;
  double samples;  ///< Of all height maps.
};

/// The probe and the effects that are switched on.
struct ProbeCase {
  double radius_m;
  bool friction, relief;

  std::string name() const {
    std::string text = radius_m > 0 ? fmt::format("ball of {:g} mm", 1e3 * radius_m) : "point";
    if (!friction) text += ", no friction";
    if (!relief) text += ", no relief";
    return text;
  }
};
constexpr std::array<ProbeCase, 8> k_probe_cases = {{{0, true, true},
                                                     {k_ball_m, true, true},
                                                     {0, true, false},
                                                     {k_ball_m, true, false},
                                                     {0, false, true},
                                                     {k_ball_m, false, true},
                                                     {0, false, false},
                                                     {k_ball_m, false, false}}};

ContactCase contact_case(const Scene& scene, const std::string& file, const ProbeCase& probe, double shortest_wave_m) {
  HapticScene haptic =
      haptic_scene(scene, file, {.probe_radius_m = probe.radius_m, .shortest_wave_m = shortest_wave_m});
  const LargestMaterial largest = largest_material(haptic);
  for (ContactMaterial& material : haptic.materials) {
    if (!probe.friction) material.static_friction = material.dynamic_friction = 0, material.channels.reset();
    if (!probe.relief) material.height.reset();
  }
  double samples = 0;
  for (const HeightField& height : haptic.heights) samples += 1.0 * height.width() * height.height();
  try {
    return {ContactSurface(haptic.mesh, haptic.materials, std::move(haptic.heights), probe.radius_m,
                           std::move(haptic.channels)),
            largest.material, largest.centre, samples};
  } catch (const InvalidInput& error) {
    throw InvalidInput(file + ": " + error.what());
  }
}

EvaluationRun over_rates(const EvaluationInput& input, const ProbeCase& probe, const ContactCase& contact,
                         const Trajectory& hand) {
  EvaluationRun run{"proxy", probe.name(), input.name, k_rate_error, {}, "direct"};
  const StrokeForces reference = run_stroke(contact.surface, hand, k_reference_hz);
  run.notes = fmt::format("rms force {:.3g} N; ", rms(reference));
  Ladder ladder(input.budget, k_growth);
  for (const double rate : k_rates_hz) {
    if (!ladder.next()) break;
    const StrokeForces forces = run_stroke(contact.surface, hand, rate);
    run.trace.push_back({forces.tick_seconds, rms_difference(forces, reference)});
    run.notes += fmt::format("{:g} kHz: {:.2g} µs a tick, {} contacts lost; ", rate / 1000,
                             1e6 * forces.tick_seconds / rate, forces.lost);
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  if (probe.relief)
    run.notes +=
        "a proxy on a relief can come to rest in one valley or the next, and friction decides where: there the "
        "difference between two rates does not vanish";
  return run;
}

EvaluationRun over_detail(const EvaluationInput& input, const Scene& scene, const ProbeCase& probe,
                          const Trajectory& hand, const StrokeForces& whole) {
  EvaluationRun run{"relief", probe.name(), input.name, "rms force error against the whole relief, 1 kHz [N]",
                    {},       "direct"};
  Ladder ladder(input.budget, k_growth);
  for (const double wave : k_waves_mm) {
    if (!ladder.next()) break;
    const ContactCase contact = contact_case(scene, input.file, probe, 1e-3 * wave);
    const StrokeForces forces = run_stroke(contact.surface, hand, k_base_hz);
    run.trace.push_back({forces.tick_seconds, rms_difference(forces, whole)});
    run.notes += fmt::format("waves from {:g} mm: {:.3g} million samples; ", wave, 1e-6 * contact.samples);
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  return run;
}

}  // namespace

std::vector<EvaluationRun> evaluate_contact(const EvaluationInput& input) {
  const Scene scene = read_gltf(input.file);
  std::vector<EvaluationRun> runs;
  std::vector<EvaluationRun> walls;
  for (std::size_t i = 0; i < k_probe_cases.size(); ++i) {
    const ProbeCase& probe = k_probe_cases[i];
    if (input.budget.spent()) {
      runs.push_back({"proxy", probe.name(), input.name, k_rate_error, {}, k_time_spent});
      continue;
    }
    const ContactCase contact = contact_case(scene, input.file, probe, 0);
    EvaluationInput own = input;
    own.budget = input.budget.share(k_probe_cases.size() + 1 - i);
    if (walls.empty()) walls = wall_runs(own, contact.surface.material(contact.material).damping);
    own.budget = input.budget.share(k_probe_cases.size() - i);
    const Trajectory hand = press_and_stroke(contact.surface, contact.material, contact.centre, {.seconds = k_seconds});
    runs.push_back(over_rates(own, probe, contact, hand));
    if (probe.relief)
      runs.push_back(over_detail(own, scene, probe, hand, run_stroke(contact.surface, hand, k_base_hz)));
    report_progress(input.progress, "contact", static_cast<double>(i + 1) / static_cast<double>(k_probe_cases.size()));
  }
  std::move(walls.begin(), walls.end(), std::back_inserter(runs));
  return runs;
}

}  // namespace papilla
