// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Options of fill_holes(). Both sizes are 0 by default: nothing is filled unless asked for.
struct FillHolesOptions {
  double max_slit_width_mm = 0;  ///< Loops whose filling is nowhere wider than this are gaps between faces.
  double max_diameter_mm = 0;    ///< Loops whose bounding box has at most this diagonal are holes.
  std::size_t max_edges = 5000;  ///< Longer loops stay open: filling costs up to the cube of their length.
};

struct FillHolesResult {
  TriangleMesh mesh;
  std::size_t slits = 0;         ///< Gaps closed.
  std::size_t holes = 0;         ///< Holes closed.
  std::size_t triangles = 0;     ///< Triangles added.
  std::size_t refused = 0;       ///< Loops small enough that stayed open, see below.
  double max_slit_width_mm = 0;  ///< The widest gap that was closed.
};

/// Closes boundary loops with triangles between their own vertices: gaps that a tessellator left between faces (every
/// added triangle's smallest altitude is within `max_slit_width_mm`), and holes up to `max_diameter_mm`.
/// No vertex moves. The minimal-weight triangulation is CGAL's (least largest dihedral angle, then area).
/// Added corners take the attribute values that the surface has there, and triangles the material and face of the
/// neighbour with the longest common edge.
///
/// A loop is refused when its filling would fold back onto the surface along more than half its length, for then it is
/// the outer border of a sheet; when it would add an edge that the mesh has already, which would not be manifold;
/// or when it crosses itself or touches another in a vertex.
/// Good input is manifold and oriented. O(n) to look, O(k^2) to O(k^3) for each candidate of k edges. Deterministic.
/// @throws InvalidInput when an index is out of range, a position is not finite, or a size is negative or not finite.
/// Source: Liepa, Filling Holes in Meshes, SGP 2003.
FillHolesResult fill_holes(TriangleMesh mesh, const FillHolesOptions& options);

}  // namespace papilla
