// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "papilla/core/srgb.hpp"
#include "papilla/core/units.hpp"
#include "papilla/texture/photograph_model.hpp"
#include "papilla/texture/photometric_stereo.hpp"
#include "papilla/texture/registration.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/test_relief.hpp"
#include "random.hpp"
#include "texture_accuracy.hpp"

namespace papilla::bench {
namespace {

constexpr int k_border = 8;  // Around the part that is compared, for moved photographs.

struct Scene {
  HeightMap truth;
  std::vector<GreyImage> photographs;
  std::vector<Vec3> lights;
};

HeightMap part_of(const HeightMap& relief) {
  HeightMap part{relief.width - 2 * k_border, relief.height - 2 * k_border, {}, relief.pitch_mm_x, relief.pitch_mm_y};
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) part.mm.push_back(relief.at(x + k_border, y + k_border));
  return part;
}

/// Four photographs of the second condition; the others moved against the first one by up to `largest_px`.
Scene photographed(std::string_view name, std::uint64_t seed, int largest_px) {
  const HeightMap relief = test_relief(name, {.seed = seed});
  texture_detail::Random random(1000 * seed + 7);
  Scene scene{part_of(relief), {}, {}};
  const double first = 2 * std::numbers::pi * random.uniform();
  for (int k = 0; k < 4; ++k) {
    PhotographOptions options =
        photograph_options(PhotographCondition::spotted, 100 * seed + static_cast<unsigned>(k), seed);
    const double azimuth = first + 2 * std::numbers::pi * (k + 0.6 * (random.uniform() - 0.5)) / 4,
                 elevation = (25 + 30 * random.uniform()) * k_radians_per_degree;
    options.light = {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                     std::sin(elevation)};
    const auto move = [&] {
      return k == 0 ? 0 : static_cast<int>(std::lround((2 * random.uniform() - 1) * largest_px));
    };
    const int left = k_border + move(), top = k_border + move();
    scene.photographs.push_back(
        crop(photograph(relief, options).picture, left, top, scene.truth.width, scene.truth.height));
    for (float& value : scene.photographs.back().pixels)
      value = static_cast<float>(linear_from_srgb(static_cast<double>(value)));
    scene.lights.push_back(options.light);
  }
  return scene;
}

/// Correlation of the slopes, mean slopes taken away.
double slope_correlation(const std::vector<double>& found, const HeightMap& truth) {
  double product = 0, square = 0, other = 0;
  for (const bool down : {false, true}) {
    std::vector<double> a, b;
    for (int y = 0; y + 1 < truth.height; ++y)
      for (int x = 0; x + 1 < truth.width; ++x) {
        const std::size_t here = truth.index(x, y), next = down ? truth.index(x, y + 1) : truth.index(x + 1, y);
        a.push_back(found[next] - found[here]);
        b.push_back(static_cast<double>(truth.mm[next]) - static_cast<double>(truth.mm[here]));
      }
    const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / static_cast<double>(a.size()),
                 mean_b = std::accumulate(b.begin(), b.end(), 0.0) / static_cast<double>(b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      product += (a[i] - mean_a) * (b[i] - mean_b);
      square += (a[i] - mean_a) * (a[i] - mean_a), other += (b[i] - mean_b) * (b[i] - mean_b);
    }
  }
  return product / std::sqrt(square * other);
}

struct Score {
  std::vector<double> heights, slopes, expected;
  double mean() const {
    return std::accumulate(heights.begin(), heights.end(), 0.0) / static_cast<double>(heights.size());
  }
  double mean_slopes() const {
    return std::accumulate(slopes.begin(), slopes.end(), 0.0) / static_cast<double>(slopes.size());
  }
  double worst_tenth() const {
    std::vector<double> sorted = heights;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 10];
  }
};

}  // namespace

void report_stereo(BenchReport& report) {
  EvidenceTable table{
      "Relief from four photographs",
      "Correlation with the true relief of all test reliefs, photographs of the second condition (8 % spots of "
      "the albedo, uneven light of 15 %), lights 25 to 55 degrees high; moved: by up to 5 pixels.",
      {"lights", "photographs", "mean", "worst tenth", "slopes"},
      {}};
  const bool quick = report.options().quick;
  const std::uint64_t seeds = quick ? 1 : 3;
  std::vector<std::string_view> reliefs = test_relief_names();
  if (quick) reliefs.resize(1);
  const auto holds = [quick](bool value) { return quick ? std::nullopt : std::optional(value); };
  const auto measured = [&](bool known, int moved_px) {
    Score score;
    for (std::uint64_t seed = 501; seed < 501 + seeds; ++seed)
      for (const std::string_view name : reliefs) {
        Scene scene = photographed(name, seed, moved_px);
        if (moved_px > 0) scene.photographs = register_photographs(scene.photographs).photographs;
        const PhotometricStereoResult found =
            photometric_stereo(scene.photographs, {known ? scene.lights : std::vector<Vec3>{}, {}});
        const double height = relief_error(found.height_px, scene.truth).correlation,
                     slope = slope_correlation(found.height_px, scene.truth);
        score.heights.push_back(known ? height : std::abs(height));
        score.slopes.push_back(known ? slope : std::abs(slope));
      }
    table.rows.push_back({known ? "given" : "unknown", moved_px > 0 ? "moved" : "still",
                          fmt::format("{:.3f}", score.mean()), fmt::format("{:.3f}", score.worst_tenth()),
                          fmt::format("{:.3f}", score.mean_slopes())});
    return score;
  };
  const Score known = measured(true, 0), unknown = measured(false, 0), moved = measured(true, 5);
  measured(false, 5);
  report.table(std::move(table));
  report.target({"four photographs, lights given: mean correlation at least 0.95", fmt::format("{:.3f}", known.mean()),
                 holds(known.mean() >= 0.95)});
  report.target({"four photographs, lights given: the worst tenth at least 0.85",
                 fmt::format("{:.3f}", known.worst_tenth()), holds(known.worst_tenth() >= 0.85)});
  report.target({"four photographs, lights given: correlation of the slopes at least 0.97",
                 fmt::format("{:.3f}", known.mean_slopes()), holds(known.mean_slopes() >= 0.97)});
  report.target({"four photographs, lights unknown: mean |correlation| at least 0.85",
                 fmt::format("{:.3f}", unknown.mean()), holds(unknown.mean() >= 0.85)});
  report.target({"four photographs moved by pixels: within 0.02 of those that are still",
                 fmt::format("{:.3f}", known.mean() - moved.mean()), holds(known.mean() - moved.mean() <= 0.02)});
}

}  // namespace papilla::bench
