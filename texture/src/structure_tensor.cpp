// SPDX-License-Identifier: MIT
#include "structure_tensor.hpp"

#include <cmath>

namespace papilla::texture_detail {

double StructureTensor::coherence() const {
  const double trace = xx + yy;
  return trace > 0 ? std::hypot(xx - yy, 2 * xy) / trace : 0;
}

double StructureTensor::angle() const { return 0.5 * std::atan2(2 * xy, xx - yy); }

StructureTensor structure_tensor(const GreyImage& image) {
  StructureTensor tensor;
  for (int y = 1; y + 1 < image.height; ++y)
    for (int x = 1; x + 1 < image.width; ++x) {
      const double gx = static_cast<double>(image.at(x + 1, y)) - static_cast<double>(image.at(x - 1, y));
      const double gy = static_cast<double>(image.at(x, y + 1)) - static_cast<double>(image.at(x, y - 1));
      tensor.xx += gx * gx;
      tensor.xy += gx * gy;
      tensor.yy += gy * gy;
    }
  const double pixels = static_cast<double>(image.width) * image.height;
  tensor.xx /= pixels;
  tensor.xy /= pixels;
  tensor.yy /= pixels;
  return tensor;
}

}  // namespace papilla::texture_detail
