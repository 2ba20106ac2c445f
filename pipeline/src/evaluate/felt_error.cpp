// SPDX-License-Identifier: MIT
#include "evaluate/felt_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "papilla/core/units.hpp"
#include "papilla/haptic/device.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/io/haptic_scene.hpp"

namespace papilla {
namespace {

constexpr double k_depth_m = 5e-4, k_speed_m_per_s = 0.02, k_period_s = 1e-3, k_press_s = 0.1, k_guard_n = 1e6;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A plate with a relief of heights in millimetres from `low` on.
ContactSurface plate(const HeightMap& size, const std::vector<double>& mm, double low) {
  const double high = *std::max_element(mm.begin(), mm.end());
  std::vector<std::uint16_t> samples;
  constexpr double k_steps = 65535;
  const double range = std::max(high - low, 1e-9);
  for (const double height : mm)
    samples.push_back(static_cast<std::uint16_t>(std::lround(k_steps * (height - low) / range)));
  HeightFieldOptions options;
  options.scale_m = k_metres_per_mm * range;
  std::vector<HeightField> fields;
  fields.emplace_back(size.width, size.height, std::move(samples), options);
  const double across = k_metres_per_mm * size.width * size.pitch_mm_x,
               down = k_metres_per_mm * size.height * size.pitch_mm_y;
  ContactMesh mesh;
  mesh.positions = {{0, 0, 0}, {across, 0, 0}, {across, down, 0}, {0, down, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_uv = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  ContactMaterial material;
  material.height = 0;
  return {mesh, {material}, std::move(fields), k_default_probe_radius_m};
}

std::vector<Vec3> stroke_forces(const ContactSurface& surface, Vec2 from, Vec2 to, double mean_m) {
  SafetyLimits limits = safety_limits(k_guard_n);
  limits.soft_start_s = 0;
  const auto tick = std::make_unique<HapticTick>(surface, limits, k_period_s);
  const double radius = surface.probe_radius_m(), above = surface.tallest_relief_m() + radius + 1e-3,
               below = radius + mean_m - k_depth_m;
  const int press = static_cast<int>(k_press_s / k_period_s),
            way = static_cast<int>(norm(to - from) / (k_speed_m_per_s * k_period_s));
  std::vector<Vec3> forces;
  tick->reset({from.x, from.y, above});
  for (int i = 1; i <= press + way; ++i) {
    const double pressed = std::min(1.0, static_cast<double>(i) / press);
    const Vec2 at = from + (std::max(0, i - press) / static_cast<double>(way)) * (to - from);
    const Vec3 force = (*tick)({Vec3{at.x, at.y, above + (below - above) * pressed}});
    if (i > press) forces.push_back(force);
  }
  return forces;
}

}  // namespace

double felt_error_percent(const HeightMap& found, const HeightMap& truth) {
  std::vector<double> a(found.mm.begin(), found.mm.end()), b(truth.mm.begin(), truth.mm.end());
  const double mean_a = mean_of(a), mean_b = mean_of(b);
  double product = 0, square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += (a[i] - mean_a) * (b[i] - mean_b);
    square += (a[i] - mean_a) * (a[i] - mean_a);
  }
  const double scale = square > 0 ? product / square : 0;
  for (double& height : a) height = mean_b + scale * (height - mean_a);
  const double low = std::min(*std::min_element(a.begin(), a.end()), *std::min_element(b.begin(), b.end()));
  const ContactSurface surface_a = plate(truth, a, low), surface_b = plate(truth, b, low);
  const double across = k_metres_per_mm * truth.width * truth.pitch_mm_x,
               down = k_metres_per_mm * truth.height * truth.pitch_mm_y, mean_m = k_metres_per_mm * (mean_b - low);
  double squares = 0, least = 1e300, most = -1e300;
  std::size_t count = 0;
  const auto place = [&](double u, double v) { return Vec2{u * across, v * down}; };
  for (const auto& [from, to] :
       {std::pair{place(0.1, 0.3), place(0.9, 0.4)}, std::pair{place(0.2, 0.9), place(0.3, 0.1)},
        std::pair{place(0.15, 0.15), place(0.85, 0.8)}, std::pair{place(0.1, 0.8), place(0.9, 0.25)}}) {
    const std::vector<Vec3> forces_a = stroke_forces(surface_a, from, to, mean_m),
                            forces_b = stroke_forces(surface_b, from, to, mean_m);
    for (std::size_t i = 0; i < forces_a.size(); ++i) {
      const Vec3 off = forces_a[i] - forces_b[i];
      squares += dot(off, off);
      least = std::min(least, forces_b[i].z);
      most = std::max(most, forces_b[i].z);
      ++count;
    }
  }
  return most > least ? 100 * std::sqrt(squares / static_cast<double>(count)) / (most - least) : 0;
}

}  // namespace papilla
