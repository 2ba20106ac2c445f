// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/texture_class.hpp"
#include "structure_tensor.hpp"

namespace papilla::texture_detail {

/// From this coherence on a texture has a direction: beyond half of what oblique light on an isotropic relief causes.
inline constexpr double k_directional_coherence = 0.4;

/// Mean and standard deviation of grey values.
struct Moments {
  double mean = 0, deviation = 0;
};
/// Of blocks × blocks parts of the picture, row by row; 0 for a part without pixels.
std::vector<Moments> block_moments(const GreyImage& image, int blocks);
inline Moments moments_of(const GreyImage& image) { return block_moments(image, 1).front(); }

/// Block means within one standard deviation of the whole, block contrasts within a factor of two.
bool is_homogeneous(const std::vector<Moments>& blocks, const Moments& whole);

/// See classify().
TextureClass class_of(double coherence, double explained_variance, double stripes);

/// See orientation_field(); the tensor and the pixels of every block, row by row.
OrientationField orientation_of(const std::vector<StructureTensor>& tensors, const std::vector<double>& pixels,
                                int columns, int rows);

}  // namespace papilla::texture_detail
