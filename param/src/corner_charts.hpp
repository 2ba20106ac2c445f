// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <vector>

#include "papilla/param/flattening.hpp"

namespace papilla::param_detail {

using CornerUv = std::array<Vec2, 3>;

/// What a map that is given corner by corner becomes.
struct CornerCharts {
  Flattening flattening;
  std::size_t turned_over = 0;  ///< Triangles that were clockwise in uv: their charts are mirrored in u.
};

/// Joins triangles over the edges at which their uv agree, if they have the same label and orientation, into charts.
CornerCharts charts_of_corners(const TriangleMesh& mesh, const std::vector<CornerUv>& uv,
                               const std::vector<std::uint32_t>& label);

}  // namespace papilla::param_detail
