// SPDX-License-Identifier: MIT
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/feature_matrix.hpp"

namespace papilla {
namespace {

double difference(const std::uint8_t* a, const std::uint8_t* b, int count) {
  std::uint32_t sum = 0;
  for (int i = 0; i < count; ++i)
    sum += static_cast<std::uint32_t>(std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i])));
  return sum;
}

double difference(const float* a, const float* b, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
  return sum;
}

template <class Samples>
void fill(FeatureMatrix& matrix, const Samples& values, int width, int height, double unit,
          const ProgressCallback& progress) {
  const auto columns = static_cast<std::ptrdiff_t>(matrix.width());
  double* centre =
      matrix.distortion.data() + texture_detail::pixel_index(matrix.reach_x, matrix.reach_y, matrix.width());
  SharedProgress rows(progress, "symmetry", matrix.reach_y + 1);
  oneapi::tbb::parallel_for(0, matrix.reach_y + 1, [&](int dy) {
    for (int dx = dy == 0 ? 0 : -matrix.reach_x; dx <= matrix.reach_x; ++dx) {
      const int left = std::max(0, -dx), count = width - std::abs(dx);
      double sum = 0;
      for (int y = 0; y + dy < height; ++y)
        sum += difference(values.data() + texture_detail::pixel_index(left, y, width),
                          values.data() + texture_detail::pixel_index(left + dx, y + dy, width), count);
      const double value = unit * sum / (static_cast<double>(count) * (height - dy));
      centre[dy * columns + dx] = value;
      centre[-dy * columns - dx] = value;
    }
    rows.add(1);
  });
}

}  // namespace

FeatureMatrix absolute_feature_matrix(const GreyImage& image, const ProgressCallback& progress) {
  texture_detail::require_image(image, "absolute_feature_matrix");
  constexpr int k_most_side = 2048;
  if (std::max(image.width, image.height) > k_most_side)
    throw InvalidInput("absolute_feature_matrix: the picture is " + std::to_string(image.width) + " x " +
                       std::to_string(image.height) + " pixels, at most " + std::to_string(k_most_side) +
                       " a side are taken");
  FeatureMatrix matrix{image.width / 2, image.height / 2, {}};
  matrix.distortion.assign(static_cast<std::size_t>(matrix.width()) * static_cast<std::size_t>(matrix.height()), 0);
  const std::vector<std::uint8_t> steps =
      image.bits == 8 ? texture_detail::whole_bytes(image) : std::vector<std::uint8_t>();
  if (steps.empty())
    fill(matrix, image.pixels, image.width, image.height, 1, progress);
  else
    fill(matrix, steps, image.width, image.height, 1.0 / 255, progress);
  return matrix;
}

}  // namespace papilla
