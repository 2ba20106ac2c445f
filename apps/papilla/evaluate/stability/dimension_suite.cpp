// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "evaluate/stability/extreme_pictures.hpp"
#include "evaluate/stability/stability.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/probability_dimension.hpp"

namespace papilla::app {
namespace {

struct Method {
  const char* name;
  FractalEstimate (*estimate)(const GreyImage&);
};
constexpr std::array<Method, 6> k_methods = {
    {{"box", box_dimension},
     {"information", information_dimension},
     {"correlation", correlation_dimension},
     {"probability", [](const GreyImage& image) { return probability_dimension(image); }},
     {"fshot", [](const GreyImage& image) { return fshot_dimension(image).estimate; }},
     {"best", [](const GreyImage& image) { return best_dimension(image).estimate; }}}};

/// A dimension is one of a surface; half a unit off the truth is no longer a reading of it.
constexpr double k_unusable = 0.5;

void estimate(const Method& method, const NamedPicture& input, StabilityCell& cell) {
  const FractalEstimate found = method.estimate(input.picture);
  cell.residual = (found.high - found.low) / 2;
  cell.note = fmt::format("D {:.4f}, 95 % from {:.4f} to {:.4f}", found.dimension, found.low, found.high);
  if (input.dimension) cell.error = std::abs(found.dimension - *input.dimension);
  if (!std::isfinite(found.dimension) || (cell.error && *cell.error > k_unusable)) cell.outcome = Outcome::breaks;
}

}  // namespace

StabilitySuite dimension_stability(const StabilityRun& run) {
  StabilitySuite suite{
      "dimension", "Fractal dimension", "distance to the true dimension", "half width of the 95 % interval", {}};
  fill_suite(suite, run, extreme_pictures(), k_methods, estimate);
  return suite;
}

}  // namespace papilla::app
