// SPDX-License-Identifier: MIT
#include "papilla/texture/fractal_readings.hpp"

#include <algorithm>
#include <array>
#include <string>
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

/// The reason that most pieces give, the first of them when there are several.
std::string commonest_reason(const std::vector<BestDimension>& pieces) {
  const BestDimension* commonest = nullptr;
  std::ptrdiff_t most = 0;
  for (const BestDimension& piece : pieces) {
    if (piece.power_law()) continue;
    const auto count = std::count_if(pieces.begin(), pieces.end(), [&](const BestDimension& other) {
      return !other.power_law() && other.reason == piece.reason;
    });
    if (count > most) commonest = &piece;
    most = std::max(most, count);
  }
  return commonest != nullptr ? commonest->reason : "";
}

BestDimension mean_best(const std::vector<BestDimension>& pieces) {
  if (pieces.size() == 1) return pieces.front();
  std::vector<const BestDimension*> lawful;
  for (const BestDimension& piece : pieces)
    if (piece.power_law()) lawful.push_back(&piece);
  const bool holds = 2 * lawful.size() >= pieces.size();
  BestDimension result;
  result.quantization_step = pieces.front().quantization_step;
  const double share = 1 / static_cast<double>(pieces.size());
  std::vector<FractalEstimate> curves;
  for (const BestDimension& piece : pieces) {
    result.quantization_step = std::min(result.quantization_step, piece.quantization_step);
    result.psf_sigma_px += share * piece.psf_sigma_px;
    result.noise_rms += share * piece.noise_rms;
    result.chi2_per_dof += share * piece.chi2_per_dof;
    curves.push_back({.curve = piece.curve});
  }
  result.curve = mean_estimate(curves).curve;
  if (!holds) {
    result.reason = std::to_string(pieces.size() - lawful.size()) + " of " + std::to_string(pieces.size()) +
                    " pieces have no power law: " + commonest_reason(pieces);
    return result;
  }
  std::vector<FractalEstimate> estimates;
  std::array<double, 4> directions{};
  bool has_directions = true;
  result.most_scale_px = lawful.front()->most_scale_px;
  for (const BestDimension* piece : lawful) {
    estimates.push_back(*piece->estimate);
    result.least_scale_px = std::max(result.least_scale_px, piece->least_scale_px);
    result.most_scale_px = std::min(result.most_scale_px, piece->most_scale_px);
    has_directions = has_directions && piece->directional_hurst.has_value();
    for (std::size_t d = 0; d < directions.size() && has_directions; ++d)
      directions[d] += (*piece->directional_hurst)[d] / static_cast<double>(lawful.size());
  }
  if (result.least_scale_px >= result.most_scale_px) {
    result.least_scale_px = result.most_scale_px = 0;
    result.reason = "the pieces follow power laws at scales that have none in common";
    return result;
  }
  if (has_directions) result.directional_hurst = directions;
  FractalEstimate& estimate = result.estimate.emplace(mean_estimate(estimates));
  estimate.curve = result.curve;
  result.reason =
      "a power law in " + std::to_string(lawful.size()) + " of " + std::to_string(pieces.size()) + " pieces";
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
