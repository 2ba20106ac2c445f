// SPDX-License-Identifier: MIT
#include "papilla/texture/relief_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "best_plane.hpp"
#include "checks.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using Field = std::vector<double>;

void remove_plane(Field& field, int width, int height) {
  const Field plane = texture_detail::best_plane(field, width, height);
  for (std::size_t i = 0; i < field.size(); ++i) field[i] -= plane[i];
}

double mean_difference(const Field& a, const Field& b, double scale) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(scale * a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

/// Sum of the squared forward differences of scale · a − b.
double slope_squares(const Field& a, const Field& b, double scale, const HeightMap& size) {
  const auto at = [&](int x, int y) {
    const std::size_t i = size.index(x, y);
    return scale * a[i] - b[i];
  };
  double squares = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (x + 1 < size.width) squares += std::pow(at(x + 1, y) - at(x, y), 2);
      if (y + 1 < size.height) squares += std::pow(at(x, y + 1) - at(x, y), 2);
    }
  return squares;
}

}  // namespace

ReliefError relief_error(const std::vector<double>& found_px, const HeightMap& truth) {
  texture_detail::require_height_map(truth, "relief_error", true);
  if (found_px.size() != truth.mm.size())
    throw InvalidInput("relief_error: " + std::to_string(found_px.size()) + " heights for " +
                       std::to_string(truth.mm.size()) + " samples");
  if (!std::all_of(found_px.begin(), found_px.end(), [](double h) { return std::isfinite(h); }))
    throw InvalidInput("relief_error: a height is not finite");
  Field found = found_px, expected;
  for (const float height : truth.mm) expected.push_back(static_cast<double>(height) / truth.pitch_mm_x);
  const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
  const double range = *high - *low;
  if (!(range > 0)) throw InvalidInput("relief_error: the truth is flat");
  remove_plane(found, truth.width, truth.height);
  remove_plane(expected, truth.width, truth.height);
  double product = 0, square = 0, expected_square = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    product += found[i] * expected[i];
    square += found[i] * found[i];
    expected_square += expected[i] * expected[i];
  }
  ReliefError error;
  error.mean = mean_difference(found, expected, 1) / range;
  error.scaled_mean = mean_difference(found, expected, square > 0 ? product / square : 0) / range;
  error.slope = std::sqrt(slope_squares(found, expected, square > 0 ? product / square : 0, truth) /
                          slope_squares(found, expected, 0, truth));
  if (square > 0 && expected_square > 0) error.correlation = product / std::sqrt(square * expected_square);
  return error;
}

}  // namespace papilla
