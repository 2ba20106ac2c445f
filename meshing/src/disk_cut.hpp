// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/triangle_mesh.hpp"
#include "surface.hpp"

namespace papilla::detail {

/// Bisects every chart that is no disk until all are. Labels must be dense and their charts connected; new charts get
/// the numbers from `count` on. Returns the number of bisections.
std::size_t cut_to_disks(const TriangleMesh& mesh, const Surface& surface, const Progress& progress,
                         std::uint32_t count, std::vector<std::uint32_t>& labels);

}  // namespace papilla::detail
