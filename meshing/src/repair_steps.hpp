// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>

#include "edge_table.hpp"
#include "papilla/meshing/degenerate.hpp"
#include "papilla/meshing/duplicate.hpp"
#include "papilla/meshing/fill_holes.hpp"
#include "papilla/meshing/manifold.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/t_junction.hpp"
#include "papilla/meshing/weld.hpp"

/// The steps of repair() without the checks of their public functions, which share the table of edges. Each changes
/// the mesh in place, adds to the counts of its result (whose mesh stays empty), and returns true when it changed
/// triangles or vertices so that the table is no longer that of the mesh.
namespace papilla::detail {

/// Makes positions that are exactly equal one vertex and drops those that no triangle names; returns how many were
/// merged.
std::size_t merge_equal(TriangleMesh& mesh);

/// The same for positions that single precision makes equal, in millimetres (PLY, STL) or metres (glTF). Each keeps the
/// place of the first; raises `max_deviation_mm` to the furthest that one moved.
std::size_t merge_stored_equal(TriangleMesh& mesh, double& max_deviation_mm);

/// How far welding may move vertices; see WeldOptions.
struct WeldReach {
  double tolerance_mm = 0;
  double feature_fraction = 0;
  double shortest_feature_mm = 0;  ///< Shorter edges are noise and don't limit the tolerance.
};

bool weld_borders(TriangleMesh& mesh, const EdgeTable& edges, const WeldReach& reach, WeldResult& result);

/// What becomes of backs of double sheets.
enum class Backs { keep_seen, drop };  ///< As remove_duplicates() has it, or none stays.
bool drop_duplicates(TriangleMesh& mesh, const EdgeTable& edges, Backs backs, DuplicateResult& result);

/// Removes triangles with altitudes below `sought_mm`; those that this makes have at least `least_mm`, not less.
bool resolve_degenerate(TriangleMesh& mesh, double sought_mm, double least_mm, DegenerateResult& result);
bool split_borders(TriangleMesh& mesh, const EdgeTable& edges, double reach_mm, double from_ends_mm,
                   TJunctionResult& result);
bool turn_over(TriangleMesh& mesh, const EdgeTable& edges, OrientResult& result);
/// Where others are in the way, copies that are parted go this many gaps far.
inline constexpr int k_most_parting_steps = 16;
bool part_sheets(TriangleMesh& mesh, const EdgeTable& edges, double gap_mm, ManifoldResult& result);
bool fill_borders(TriangleMesh& mesh, const EdgeTable& edges, const FillHolesOptions& options, FillHolesResult& result);

/// What another pass would look for; see repair().
bool has_near_borders(const TriangleMesh& mesh, const EdgeTable& edges, const WeldReach& reach);
bool has_duplicates(std::span<const Triangle> triangles, const EdgeTable& edges);
bool has_degenerate(const TriangleMesh& mesh, double tolerance_mm);
bool has_bad_edges(std::span<const Triangle> triangles, const EdgeTable& edges);

/// Lengths of the whole mesh, to which repair() works on each piece of it.
struct RepairScale {
  double reference_mm = 0;  ///< reference_length() of the whole mesh.
  WeldReach weld;
  double stitch_mm = 0;
  double fill_holes_mm = 0;
  double tolerance_mm = 0;  ///< As RepairResult has it.
  std::size_t max_passes = 1;
  std::size_t sample_above = 0;
};

/// Repairs a mesh whose equal positions are one vertex. `weld_tolerance_mm` and `stitch_tolerance_mm` of the result
/// stay 0: they are the whole mesh's.
RepairResult repair_piece(TriangleMesh mesh, const RepairScale& scale, ProgressCallback progress);

/// Repairs the mesh when it is one closed surface that nothing around it can change: every edge has two triangles that
/// run it in opposite senses and are not each other's back, and they enclose a positive volume. Otherwise, and when the
/// repair opens the surface, returns nothing and `mesh` is what it was.
std::unique_ptr<RepairResult> repair_solid(const TriangleMesh& mesh, const RepairScale& scale);

}  // namespace papilla::detail
