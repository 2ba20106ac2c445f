// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "evaluate/extreme_pictures.hpp"
#include "evaluate/picture_methods.hpp"
#include "evaluate/suite.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/relief_error.hpp"
#include "papilla/texture/shading.hpp"

namespace papilla {
namespace {

struct Case {
  std::string name;
  GreyImage picture;
  ShadingOptions options;
  std::optional<HeightMap> truth;
};

Case lit(std::string name, const HeightMap& relief, Vec3 light) {
  ShadingOptions options;
  options.light = light;
  options.periodic = true;
  // render_lambert() needs a light in front of the surface.
  const Vec3 shown = light.z > 0 ? light : Vec3{light.x, light.y, 1e-3};
  return {std::move(name), render_lambert(relief, normalized(shown)), options, relief};
}

std::vector<Case> cases() {
  const HeightMap spheres = synthesize_grain(GrainKind::spheres6, {.size_px = 128}).relief;
  std::vector<Case> all;
  all.push_back(lit("spheres, light at 45 degrees", spheres, {1, 0, 1}));
  all.push_back(lit("spheres, frontal light", spheres, {0, 0, 1}));
  all.push_back(lit("spheres, light 1 degree over the surface", spheres, {1, 0, 0.0175}));
  all.push_back(lit("spheres, light along the surface", spheres, {1, 0, 0}));
  all.push_back(lit("spheres, light from behind", spheres, {0, 0, -1}));
  HeightMap steep = spheres;
  for (float& mm : steep.mm) mm *= 100;
  all.push_back(lit("spheres, a hundred times as high", steep, {1, 0, 1}));
  for (NamedPicture& input : extreme_pictures()) {
    if (input.dimension && *input.dimension > 2 && *input.dimension < 3)
      continue;  // Fractal grey values are no lit reliefs.
    all.push_back({input.name, std::move(input.picture), {}, std::nullopt});
  }
  return all;
}

/// A flat result has a mean error of at most half the range.
constexpr double k_unusable = 0.5;

void measure_depth_error(const ShadingMethod& method, const Case& input, StabilityCell& cell) {
  const ShadingResult result = method.solve(input.picture, input.options);
  if (!result.trace.empty()) {
    cell.residual = result.trace.back().error;
    cell.iterations = static_cast<int>(result.trace.size()) - 1;
  }
  cell.note = fmt::format("stop {}", to_string(result.stop));
  if (!input.truth) return;
  const ReliefError error = relief_error(result.height_px, *input.truth);
  cell.error = error.mean;
  cell.note += fmt::format(", correlation {:.3f}", error.correlation);
  if (error.mean > k_unusable) cell.outcome = Outcome::breaks;
}

}  // namespace

StabilitySuite shading_stability(const StabilityRun& run) {
  StabilitySuite suite{"shading",
                       "Shape from shading",
                       "mean depth error over the range of the relief",
                       "rms of brightness − R, grey over albedo",
                       {}};
  fill_suite(suite, run, cases(), shading_methods(), measure_depth_error);
  return suite;
}

}  // namespace papilla
