// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"
#include "papilla/texture/sample_rows.hpp"

namespace papilla::texture_detail {

/// Mean outer product of the grey gradient with itself over a picture (central differences, interior pixels).
struct StructureTensor {
  double xx = 0, xy = 0, yy = 0;

  double coherence() const;  ///< (λ1 − λ2)/(λ1 + λ2) in [0, 1]; 0 for a flat picture.
  double angle() const;      ///< Direction of the strongest gradient, radians from x towards y, in (−π/2, π/2].
};

StructureTensor structure_tensor(const SampleRows& picture);
StructureTensor structure_tensor(const GreyImage& image);

}  // namespace papilla::texture_detail
