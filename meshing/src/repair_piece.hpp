// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "papilla/meshing/repair.hpp"
#include "repair_steps.hpp"

/// repair() of one piece of a mesh, to the tolerances of the whole.
namespace papilla::detail {

/// What a repair works to: lengths that belong to the whole mesh.
struct RepairScale {
  double reference_mm = 0;  ///< reference_length() of the whole mesh.
  WeldReach weld;
  double stitch_mm = 0;
  double fill_holes_mm = 0;
  std::size_t max_passes = 1;
};

/// Repairs a mesh whose equal positions are one vertex. `weld_tolerance_mm` and `stitch_tolerance_mm` of the result
/// stay 0: they are the whole mesh's.
RepairResult repair_piece(TriangleMesh mesh, const RepairScale& scale, ProgressCallback progress);

/// Repairs the mesh when it is one closed surface that nothing around it can change: every edge has two triangles that
/// run it in opposite senses and are not each other's back, and they enclose a positive volume. Otherwise, and when the
/// repair opens the surface, returns nothing and `mesh` is what it was.
std::unique_ptr<RepairResult> repair_solid(const TriangleMesh& mesh, const RepairScale& scale);

}  // namespace papilla::detail
