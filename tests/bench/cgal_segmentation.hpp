// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::bench {

/// CGAL's segmentation by the shape diameter function, for comparison: soft clustering and graph cut with CGAL's
/// default smoothing. Returns a segment number per triangle for every number of clusters; nothing when CGAL can't hold
/// the mesh or it has no diameter anywhere.
/// @param clusters levels of diameter, each >= 2.
std::vector<std::vector<std::uint32_t>> cgal_segments(const TriangleMesh& mesh, std::span<const std::size_t> clusters);

}  // namespace papilla::bench
