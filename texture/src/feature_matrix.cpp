// SPDX-License-Identifier: MIT
#include "papilla/texture/feature_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "autocorrelation.hpp"
#include "checks.hpp"

namespace papilla {
namespace {

using texture_detail::pixel_index;

/// Nearest whole number of a value ≥ 0 below 2^62; std::round is a call for each.
double rounded(double value) { return static_cast<double>(static_cast<std::int64_t>(value + 0.5)); }

/// The picture's values minus about their mean; integers in grey steps for 8-bit pictures.
struct Centred {
  std::vector<double> values;
  double unit = 1;        ///< Grey value of one step.
  bool integers = false;  ///< All values are whole numbers of at most 255 steps.
};

Centred centred(const GreyImage& image) {
  Centred result;
  const std::vector<std::uint8_t> steps =
      image.bits == 8 ? texture_detail::whole_bytes(image) : std::vector<std::uint8_t>();
  result.integers = !steps.empty();
  if (result.integers) {
    result.unit = 1.0 / 255;
    result.values.assign(steps.begin(), steps.end());
  } else {
    result.values.assign(image.pixels.begin(), image.pixels.end());
  }
  double sum = 0;
  for (const double value : result.values) sum += value;
  double mean = sum / static_cast<double>(result.values.size());
  if (result.integers) mean = rounded(mean);
  for (double& value : result.values) value -= mean;
  return result;
}

/// Prefix sums of the squares: entry (x, y) is the sum over [0, x) × [0, y).
std::vector<double> square_sums(const std::vector<double>& values, int width, int height) {
  const int stride = width + 1;
  std::vector<double> table(static_cast<std::size_t>(stride) * static_cast<std::size_t>(height + 1), 0);
  for (int y = 0; y < height; ++y) {
    double row = 0;
    const double* value = values.data() + pixel_index(0, y, width);
    const double* above = table.data() + pixel_index(1, y, stride);
    double* here = table.data() + pixel_index(1, y + 1, stride);
    for (int x = 0; x < width; ++x) {
      row += value[x] * value[x];
      here[x] = above[x] + row;
    }
  }
  return table;
}

}  // namespace

FeatureMatrix feature_matrix(const GreyImage& image) {
  texture_detail::require_image(image, "feature_matrix");
  const int w = image.width, h = image.height;
  FeatureMatrix matrix{w / 2, h / 2, {}};
  matrix.distortion.resize(static_cast<std::size_t>(matrix.width()) * static_cast<std::size_t>(matrix.height()));

  const Centred picture = centred(image);
  const std::vector<double> products =
      texture_detail::autocorrelation(picture.values, w, h, matrix.reach_x, matrix.reach_y);
  const std::vector<double> squares = square_sums(picture.values, w, h);
  const double unit = picture.unit * picture.unit;
  const auto columns = static_cast<std::ptrdiff_t>(matrix.width());
  double* centre = matrix.distortion.data() + pixel_index(matrix.reach_x, matrix.reach_y, matrix.width());
  for (int dy = 0; dy <= matrix.reach_y; ++dy) {
    const double* top = squares.data() + pixel_index(0, h - dy, w + 1);  // Rows [0, h − dy).
    const double* cut = squares.data() + pixel_index(0, dy, w + 1);      // Rows [0, dy), left out below.
    const double* all = squares.data() + pixel_index(0, h, w + 1);
    const double* product = products.data() + pixel_index(matrix.reach_x, dy, matrix.width());
    double *below = centre + dy * columns, *above = centre - dy * columns;
    for (int dx = -matrix.reach_x; dx <= matrix.reach_x; ++dx) {
      const int left = std::max(0, -dx), right = std::min(w, w - dx);
      const double here = top[right] - top[left];
      const double there = all[right + dx] - cut[right + dx] - all[left + dx] + cut[left + dx];
      double numerator = std::max(0.0, here + there - 2 * product[dx]);
      if (picture.integers) numerator = rounded(numerator);
      const double value = unit * numerator / (static_cast<double>(right - left) * (h - dy));
      below[dx] = value;
      above[-dx] = value;
    }
  }
  *centre = 0;
  return matrix;
}

}  // namespace papilla
