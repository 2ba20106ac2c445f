// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of weld(). The defaults close the noise of single-precision coordinates at any size of part.
struct WeldOptions {
  double relative_tolerance = 1e-6;    ///< Of the part's bounding diagonal; used when `tolerance_mm` is not given.
  std::optional<double> tolerance_mm;  ///< Overrides the relative tolerance.
  double feature_fraction = 0.45;  ///< No vertex moves further than this fraction of its shortest edge, in [0, 0.5):
                                   ///< below 0.5 no real edge can collapse. Edges of degenerate length don't count.
};

struct WeldResult {
  TriangleMesh mesh;
  std::size_t merged_equal = 0;  ///< Positions that another one equalled.
  std::size_t merged_near = 0;   ///< Vertices moved onto another one within the tolerance.
  std::size_t repeated = 0;      ///< Triangles dropped because two of their corners became one.
  double tolerance_mm = 0;       ///< The tolerance that was used.
  double max_deviation_mm = 0;   ///< The furthest that a vertex moved, at most `tolerance_mm`.
};

/// Makes positions that are exactly equal one vertex. Triangles, their order and all attributes stay; positions that
/// no triangle names are dropped. O(n) expected; deterministic.
/// @throws InvalidInput when an index is out of range or a position is not finite.
WeldResult weld_equal(TriangleMesh mesh);

/// weld_equal(), then moves every boundary vertex onto the nearest earlier boundary vertex p with
/// |v - p| <= min(tolerance, feature_fraction · shortest edge at v, the same at p): cracks along shared borders close,
/// while inner vertices, thin walls and short real edges stay. Triangles that repeat a corner afterwards are dropped.
/// Cost: O(n) plus O(b log b) for b boundary vertices. Deterministic: the first vertex in the mesh's order stays.
/// @throws InvalidInput as weld_equal(), and when an option is negative, not finite or feature_fraction >= 0.5.
WeldResult weld(TriangleMesh mesh, const WeldOptions& options = {});

/// What one tolerance of weld() gives.
struct WeldStep {
  double tolerance_mm = 0;
  double seconds = 0;                 ///< Wall time of weld() alone.
  double max_deviation_mm = 0;        ///< The furthest that a vertex moved.
  std::size_t boundary_edges = 0;     ///< Edges of one triangle that are left.
  std::size_t nonmanifold_edges = 0;  ///< Edges of more than two: what welding too much makes.
  std::size_t triangles = 0;          ///< Left; those that a weld collapsed are dropped.
};

/// Error over tolerance of weld(): each tolerance on the same input, in the order given. A good tolerance lies where
/// `boundary_edges` has fallen to a plateau while `max_deviation_mm` is still that of the file's noise; past the next
/// step down real features close. Cost: that of weld() and of counting edges, per tolerance. Deterministic but for the
/// seconds.
/// @param tolerances_mm Finite, not negative. @param options Its tolerances do not matter.
/// @throws InvalidInput as weld(), and when a tolerance is negative or not finite.
std::vector<WeldStep> weld_ladder(const TriangleMesh& mesh, std::span<const double> tolerances_mm,
                                  const WeldOptions& options = {});

}  // namespace papilla
