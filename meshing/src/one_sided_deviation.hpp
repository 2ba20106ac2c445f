// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/meshing/deviation.hpp"
#include "triangle_bvh.hpp"

namespace papilla::detail {

/// One side of surface_deviation() against a surface whose tree is at hand. @param from As check_distance_input() wants
/// it, with a triangle. @param to Not empty. @param floor_mm Smaller bounds are settled.
OneSidedDeviation one_sided_deviation(const TriangleMesh& from, const TriangleBvh& to, double floor_mm,
                                      const DeviationOptions& options);

}  // namespace papilla::detail
