// SPDX-License-Identifier: MIT
#include "best_plane.hpp"

namespace papilla::texture_detail {

std::vector<double> best_plane(const std::vector<double>& field, int width, int height) {
  const double middle_x = (width - 1) / 2.0, middle_y = (height - 1) / 2.0;
  double mean = 0, along_x = 0, along_y = 0, square_x = 0, square_y = 0;
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++i) {
      mean += field[i];
      along_x += field[i] * (x - middle_x);
      along_y += field[i] * (y - middle_y);
      square_x += (x - middle_x) * (x - middle_x);
      square_y += (y - middle_y) * (y - middle_y);
    }
  mean /= static_cast<double>(field.size());
  const double slope_x = square_x > 0 ? along_x / square_x : 0, slope_y = square_y > 0 ? along_y / square_y : 0;
  std::vector<double> plane;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) plane.push_back(mean + slope_x * (x - middle_x) + slope_y * (y - middle_y));
  return plane;
}

}  // namespace papilla::texture_detail
