// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "evaluate/felt_error.hpp"
#include "evaluate/kinds.hpp"
#include "evaluate/picture_methods.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/light_direction.hpp"
#include "papilla/texture/photograph_model.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/resample.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/tiling.hpp"

namespace papilla {
namespace {

constexpr const char* k_intensity = "intensity";

/// Memory that the methods take for a pixel, with picture, true relief and result, at most: measured, 188 on a relief
/// of 1500 x 1500 pixels.
constexpr std::size_t k_bytes_per_pixel = 192;

constexpr std::array<int, 6> k_iterations = {5, 10, 20, 50, 100, 200};
constexpr double k_growth_by_steps = 2.5;

/// A float picture is a relief in millimetres.
bool is_relief(const std::filesystem::path& file, const GreyImage& image) {
  return image.bits == 32 && file.extension() != ".png";
}

HeightMap relief_of(const GreyImage& image) {
  const double pitch = image.pitch_mm > 0 ? image.pitch_mm : 1;
  return {image.width, image.height, image.pixels, pitch, pitch, measure_tiling(image).tiles};
}

EvaluationRun depth_run(const EvaluationInput& input, const char* method, Vec3 light) {
  return {method,     fmt::format("light ({:.2f}, {:.2f}, {:.2f})", light.x, light.y, light.z),
          input.name, "mean depth error over the range",
          {},         "direct",
          ""};
}

void add_sample(EvaluationRun& run, double seconds, const ReliefError& error, const std::string& what) {
  run.trace.push_back({seconds, error.mean});
  run.notes +=
      fmt::format("{}: correlation {:.3f}, after scaling {:.4f}; ", what, error.correlation, error.scaled_mean);
}

EvaluationRun run_over_steps(const EvaluationInput& input, const ShadingMethod& method, const HeightMap& truth,
                             Vec3 light) {
  EvaluationRun run = depth_run(input, method.name, light);
  const GreyImage picture = render_lambert(truth, light);
  ShadingOptions options{.light = light, .periodic = truth.periodic};
  Ladder ladder(input.budget, k_growth_by_steps);
  for (const int iterations : k_iterations) {
    if (!ladder.next()) break;
    options.iterations = iterations;
    const Stopwatch clock;
    const ShadingResult result = method.solve(picture, options);
    add_sample(run, clock.seconds(), relief_error(result.height_px, truth), fmt::format("{} steps", iterations));
    run.stop = std::string(to_string(result.stop));
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  return run;
}

/// A method without steps on growing middle parts of the relief. @param heights of a picture, in pixels.
template <class Heights>
EvaluationRun run_over_sizes(const EvaluationInput& input, const char* method, const GreyImage& image, Vec3 light,
                             Heights&& heights) {
  EvaluationRun run = depth_run(input, method, light);
  Ladder ladder(input.budget, k_growth_by_side);
  for (const int side : rising_sides(std::min(image.width, image.height))) {
    if (!ladder.next()) break;
    const HeightMap truth = relief_of(middle_part(image, side));
    const GreyImage picture = render_lambert(truth, light);
    const Stopwatch clock;
    const std::vector<double> found = heights(picture, truth);
    add_sample(run, clock.seconds(), relief_error(found, truth), fmt::format("middle {} pixels", side));
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  return run;
}

/// Grey read as height, scaled to the true depth, so that the error is one of shape.
std::vector<double> heights_from_grey(const GreyImage& picture, const HeightMap& truth) {
  const auto [low, high] = std::minmax_element(truth.mm.begin(), truth.mm.end());
  HeightOptions options;
  options.method = HeightMethod::intensity;
  options.pitch_mm = truth.pitch_mm_x;
  options.depth_mm = static_cast<double>(*high - *low);
  const HeightMap map = height_from_image(picture, options).map;
  std::vector<double> px;
  for (const float mm : map.mm) px.push_back(static_cast<double>(mm) / truth.pitch_mm_x);
  return px;
}

void add_depth_runs(const EvaluationInput& input, const GreyImage& image, Vec3 light,
                    std::vector<EvaluationRun>& runs) {
  for (const ShadingMethod& method : shading_methods())
    runs.push_back(
        method.iterates
            ? run_over_steps(input, method, relief_of(image), light)
            : run_over_sizes(input, method.name, image, light, [&](const GreyImage& picture, const HeightMap& truth) {
                return method.solve(picture, {.light = light, .periodic = truth.periodic}).height_px;
              }));
  runs.push_back(run_over_sizes(input, k_intensity, image, light, heights_from_grey));
}

constexpr const char* k_photograph_error = "1 - correlation with the true height";

std::string_view to_string(PhotographCondition condition) {
  constexpr std::array<std::string_view, 3> k_names = {"clean", "spotted", "glossy"};
  return k_names[static_cast<std::size_t>(condition)];
}

/// The whole way from a photograph of growing middle parts of the relief, under a light that is known or not.
EvaluationRun photograph_run(const EvaluationInput& input, const GreyImage& image, HeightMethod method,
                             PhotographCondition condition, bool light_known) {
  constexpr std::uint64_t k_seed = 1;
  const PhotographOptions photo = photograph_options(condition, k_seed);
  EvaluationRun run{std::string(to_string(method)),
                    fmt::format("photograph, {}, light {}", to_string(condition), light_known ? "known" : "unknown"),
                    input.name,
                    k_photograph_error,
                    {},
                    "direct",
                    ""};
  Ladder ladder(input.budget, k_growth_by_side);
  for (const int side : rising_sides(std::min(image.width, image.height))) {
    if (!ladder.next()) break;
    HeightMap truth = relief_of(middle_part(image, side));
    const GreyImage picture = photograph(truth, photo).picture;
    const Stopwatch clock;
    HeightOptions options;
    options.method = method;
    if (light_known) options.light = photo.light;
    const HeightResult found = height_from_image(picture, options);
    const double seconds = clock.seconds();
    const ReliefError error = relief_error({found.map.mm.begin(), found.map.mm.end()}, truth);
    run.trace.push_back({seconds, 1 - error.correlation});
    run.notes += fmt::format("middle {} pixels: correlation {:.3f}, slopes {:.2f}, felt force {:.1f} % of its range; ",
                             side, error.correlation, error.slope, felt_error_percent(found.map, truth));
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  return run;
}

void add_photograph_runs(const EvaluationInput& input, const GreyImage& image, std::vector<EvaluationRun>& runs) {
  for (const PhotographCondition condition :
       {PhotographCondition::clean, PhotographCondition::spotted, PhotographCondition::glossy}) {
    for (const HeightMethod method : {HeightMethod::automatic, HeightMethod::wiener, HeightMethod::pentland,
                                      HeightMethod::variational, HeightMethod::intensity})
      runs.push_back(photograph_run(input, image, method, condition, true));
    runs.push_back(photograph_run(input, image, HeightMethod::automatic, condition, false));
  }
}

EvaluationRun residual_run(const EvaluationInput& input, const ShadingMethod& method, const GreyImage& picture) {
  EvaluationRun run{method.name, "height", input.name, "rms of brightness - R, grey over albedo", {}, "", ""};
  const LightEstimate light = estimate_light(picture);
  const double mean =
      std::accumulate(picture.pixels.begin(), picture.pixels.end(), 0.0) / static_cast<double>(picture.pixels.size());
  ShadingOptions options{.light = light.direction, .periodic = measure_tiling(picture).tiles};
  if (mean > 0) options.albedo = mean / light.direction.z;
  options.progress = input.progress;
  if (input.budget.spent()) {
    run.stop = k_time_spent;
    return run;
  }
  const ShadingResult result = method.solve(picture, options);
  run.trace = result.trace;
  run.stop = std::string(to_string(result.stop));
  run.notes = fmt::format("light ({:.2f}, {:.2f}, {:.2f}), coherence {:.2f}; the true relief is not known",
                          light.direction.x, light.direction.y, light.direction.z, light.coherence);
  return run;
}

}  // namespace

std::vector<EvaluationRun> evaluate_height(const EvaluationInput& input) {
  const GreyImage image = read_grey_image(input.file, k_bytes_per_pixel);
  std::vector<EvaluationRun> runs;
  if (is_relief(input.file, image)) {
    for (const Vec3 light : {Vec3{0.3, 0.3, 1}, Vec3{1, 0, 1}, Vec3{1, 1, 1}})
      add_depth_runs(input, image, normalized(light), runs);
    add_photograph_runs(input, image, runs);
  } else
    for (const ShadingMethod& method : shading_methods()) runs.push_back(residual_run(input, method, image));
  return runs;
}

}  // namespace papilla
