// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>

#include "evaluate/evaluation.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/light_direction.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "papilla/texture/tiling.hpp"

namespace papilla::app {
namespace {

struct Method {
  const char* name;
  ShadingResult (*solve)(const GreyImage&, const ShadingOptions&);
  bool iterates;
};
constexpr std::array<Method, 3> k_methods = {{{"variational", shape_from_shading_variational, true},
                                              {"pentland", shape_from_shading_pentland, false},
                                              {"tsai-shah", shape_from_shading_tsai_shah, true}}};

constexpr std::array<int, 6> k_iterations = {5, 10, 20, 50, 100, 200};

/// A float picture is a relief in millimetres.
bool is_relief(const std::filesystem::path& file, const GreyImage& image) {
  return image.bits == 32 && file.extension() != ".png";
}

EvaluationRun against_truth(const EvaluationInput& input, const Method& method, const HeightMap& truth, Vec3 light) {
  EvaluationRun run{method.name, "height", input.name, "mean depth error over the range", {}, "iteration_limit", ""};
  const GreyImage picture = render_lambert(truth, light);
  ShadingOptions options{.light = light, .periodic = truth.periodic};
  for (const int iterations : k_iterations) {
    options.iterations = iterations;
    const Stopwatch clock;
    const ShadingResult result = method.solve(picture, options);
    const double seconds = clock.seconds();
    const ReliefError error = relief_error(result.height_px, truth);
    run.trace.push_back({seconds, error.mean});
    run.stop = std::string(to_string(result.stop));
    run.notes += fmt::format("{} steps: correlation {:.3f}, after scaling {:.4f}; ", iterations, error.correlation,
                             error.scaled_mean);
    if (!method.iterates) break;
  }
  run.notes += fmt::format("light ({:.2f}, {:.2f}, {:.2f})", light.x, light.y, light.z);
  return run;
}

EvaluationRun residual_only(const EvaluationInput& input, const Method& method, const GreyImage& picture) {
  EvaluationRun run{method.name, "height", input.name, "rms of brightness - R, grey over albedo", {}, "", ""};
  const LightEstimate light = estimate_light(picture);
  const double mean =
      std::accumulate(picture.pixels.begin(), picture.pixels.end(), 0.0) / static_cast<double>(picture.pixels.size());
  ShadingOptions options{.light = light.direction, .periodic = measure_tiling(picture).tiles};
  if (mean > 0) options.albedo = mean / light.direction.z;
  options.progress = input.progress;
  const ShadingResult result = method.solve(picture, options);
  run.trace = result.trace;
  run.stop = std::string(to_string(result.stop));
  run.notes = fmt::format("light ({:.2f}, {:.2f}, {:.2f}), coherence {:.2f}; the true relief is not known",
                          light.direction.x, light.direction.y, light.direction.z, light.coherence);
  return run;
}

}  // namespace

std::vector<EvaluationRun> evaluate_height(const EvaluationInput& input) {
  const GreyImage image = read_grey_image(input.file);
  std::vector<EvaluationRun> runs;
  for (const Method& method : k_methods) {
    if (!is_relief(input.file, image)) {
      runs.push_back(residual_only(input, method, image));
      continue;
    }
    const double pitch = image.pitch_mm > 0 ? image.pitch_mm : 1;
    HeightMap truth{image.width, image.height, image.pixels, pitch, pitch, measure_tiling(image).tiles};
    for (const Vec3 light : {Vec3{0.3, 0.3, 1}, Vec3{1, 0, 1}, Vec3{1, 1, 1}})
      runs.push_back(against_truth(input, method, truth, normalized(light)));
  }
  return runs;
}

}  // namespace papilla::app
