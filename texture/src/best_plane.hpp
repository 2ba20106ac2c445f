// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace papilla::texture_detail {

/// The best plane of a field of width × height values, by least squares.
std::vector<double> best_plane(const std::vector<double>& field, int width, int height);

}  // namespace papilla::texture_detail
