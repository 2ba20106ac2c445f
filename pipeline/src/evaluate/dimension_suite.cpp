// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "evaluate/extreme_pictures.hpp"
#include "evaluate/picture_methods.hpp"
#include "evaluate/suite.hpp"

namespace papilla {
namespace {

/// Surfaces have dimensions from 2 to 3: an error of half that range is no result.
constexpr double k_unusable = 0.5;

void measure_error(const FractalMethod& method, const NamedPicture& input, StabilityCell& cell) {
  const std::optional<FractalEstimate> found = method.estimate(input.picture);
  if (!found) {
    cell.note = "no dimension";
    return;
  }
  cell.residual = (found->high - found->low) / 2;
  cell.note = fmt::format("D {:.4f}, 95 % from {:.4f} to {:.4f}", found->dimension, found->low, found->high);
  if (input.dimension) cell.error = std::abs(found->dimension - *input.dimension);
  if (!std::isfinite(found->dimension) || (cell.error && *cell.error > k_unusable)) cell.outcome = Outcome::breaks;
}

}  // namespace

StabilitySuite dimension_stability(const StabilityRun& run) {
  StabilitySuite suite{
      "dimension", "Fractal dimension", "distance to the true dimension", "half width of the 95 % interval", {}};
  fill_suite(suite, run, extreme_pictures(), fractal_methods(), measure_error);
  return suite;
}

}  // namespace papilla
