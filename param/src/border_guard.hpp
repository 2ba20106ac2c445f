// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sheet_overlap.hpp"

namespace papilla::param_detail {

/// A directed edge of a chart's border between two vertices.
using BorderPair = std::array<Index, 2>;

/// Edges that have no opposite one, in the order of the triangles.
std::vector<BorderPair> border_of(std::span<const Triangle> triangles, std::size_t vertices);

/// The border of a map while vertices move one by one, and whether it would run into itself.
class BorderGuard {
 public:
  BorderGuard(std::vector<BorderPair> border, std::vector<Vec2> uv);

  bool on_border(Index vertex) const { return edges_of_[vertex][0] != k_no_edge; }
  /// Whether the border stays free of contact when the vertex goes to `place`.
  bool may_move(Index vertex, Vec2 place) const;
  void move(Index vertex, Vec2 place);

  /// The same for a new vertex in the middle of the edge between two others.
  bool may_split(Index from, Index to, Index vertex, Vec2 place) const;
  void split(Index from, Index to, Index vertex, Vec2 place);

 private:
  static constexpr Index k_no_edge = ~Index{0};
  BorderEdge edge(Index e) const { return {border_[e][0], border_[e][1], uv_[border_[e][0]], uv_[border_[e][1]]}; }
  std::size_t column(double x) const;
  std::size_t row(double y) const;
  template <class Visit>
  bool any_cell(const BorderEdge& e, Visit visit) const;
  /// Whether two new edges at `vertex` meet each other, or any edge but those that `leaves_out` names.
  template <class LeavesOut>
  bool are_free(std::span<const BorderEdge> edges, LeavesOut leaves_out) const;
  void put_in(Index e);
  void take_out(Index e);

  std::vector<BorderPair> border_;
  std::vector<Vec2> uv_;
  std::vector<std::array<Index, 2>> edges_of_;  ///< Per vertex: that to it and that from it; none off the border.
  std::vector<std::vector<Index>> cells_;
  std::size_t columns_ = 1, rows_ = 1;
  Vec2 low_;
  double cell_ = 1, tolerance_ = 0;
};

/// Keeps the border away from itself: Σ weight (reach / d - 1)² over border vertices and border edges that are
/// d < reach apart [J. Smith, S. Schaefer, Bijective parameterization with free boundaries, 2015]. The reach is a fixed
/// fraction of the shortest border edge at the three vertices, so that neighbours on the border don't push each other.
class BorderBarrier {
 public:
  struct Pair {
    Index vertex, from, to;
    double reach;
  };

  /// @param uv gives the lengths of the edges.
  BorderBarrier(std::vector<BorderPair> border, std::span<const Vec2> uv, double weight);

  /// Vertices and edges that push each other, or are no further apart than `widening` times that.
  std::vector<Pair> near_pairs(std::span<const Vec2> uv, double widening = 1) const;
  double value(const Pair& pair, std::span<const Vec2> uv) const;
  std::array<Vec2, 3> gradient(const Pair& pair, std::span<const Vec2> uv) const;
  /// Positive semidefinite; 6 × 6, column major.
  void hessian(const Pair& pair, std::span<const Vec2> uv, double* matrix) const;
  /// Whether the border meets itself nowhere; with positive triangles, the map is then injective.
  bool is_simple(std::span<const Vec2> uv) const;

 private:
  std::vector<BorderPair> border_;
  std::vector<double> reach_;  ///< Per vertex.
  double most_reach_ = 0, weight_;
};

/// The barrier of a map: how hard it pushes goes by the mean area of a triangle.
BorderBarrier barrier_of(std::vector<BorderPair> border, std::span<const Vec2> uv, double area, std::size_t triangles);

}  // namespace papilla::param_detail
