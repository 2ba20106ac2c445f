// SPDX-License-Identifier: MIT
#include "papilla/haptic/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_step_m = 1e-3;
constexpr double k_random_turn = 0.3;      // Radians a step, in both directions.
constexpr double k_sideways = 2;           // Radians.
constexpr int k_most_turns = 8;            // At one place, before the motion ends.
constexpr int k_most_halvings = 6;         // Of the approach.
constexpr double k_off_surface = 0.01;     // Of the approach: the triangle below is no wall on the way.
constexpr double k_least_progress = 0.25;  // Of a step; with less the material has ended.

Vec3 any_tangent(Vec3 n) {
  const Vec3 axis = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Vec3{1, 0, 0}
                    : std::abs(n.y) <= std::abs(n.z)                                 ? Vec3{0, 1, 0}
                                                                                     : Vec3{0, 0, 1};
  return normalized(cross(n, axis));
}

Vec3 tangential(Vec3 direction, Vec3 n) { return normalized(direction - dot(direction, n) * n); }

/// A unit tangent turned about the normal.
Vec3 turned(Vec3 direction, Vec3 n, double angle) {
  return tangential(std::cos(angle) * direction + std::sin(angle) * cross(n, direction), n);
}

/// How far above the surface a motion begins: halved until no wall lies on the way there and the probe has room.
double free_approach(const ContactSurface& surface, const SurfacePoint& here, double approach) {
  const double radius = surface.probe_radius_m();
  for (int i = 0; i < k_most_halvings; ++i, approach *= 0.5) {
    const Vec3 from = here.point + (k_off_surface * approach) * here.face_normal;
    const Vec3 start = here.point + (radius + approach) * here.face_normal;
    if (surface.crossings(from, start) == 0 && !surface.closest_point(start, radius)) break;
  }
  return approach;
}

/// Uniform in [0, 1), the same with every standard library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

Trajectory press_and_stroke(const ContactSurface& surface, std::uint32_t material, Vec3 near,
                            const StrokeOptions& options) {
  if (!(options.speed_m_per_s > 0) || !(options.seconds > 0) || !(options.press_s > 0) || !(options.taps_per_s > 0) ||
      !(options.circle_m > 0) || !std::isfinite(options.depth_m) || !std::isfinite(options.approach_m) ||
      !(options.seconds <= 1e6))
    throw InvalidInput("press_and_stroke: speed and times must be > 0, and seconds at most a million");
  const double extent = norm(surface.high() - surface.low());
  const auto start = surface.closest_point(near, norm(near - surface.low()) + extent, material);
  if (!start) throw InvalidInput("press_and_stroke: no triangle of material " + std::to_string(material));

  const double step = std::min(k_step_m, extent / 100);
  SurfacePoint here = *start;
  Vec3 direction = any_tangent(here.face_normal);
  const double radius = surface.probe_radius_m();
  const auto pressed = [&](const SurfacePoint& p) { return p.point + (radius - options.depth_m) * p.face_normal; };
  const double approach = free_approach(surface, here, options.approach_m);
  std::vector<Trajectory::Sample> samples{{0, here.point + (radius + approach) * here.face_normal},
                                          {options.press_s, pressed(here)}};
  if (options.motion == Motion::tap) {
    const double half = 0.5 / options.taps_per_s;
    for (int i = 0; samples.back().t < options.seconds; ++i)
      samples.push_back({samples.back().t + half, samples[static_cast<std::size_t>(i % 2)].position});
    return Trajectory(std::move(samples));
  }
  std::mt19937_64 random(options.seed);
  int turns = 0;
  while (samples.back().t < options.seconds && turns < k_most_turns) {
    const auto next = surface.closest_point(here.point + step * direction, step, material);
    const Vec3 way = next ? next->point - here.point : Vec3{};
    if (dot(way, direction) < k_least_progress * step) {
      // Reversed; to the side at the second attempt at the same place.
      direction = turns % 2 == 0 ? -direction : turned(direction, here.face_normal, k_sideways);
      ++turns;
      continue;
    }
    turns = 0;
    here = *next;
    direction = tangential(direction, here.face_normal);
    if (options.motion == Motion::circle) direction = turned(direction, here.face_normal, step / options.circle_m);
    if (options.motion == Motion::slide)
      direction = turned(direction, here.face_normal, k_random_turn * (2 * uniform(random) - 1));
    const double time = norm(pressed(here) - samples.back().position) / options.speed_m_per_s;
    samples.push_back({samples.back().t + std::max(time, 1e-6), pressed(here)});
  }
  return Trajectory(std::move(samples));
}

}  // namespace papilla
