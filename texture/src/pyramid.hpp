// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// The picture at half its sides (rounded), every pixel the mean of what it covers.
GreyImage halved(const GreyImage& image);

/// Heights in pixels over a grid made by halved(), brought back to the finer grid and to its pixels: bilinear, across
/// the borders when periodic.
std::vector<double> doubled(const std::vector<double>& heights, int width, int height, int fine_width, int fine_height,
                            bool periodic);

}  // namespace papilla::texture_detail
