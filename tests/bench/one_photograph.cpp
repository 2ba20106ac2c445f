// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "papilla/core/temporary_folder.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/photograph_model.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/test_relief.hpp"
#include "texture_accuracy.hpp"

namespace papilla::bench {
namespace {

struct Means {
  double given = 0, unknown = 0, grey = 0, axis_deg = 0;
  int count = 0;

  void add(const Means& other) {
    given += other.given, unknown += other.unknown, grey += other.grey, axis_deg += other.axis_deg;
    count += other.count;
  }
  double mean(double sum) const { return sum / count; }
};

/// Of one photograph, through JPEG.
Means measured(std::string_view name, PhotographCondition condition, std::uint64_t seed,
               const std::filesystem::path& folder) {
  const HeightMap truth = test_relief(name, {.seed = seed});
  const PhotographOptions options = photograph_options(condition, 100 * seed + static_cast<std::uint64_t>(condition));
  write_grey_image(folder / "a.jpg", photograph(truth, options).picture, 8, 92);
  const GreyImage picture = read_grey_image(folder / "a.jpg");
  const auto correlation = [&](const HeightResult& result) {
    return relief_error({result.map.mm.begin(), result.map.mm.end()}, truth).correlation;
  };
  const HeightResult given = height_from_image(picture, {.light = options.light, .periodic = false}),
                     unknown = height_from_image(picture, {.periodic = false}),
                     grey = height_from_image(picture, {.method = HeightMethod::intensity, .periodic = false}),
                     shaded = height_from_image(picture, {.method = HeightMethod::wiener, .periodic = false});
  const double turn = std::atan2(shaded.light.y, shaded.light.x) - std::atan2(options.light.y, options.light.x);
  return {correlation(given), std::abs(correlation(unknown)), std::abs(correlation(grey)),
          std::abs(std::remainder(turn, std::numbers::pi)) * k_degrees_per_radian, 1};
}

}  // namespace

void report_one_photograph(BenchReport& report) {
  struct Condition {
    PhotographCondition condition;
    const char* name;
    double least;
  };
  EvidenceTable table{
      "Relief from one photograph",
      "Mean correlation of `auto` with the true relief over all test reliefs, eight seeds each; lights 25 to 55 "
      "degrees "
      "high, point spread of 0.7 pixels, noise of 1 %, vignette of 10 %, sRGB, JPEG 92. Light unknown: either side "
      "counts, because a picture does not tell it; `axis` is the mean error of the light's axis; `grey` is what grey "
      "read as height reaches.",
      {"condition", "photographs", "light given", "light unknown", "axis", "grey"},
      {}};
  const TemporaryFolder folder("papilla-bench");
  const bool quick = report.options().quick;
  const std::uint64_t seeds = quick ? 1 : 8;
  std::vector<std::string_view> reliefs = test_relief_names();
  if (quick) reliefs.resize(1);
  const auto holds = [quick](bool value) { return quick ? std::nullopt : std::optional(value); };
  Means all;
  for (const auto& [condition, name, least] :
       {Condition{PhotographCondition::clean, "clean", 0.80},
        Condition{PhotographCondition::spotted, "8 % spots, uneven light of 15 %", 0.50},
        Condition{PhotographCondition::glossy, "darker valleys, highlights", 0.75}}) {
    Means means;
    for (const std::string_view relief : reliefs)
      for (std::uint64_t seed = 101; seed < 101 + seeds; ++seed)
        means.add(measured(relief, condition, seed, folder.path()));
    table.rows.push_back({name, std::to_string(means.count), fmt::format("{:.3f}", means.mean(means.given)),
                          fmt::format("{:.3f}", means.mean(means.unknown)),
                          fmt::format("{:.1f}°", means.mean(means.axis_deg)),
                          fmt::format("{:.3f}", means.mean(means.grey))});
    report.target({fmt::format("one photograph, light given, {}: mean correlation at least {:.2f}", name, least),
                   fmt::format("{:.3f}", means.mean(means.given)), holds(means.mean(means.given) >= least)});
    all.add(means);
  }
  report.table(std::move(table));
  report.target({"one photograph, light given: mean correlation at least 0.70",
                 fmt::format("{:.3f}", all.mean(all.given)), holds(all.mean(all.given) >= 0.70)});
  report.target({"one photograph, light unknown: mean |correlation| at least 0.65",
                 fmt::format("{:.3f}", all.mean(all.unknown)), holds(all.mean(all.unknown) >= 0.65)});
  report.target({"one photograph, light unknown: its axis within 8 degrees in the mean",
                 fmt::format("{:.1f}", all.mean(all.axis_deg)), holds(all.mean(all.axis_deg) <= 8)});
}

}  // namespace papilla::bench
