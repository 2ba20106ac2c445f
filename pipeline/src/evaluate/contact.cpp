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

/// Forces are compared at these times, which every rate has a tick at.
constexpr double k_base_hz = 1000;
constexpr std::array k_rates_hz = {1000.0, 2000.0, 4000.0, 8000.0, 16000.0};
constexpr double k_reference_hz = 64000;
/// Shortest waves that are left of the relief, mm.
constexpr std::array k_waves_mm = {4.0, 2.0, 1.0, 0.5, 0.2, 0.1};
constexpr const char* k_rate_error = "rms force error against the same stroke at 64 kHz [N]";
constexpr double k_seconds = 1, k_ball_m = 1e-3, k_growth = 2;

struct Felt {
  std::vector<Vec3> force;  ///< At k_base_hz.
  double tick_seconds = 0;  ///< All ticks of the run, per second of contact.
  int lost = 0;
};

/// The hand goes its way, whatever it feels: only the tick is under test.
Felt feel(const ContactSurface& surface, const Trajectory& hand, double rate_hz) {
  SafetyLimits limits = safety_limits(1e6);
  limits.soft_start_s = 0;
  const double period = 1 / rate_hz;
  const auto tick = std::make_unique<HapticTick>(surface, limits, period);
  const auto ticks = static_cast<long>(std::llround((hand.end_s() - hand.start_s()) * rate_hz));
  const long every = std::lround(rate_hz / k_base_hz);
  Felt felt;
  tick->reset(hand.position(hand.start_s()));
  const Stopwatch clock;
  for (long i = 1; i <= ticks; ++i) {
    const Vec3 force = (*tick)({hand.position(hand.start_s() + static_cast<double>(i) * period)});
    felt.lost += tick->lost();
    if (i % every == 0) felt.force.push_back(force);
  }
  felt.tick_seconds = clock.seconds() / (hand.end_s() - hand.start_s());
  return felt;
}

double rms_difference(const Felt& a, const Felt& b) {
  double sum = 0;
  const std::size_t n = std::min(a.force.size(), b.force.size());
  for (std::size_t i = 0; i < n; ++i) sum += dot(a.force[i] - b.force[i], a.force[i] - b.force[i]);
  return n == 0 ? 0 : std::sqrt(sum / static_cast<double>(n));
}

double rms(const Felt& felt) { return rms_difference(felt, {std::vector<Vec3>(felt.force.size()), 0, 0}); }

struct Stage {
  ContactSurface surface;
  std::uint32_t material;
  Vec3 centre;
  double samples;  ///< Of all height maps.
};

/// What of a file is felt, and by which probe.
struct Touch {
  double radius_m;
  bool friction, relief;

  std::string name() const {
    std::string text = radius_m > 0 ? fmt::format("ball of {:g} mm", 1e3 * radius_m) : "point";
    if (!friction) text += ", no friction";
    if (!relief) text += ", no relief";
    return text;
  }
};
constexpr std::array<Touch, 8> k_touches = {{{0, true, true},
                                             {k_ball_m, true, true},
                                             {0, true, false},
                                             {k_ball_m, true, false},
                                             {0, false, true},
                                             {k_ball_m, false, true},
                                             {0, false, false},
                                             {k_ball_m, false, false}}};

Stage stage_of(const Scene& scene, const std::string& file, const Touch& touch, double shortest_wave_m) {
  HapticScene haptic =
      haptic_scene(scene, file, {.probe_radius_m = touch.radius_m, .shortest_wave_m = shortest_wave_m});
  const LargestMaterial largest = largest_material(haptic);
  for (ContactMaterial& material : haptic.materials) {
    if (!touch.friction) material.static_friction = material.dynamic_friction = 0;
    if (!touch.relief) material.height.reset();
  }
  double samples = 0;
  for (const HeightField& height : haptic.heights) samples += 1.0 * height.width() * height.height();
  return {ContactSurface(haptic.mesh, haptic.materials, std::move(haptic.heights), touch.radius_m), largest.material,
          largest.centre, samples};
}

EvaluationRun over_rates(const EvaluationInput& input, const Touch& touch, const Stage& stage, const Trajectory& hand) {
  EvaluationRun run{"proxy", touch.name(), input.name, k_rate_error, {}, "direct"};
  const Felt reference = feel(stage.surface, hand, k_reference_hz);
  run.notes = fmt::format("rms force {:.3g} N; ", rms(reference));
  Rungs rungs(input.budget, k_growth);
  for (const double rate : k_rates_hz) {
    if (!rungs.next()) break;
    const Felt felt = feel(stage.surface, hand, rate);
    run.trace.push_back({felt.tick_seconds, rms_difference(felt, reference)});
    run.notes += fmt::format("{:g} kHz: {:.2g} µs a tick, {} contacts lost; ", rate / 1000,
                             1e6 * felt.tick_seconds / rate, felt.lost);
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  if (touch.relief)
    run.notes +=
        "a proxy on a relief can come to rest in one valley or the next, and friction decides where: there the "
        "difference between two rates does not vanish";
  return run;
}

EvaluationRun over_detail(const EvaluationInput& input, const Scene& scene, const Touch& touch, const Trajectory& hand,
                          const Felt& whole) {
  EvaluationRun run{"relief", touch.name(), input.name, "rms force error against the whole relief, 1 kHz [N]",
                    {},       "direct"};
  Rungs rungs(input.budget, k_growth);
  for (const double wave : k_waves_mm) {
    if (!rungs.next()) break;
    const Stage stage = stage_of(scene, input.file, touch, 1e-3 * wave);
    const Felt felt = feel(stage.surface, hand, k_base_hz);
    run.trace.push_back({felt.tick_seconds, rms_difference(felt, whole)});
    run.notes += fmt::format("waves from {:g} mm: {:.3g} million samples; ", wave, 1e-6 * stage.samples);
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  return run;
}

}  // namespace

std::vector<EvaluationRun> evaluate_contact(const EvaluationInput& input) {
  const Scene scene = read_gltf(input.file);
  std::vector<EvaluationRun> runs;
  std::vector<EvaluationRun> walls;
  for (std::size_t i = 0; i < k_touches.size(); ++i) {
    const Touch& touch = k_touches[i];
    if (input.budget.spent()) {
      runs.push_back({"proxy", touch.name(), input.name, k_rate_error, {}, k_time_spent});
      continue;
    }
    const Stage stage = stage_of(scene, input.file, touch, 0);
    EvaluationInput own = input;
    own.budget = input.budget.share(k_touches.size() + 1 - i);
    if (walls.empty()) walls = wall_runs(own, stage.surface.material(stage.material).damping);
    own.budget = input.budget.share(k_touches.size() - i);
    const Trajectory hand = press_and_stroke(stage.surface, stage.material, stage.centre, {.seconds = k_seconds});
    runs.push_back(over_rates(own, touch, stage, hand));
    if (touch.relief) runs.push_back(over_detail(own, scene, touch, hand, feel(stage.surface, hand, k_base_hz)));
    report_progress(input.progress, "contact", static_cast<double>(i + 1) / static_cast<double>(k_touches.size()));
  }
  std::move(walls.begin(), walls.end(), std::back_inserter(runs));
  return runs;
}

}  // namespace papilla
