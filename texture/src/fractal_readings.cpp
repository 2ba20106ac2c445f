// SPDX-License-Identifier: MIT
#include "papilla/texture/fractal_readings.hpp"

#include <algorithm>
#include <vector>

#include "checks.hpp"
#include "line_fit.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/probability_dimension.hpp"

namespace papilla {
namespace {

using texture_detail::mean_estimate;

/// The readings of one method from the pieces that were large enough for it.
template <class Reading>
std::vector<Reading> readings_of(std::span<const FractalReadings> pieces,
                                 std::optional<Reading> FractalReadings::*method) {
  std::vector<Reading> found;
  for (const FractalReadings& piece : pieces)
    if (piece.*method) found.push_back(*(piece.*method));
  return found;
}

BestDimension mean_best(const std::vector<BestDimension>& pieces) {
  BestDimension result = pieces.front();
  std::vector<FractalEstimate> estimates;
  result.directional_hurst.fill(0);
  for (const BestDimension& piece : pieces) {
    estimates.push_back(piece.estimate);
    result.quantization_step = std::min(result.quantization_step, piece.quantization_step);
    for (std::size_t d = 0; d < result.directional_hurst.size(); ++d)
      result.directional_hurst[d] += piece.directional_hurst[d] / static_cast<double>(pieces.size());
  }
  result.estimate = mean_estimate(estimates);
  return result;
}

}  // namespace

FractalReadings read_fractal_dimensions(const GreyImage& image, const ProgressCallback& progress) {
  texture_detail::require_image(image, "read_fractal_dimensions");
  FractalReadings readings;
  const int side = std::min(image.width, image.height);
  constexpr double k_methods = 6;
  double done = 0;
  const auto next = [&] { report_progress(progress, "fractal dimension", done++ / k_methods); };
  if (side >= k_least_fractal_side) {
    next();
    readings.box = box_dimension(image);
    next();
    readings.information = information_dimension(image);
    next();
    readings.correlation = correlation_dimension(image);
    next();
    readings.fshot = fshot_dimension(image);
    next();
    readings.best = best_dimension(image);
  }
  next();
  if (side >= k_least_probability_side) readings.probability = probability_dimension(image);
  report_progress(progress, "fractal dimension", 1);
  return readings;
}

FractalReadings mean_readings(std::span<const FractalReadings> pieces) {
  FractalReadings result;
  for (const auto method : {&FractalReadings::box, &FractalReadings::information, &FractalReadings::correlation,
                            &FractalReadings::probability})
    if (const auto found = readings_of(pieces, method); !found.empty()) result.*method = mean_estimate(found);
  if (const auto found = readings_of(pieces, &FractalReadings::fshot); !found.empty())
    result.fshot = mean_signature(found);
  if (const auto found = readings_of(pieces, &FractalReadings::best); !found.empty()) result.best = mean_best(found);
  return result;
}

}  // namespace papilla
