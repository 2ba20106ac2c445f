// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::cad {

/// A vertex of a face's triangulation.
struct PatchNode {
  Vec3 position;
  Vec3 normal;  ///< du × dv of the surface, unit length; zero where it has none.
  Vec2 uv;
  Vec3 gap;  ///< From the surface's point at uv to `position`: CAD edges lie off their surfaces by their tolerance.
  std::uint32_t shared = k_no_value;  ///< Number of the point on a CAD edge or vertex that other faces use, too.
  bool free_u = false,
       free_v = false;  ///< On an edge that the parametrization collapses: this parameter means nothing.

  bool is_singular() const noexcept { return free_u || free_v; }
};

/// Half-edge 3t + k runs from corner k of triangle t to the next corner.
using HalfEdge = std::uint32_t;

/// The triangles of one CAD face, counter-clockwise in (u, v), with their neighbours. Edges are split and flipped in
/// place; boundary edges and marked ones are never flipped.
class FacePatch {
 public:
  std::vector<PatchNode> nodes;
  std::vector<Triangle> triangles;

  /// Finds the neighbours.
  /// @return false when an edge has three triangles or two that run the same way.
  bool connect();

  HalfEdge opposite(HalfEdge h) const { return opposite_[h]; }
  bool is_boundary(HalfEdge h) const { return opposite_[h] == k_no_value; }
  bool is_fixed(HalfEdge h) const { return is_boundary(h) || fixed_[h] != 0; }
  void fix(HalfEdge h);

  static HalfEdge next(HalfEdge h) { return h % 3 == 2 ? h - 2 : h + 1; }
  Index from(HalfEdge h) const { return triangles[h / 3][h % 3]; }
  Index to(HalfEdge h) const { return from(next(h)); }
  Index apex(HalfEdge h) const { return from(next(next(h))); }

  /// Puts node m on the edge. h then runs from its start to m; the result from m to its end.
  HalfEdge split(HalfEdge h, Index m);
  /// Puts node m into the triangle, which then keeps its first edge; the two others begin the appended triangles.
  void insert(std::uint32_t triangle, Index m);
  /// Turns the edge between two triangles to their other diagonal; h stays one of its half-edges.
  void flip(HalfEdge h);
  /// Replaces all of the nodes by the first of them and removes the triangles that collapse.
  void merge(const std::vector<Index>& same);
  /// Removes triangles, then finds the neighbours anew; nodes stay.
  bool remove(const std::vector<std::uint8_t>& gone);
  /// The half-edges that leave the start of h, one of each of its triangles.
  std::vector<HalfEdge> around(HalfEdge h) const;
  /// Merges the start of h, which is inside of the face, into its end. The two triangles beside h then name one node
  /// three times and are to be removed.
  void collapse(HalfEdge h);

  /// All triangles, each near those before it: rings around the first of every piece. Refinement leaves them scattered,
  /// which costs cache misses in every loop over them.
  std::vector<std::uint32_t> in_rings() const;

  /// Parameters of the point with barycentric coordinates w; a meaningless parameter of a singular corner is taken from
  /// the other corners.
  Vec2 uv_in(std::uint32_t triangle, const std::array<double, 3>& w) const;
  /// Parameters of corner k as the triangle sees it.
  Vec2 corner_uv(std::uint32_t triangle, std::size_t k) const;
  Vec2 middle_uv(Index a, Index b) const;
  Vec3 point_in(std::uint32_t triangle, const std::array<double, 3>& w) const;

 private:
  void link(HalfEdge a, HalfEdge b);

  std::vector<HalfEdge> opposite_;
  std::vector<std::uint8_t> fixed_;
};

}  // namespace papilla::cad
