// SPDX-License-Identifier: MIT
#include "pipeline/fit_strokes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/haptic_loop.hpp"
#include "papilla/haptic/sim_device.hpp"

namespace papilla::testing {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Along x from the middle, and how deep.
struct Place {
  double x = 0, depth = 0;
};

}  // namespace

Trajectory hand_of(const HandPlan& plan) {
  constexpr double k_step_s = 1e-3, k_part_s = 2, k_high_m = 5e-3, k_swing_m = 0.035, k_press_hz = 5;
  std::vector<Trajectory::Sample> samples;
  double t = 0, phase = 0;
  const auto add = [&](Place p) {
    samples.push_back({t, {0.05 + p.x, 0.05, p.depth > 0 ? -p.depth : k_high_m}});
    t += k_step_s;
  };
  const auto go = [&](const auto& place) {
    for (double s = 0; s < k_part_s; s += k_step_s) add(place(s));
  };
  const double deep = plan.depth_m;
  const auto breathing = [&](double s) { return deep * (1 + 0.4 * std::sin(2 * k_pi * 3 * s)); };
  for (double s = 0; s < 0.3; s += k_step_s) add({0, 0});
  if (plan.presses) go([&](double s) { return Place{0, deep * (1 + 0.8 * std::sin(2 * k_pi * k_press_hz * s))}; });
  if (plan.rests) go([&](double) { return Place{0, deep}; });
  const auto swing = [&](double rad_per_s) {
    go([&](double s) {
      phase += rad_per_s * k_step_s;
      return Place{k_swing_m * std::sin(phase), breathing(s)};
    });
  };
  if (plan.crawls) swing(0.35);
  if (plan.hurries) swing(6);
  if (plan.steadily)
    go([&](double s) {
      constexpr double k_speed = 0.08;
      const double way = std::fmod(k_speed * s, 4 * k_swing_m);
      return Place{way < k_swing_m ? way : way < 3 * k_swing_m ? 2 * k_swing_m - way : way - 4 * k_swing_m, deep};
    });
  if (samples.size() < 400) go([](double) { return Place{}; });
  return Trajectory(std::move(samples));
}

ContactSurface flat_plate(const ContactMaterial& material) {
  return ContactSurface(plate(10, 10, 0.1, 0.1), {material}, {}, 5e-4);
}

std::vector<StrokeSample> record_stroke(const ContactSurface& surface, const Trajectory& hand, double max_force_n) {
  DeviceCaps caps;
  caps.name = "bench";
  caps.max_force_n = max_force_n;
  caps.workspace_radius_m = 0.2;
  caps.dynamics.mass_kg = 0.05;
  caps.dynamics.damping = 10;
  SimDevice device(caps, hand, 1e-3);
  std::vector<RecordRow> rows;
  LoopOptions options;
  options.ticks = static_cast<std::uint64_t>(hand.end_s() * 1e3);
  options.paced = false;
  options.hand = &hand;
  options.record = &rows;
  run_haptic_loop(device, surface, options);
  return parse_stroke_recording(record_csv(rows), "stroke.csv");
}

void add_force_noise(std::vector<StrokeSample>& stroke, double share, std::uint64_t seed) {
  double largest = 0;
  for (const StrokeSample& sample : stroke) largest = std::max(largest, norm(sample.force_n));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, share * largest);
  for (StrokeSample& sample : stroke)
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) sample.force_n.*axis += noise(random);
}

std::vector<StrokeSample> seen_from_outside(std::vector<StrokeSample> stroke) {
  const Vec3 x = normalized({0.6, 0.5, -0.4}), z = normalized(cross(x, {0.1, 1, 0.7})), y = cross(z, x);
  const auto turned = [&](Vec3 v) { return v.x * x + v.y * y + v.z * z; };
  for (StrokeSample& sample : stroke) {
    sample.proxy_m.reset();
    sample.probe_m = turned(sample.probe_m) + Vec3{0.3, -0.2, 1.1};
    sample.force_n = turned(sample.force_n);
  }
  return stroke;
}

}  // namespace papilla::testing
