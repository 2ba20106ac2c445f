// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"
#include "triangle_geometry.hpp"

namespace papilla::detail {

/// A point of a surface and how far it is from the point asked for.
struct ClosestPoint {
  double squared_distance = std::numeric_limits<double>::infinity();
  Index triangle = k_no_value;
};

/// A tree of boxes over a triangle list, for closest points and for sight lines. Four boxes a node, single precision
/// around the list's centre and rounded outwards by more than the search's own rounding; the triangles themselves stay
/// in double precision. Own code because the known libraries lack what the callers live on: a start bound for the
/// search ("nearer than this?", from the neighbour's answer) and answers in double precision. Building costs O(n log n)
/// by the surface area heuristic, in parallel; about 150 bytes a triangle, up to twice that when most are slanted
/// slivers, which lie in rows of boxes. Any triangle shape is fine. Same input, same tree, whatever the number of
/// threads.
class TriangleBvh {
 public:
  /// @param positions Finite. @param triangles With indices in range; the positions are copied.
  TriangleBvh(std::span<const Vec3> positions, std::span<const Triangle> triangles);

  std::size_t size() const noexcept { return slot_of_.size(); }

  /// The closest point if it is nearer than `start`, else `start`. The search ends with any point whose squared
  /// distance is at most `enough`: where many boxes overlap, as those of a fan of slivers, proving it the closest costs
  /// most.
  ClosestPoint closest(const Vec3& p, ClosestPoint start = {}, double enough = 0) const noexcept;

  /// Does a triangle other than `ignored` cut the open segment from a to b?
  bool blocks(const Vec3& a, const Vec3& b, Index ignored = k_no_value) const noexcept;

  /// The triangle with this number in the list.
  const TriangleFrame& frame(Index triangle) const noexcept { return prims_[slot_of_[triangle]].frame; }

 private:
  struct Prim {  ///< A box of a triangle.
    TriangleFrame frame;
    Index triangle = 0;
  };
  /// Children >= 0 are nodes, others leaves of ~child: first prim in the upper bits, count in the lower three.
  struct alignas(64) Node {
    float low[3][4], high[3][4];
    std::int64_t child[4];
  };
  friend class BvhBuilder;

  Vec3 centre_;
  std::vector<Node> nodes_;
  std::vector<Prim> prims_;
  std::vector<Index> slot_of_;
};

}  // namespace papilla::detail
