// SPDX-License-Identifier: MIT
#include "papilla/texture/part_roughness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "shaped_noise.hpp"
#include "slopes.hpp"

namespace papilla {
namespace {

/// Samples a side that a dimension needs, octaves of roughness below which there is nothing to part.
constexpr int k_least_side = 32;
constexpr double k_least_octaves = 2;
/// A smaller anisotropy is that of chance.
constexpr double k_least_anisotropy = 1.1;

/// The slopes, and the anisotropy of the waves from theirs: a field stretched by r along one direction has slopes r
/// times as steep across it.
void measure_slopes(const HeightMap& rough, RoughnessModel& model) {
  double xx = 0, xy = 0, yy = 0;
  for (int y = 0; y < rough.height; ++y)
    for (int x = 0; x < rough.width; ++x) {
      const Vec2 slope = texture_detail::slope(rough, x, y);
      xx += slope.x * slope.x;
      xy += slope.x * slope.y;
      yy += slope.y * slope.y;
    }
  const double spread = std::hypot(xx - yy, 2 * xy), sum = xx + yy;
  model.rms_slope = std::sqrt(sum / static_cast<double>(rough.mm.size()));
  if (!(sum > spread)) return;
  const double ratio = std::sqrt((sum + spread) / (sum - spread));
  if (ratio < k_least_anisotropy) return;
  model.anisotropy = std::min(ratio, 100.0);
  // Along the waves slopes are least.
  const double steepest = 0.5 * std::atan2(2 * xy, xx - yy);
  model.direction_rad = steepest > 0 ? steepest - std::numbers::pi / 2 : steepest + std::numbers::pi / 2;
}

}  // namespace

std::optional<RoughnessModel> roughness_above(const RoughnessModel& whole, double shortest_mm) {
  if (!(whole.rms_mm > 0) || !(whole.longest_mm > shortest_mm)) return std::nullopt;
  // ∫ k^p d ln k between the wave numbers of two wavelengths.
  const auto integral = [](double p, double shortest, double longest) {
    return (std::pow(1 / shortest, p) - std::pow(1 / longest, p)) / p;
  };
  RoughnessModel part = whole;
  part.shortest_mm = std::max(whole.shortest_mm, shortest_mm);
  const double heights = -2 * whole.hurst, slopes = 2 + heights;
  const double kept = integral(heights, part.shortest_mm, part.longest_mm);
  part.rms_mm *= std::sqrt(kept / integral(heights, whole.shortest_mm, whole.longest_mm));
  part.rms_slope =
      2 * std::numbers::pi * part.rms_mm * std::sqrt(integral(slopes, part.shortest_mm, part.longest_mm) / kept);
  return part;
}

PartedRelief part_roughness(const HeightMap& relief, double longest_mm) {
  texture_detail::require_height_map(relief, "part_roughness", true);
  if (!texture_detail::is_positive(longest_mm))
    throw InvalidInput(fmt::format("part_roughness: a longest wavelength of {} mm is not positive", longest_mm));
  PartedRelief parted{relief, {}, {}};
  RoughnessModel model;
  model.shortest_mm = 2 * std::max(relief.pitch_mm_x, relief.pitch_mm_y);
  model.longest_mm = std::min({longest_mm, relief.width * relief.pitch_mm_x, relief.height * relief.pitch_mm_y});
  if (std::min(relief.width, relief.height) < k_least_side ||
      !(model.longest_mm >= std::exp2(k_least_octaves) * model.shortest_mm)) {
    parted.reason = fmt::format("waves of {:.3g} to {:.3g} mm are less than {} octaves", model.shortest_mm,
                                model.longest_mm, k_least_octaves);
    return parted;
  }
  std::vector<double> smooth(relief.mm.begin(), relief.mm.end());
  texture_detail::filter(smooth, relief.width, relief.height, relief.periodic, [&](double x, double y) {
    return std::hypot(x / relief.pitch_mm_x, y / relief.pitch_mm_y) * model.longest_mm < 1 ? 1.0 : 0.0;
  });
  HeightMap rough = relief;
  double squares = 0;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    const double rest = static_cast<double>(relief.mm[i]) - smooth[i];
    squares += rest * rest;
    rough.mm[i] = static_cast<float>(rest);
  }
  // Of the whole relief: a surface without its long waves follows no power law at its end.
  const BestDimension best = best_dimension({relief.width, relief.height, relief.mm, relief.pitch_mm_x, 32},
                                            model.longest_mm / std::min(relief.pitch_mm_x, relief.pitch_mm_y));
  if (!best.power_law()) {
    parted.reason = "no power law holds: " + best.reason;
    return parted;
  }
  model.hurst = best.estimate->hurst;
  model.rms_mm = std::sqrt(squares / static_cast<double>(smooth.size()));
  measure_slopes(rough, model);
  std::transform(smooth.begin(), smooth.end(), parted.relief.mm.begin(),
                 [](double h) { return static_cast<float>(h); });
  parted.roughness = model;
  parted.reason = fmt::format("waves below {:.3g} mm are roughness of H {:.2f} and rms {:.3g} mm", model.longest_mm,
                              model.hurst, model.rms_mm);
  return parted;
}

}  // namespace papilla
