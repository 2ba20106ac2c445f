// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/texture_class.hpp"
#include "structure_tensor.hpp"

namespace papilla::texture_detail {

/// From this coherence on a texture has a direction: beyond half of what oblique light on an isotropic relief causes.
inline constexpr double k_directional_coherence = 0.4;

struct Moments {
  double mean = 0, deviation = 0;
};
Moments moments_of(const GreyImage& image);

/// Block means within one standard deviation of the whole, block contrasts within a factor of two.
bool is_homogeneous(const std::vector<Moments>& blocks, const Moments& whole);

/// See classify().
TextureClass class_of(double coherence, double explained_variance, double stripes);

/// See orientation_field(); the tensor and the pixels of every block, row by row.
OrientationField orientation_of(const std::vector<StructureTensor>& tensors, const std::vector<double>& pixels,
                                int columns, int rows);

}  // namespace papilla::texture_detail
