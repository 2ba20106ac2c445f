// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "segmented_mesh.hpp"

namespace papilla::detail {

/// Some triangles of a surface as a surface of its own, cut open along seams: every vertex has one fan of triangles.
/// Connectivity is the array of opposite half-edges (h = 3 t + k), which also holds what OpenMesh refuses: several
/// edges between the same two vertices.
struct Piece {
  Values<Vec3> positions;
  Values<Triangle> triangles;
  std::vector<Index> opposite;     ///< k_none at borders and seams.
  std::vector<Index> triangle_of;  ///< Local triangle -> the surface's.
  std::vector<Index> out;          ///< A half-edge from each vertex; the one on the border where there is one.

  std::size_t size() const noexcept { return triangles.size(); }
  std::size_t vertex_count() const noexcept { return positions.size(); }
  Index from(Index h) const noexcept { return triangles[h / 3][h % 3]; }
  Index to(Index h) const noexcept { return from(next_halfedge(h)); }
  double length(Index h) const noexcept { return norm(positions[to(h)] - positions[from(h)]); }
  double area(Index t) const noexcept;
  double area() const noexcept;
  bool on_border(Index v) const noexcept { return opposite[out[v]] == k_none; }
  /// The surface's half-edge.
  Index halfedge_of(Index h) const noexcept { return 3 * triangle_of[h / 3] + h % 3; }

  /// Calls visit(half-edge, neighbour) for every edge at v, counter-clockwise; the last one of a border vertex comes
  /// as the half-edge that runs to v.
  template <class Visit>
  void visit_edges(Index v, const Visit& visit) const {
    const Index start = out[v];
    Index h = start;
    do {
      visit(h, to(h));
      const Index in = previous_halfedge(h);
      h = opposite[in];
      if (h == k_none) visit(in, from(in));
    } while (h != start && h != k_none);
  }
};

/// Cuts pieces out of one surface. Pieces may be cut in parallel as long as they share no triangle.
class PieceCutter {
 public:
  /// @param seam per half-edge of the surface, the same on both sides; pieces are open there.
  PieceCutter(const SegmentedMesh& surface, const std::vector<std::uint8_t>& seam)
      : surface_(surface), seam_(seam), local_(surface.size()) {}

  /// @param triangles that seams and borders part from all others.
  Piece cut(std::vector<Index> triangles);

 private:
  const SegmentedMesh& surface_;
  const std::vector<std::uint8_t>& seam_;
  std::vector<Index> local_;
};

/// Border loops, each as half-edges in order with the surface on their left; the longest first, others by their
/// smallest half-edge.
std::vector<std::vector<Index>> border_loops(const Piece& piece);

}  // namespace papilla::detail
