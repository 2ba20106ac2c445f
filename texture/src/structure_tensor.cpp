// SPDX-License-Identifier: MIT
#include "structure_tensor.hpp"

#include <cmath>
#include <cstddef>

#include "papilla/texture/stored_samples.hpp"
#include "row_window.hpp"

namespace papilla::texture_detail {

double StructureTensor::coherence() const {
  const double trace = xx + yy;
  return trace > 0 ? std::hypot(xx - yy, 2 * xy) / trace : 0;
}

double StructureTensor::angle() const { return 0.5 * std::atan2(2 * xy, xx - yy); }

StructureTensor structure_tensor(const SampleRows& picture) {
  StructureTensor tensor;
  visit_rows(picture, false, [&](int y, const RowWindow& rows) {
    if (y == 0 || y + 1 == picture.height()) return;
    for (std::size_t x = 1; x + 1 < rows.row.size(); ++x) {
      const double gx = static_cast<double>(rows.row[x + 1]) - static_cast<double>(rows.row[x - 1]);
      const double gy = static_cast<double>(rows.below[x]) - static_cast<double>(rows.above[x]);
      tensor.xx += gx * gx;
      tensor.xy += gx * gy;
      tensor.yy += gy * gy;
    }
  });
  tensor.xx /= picture.count();
  tensor.xy /= picture.count();
  tensor.yy /= picture.count();
  return tensor;
}

StructureTensor structure_tensor(const GreyImage& image) {
  return structure_tensor(SamplesInMemory(image.pixels, image.width, image.height));
}

}  // namespace papilla::texture_detail
