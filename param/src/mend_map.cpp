// SPDX-License-Identifier: MIT
#include "mend_map.hpp"

#include <algorithm>
#include <utility>

#include "border_guard.hpp"
#include "ring_kernel.hpp"
#include "sheet_overlap.hpp"

namespace papilla::param_detail {
namespace {

/// As often vertices are moved; from some rounds on, their neighbours with them.
constexpr int k_rounds = 20, k_narrow = 6;

/// By which part of the way: where the border meets itself, and where triangles are turned over.
constexpr double k_drawn = 0.5, k_unfolded = 0.5;

/// Longer stretches between edges of the border that meet are the borders of whole parts of the map, not slits.
constexpr std::size_t k_most_between = 24;

constexpr Index k_none = ~Index{0};

class Mender {
 public:
  Mender(const ChartSurface& chart, const CornersOfVertices& corners, std::vector<Vec2>& uv)
      : chart_(chart), corners_(corners), uv_(uv), edge_from_(uv.size(), k_none) {
    for (const auto& [from, to] : border_of(chart.triangles, uv.size())) {
      edge_from_[from] = static_cast<Index>(border_.size());
      border_.push_back({from, to, {}, {}});
    }
  }

  bool run() {
    for (int round = 0;; ++round) {
      const std::vector<Index> turned_over = corners_turned_over();
      const std::vector<Index> meeting = turned_over.empty() ? border_that_meets() : std::vector<Index>{};
      if (turned_over.empty() && meeting.empty()) return true;
      if (round == k_rounds) return false;
      if (meeting.empty())
        turn_back(round < k_narrow ? turned_over : with_neighbours(turned_over));
      else
        draw_in(round < k_narrow ? meeting : with_neighbours(meeting));
    }
  }

 private:
  /// All at once, so that both sides of a slit go as far.
  void draw_in(const std::vector<Index>& vertices) {
    std::vector<Vec2> places;
    for (const Index v : vertices) places.push_back(uv_[v] + k_drawn * (middle_around(v) - uv_[v]));
    for (std::size_t i = 0; i < vertices.size(); ++i) uv_[vertices[i]] = places[i];
  }

  /// One after the other: two that both went over the edge between them would turn their triangle over again.
  void turn_back(const std::vector<Index>& vertices) {
    for (const Index v : vertices) {
      if (is_positive_around(v, uv_[v])) continue;
      const Vec2 wanted = edge_from_[v] != k_none ? by_shapes(v) : middle_around(v);
      if (is_positive_around(v, wanted))
        uv_[v] = wanted;
      else if (!find_place(v, uv_[v]))
        uv_[v] = uv_[v] + k_unfolded * (wanted - uv_[v]);
    }
  }

  /// Where all triangles around a vertex are positive, if anywhere.
  bool find_place(Index v, Vec2& place) const {
    std::vector<RingEdge> ring;
    for (const Index c : corners_.of(v)) {
      const Triangle& t = chart_.triangles[c / 3];
      ring.push_back({uv_[t[(c % 3 + 1) % 3]], uv_[t[(c % 3 + 2) % 3]], {}});
    }
    return middle_of_kernel(ring, false, place);
  }

  bool is_positive_around(Index v, Vec2 place) const {
    const auto corners = corners_.of(v);
    return std::all_of(corners.begin(), corners.end(), [&](Index c) {
      const Triangle& t = chart_.triangles[c / 3];
      return cross(uv_[t[(c % 3 + 1) % 3]] - place, uv_[t[(c % 3 + 2) % 3]] - place) > 0;
    });
  }

  std::vector<Index> with_neighbours(const std::vector<Index>& vertices) const {
    std::vector<Index> all;
    for (const Index v : vertices)
      for (const Index c : corners_.of(v))
        all.insert(all.end(), chart_.triangles[c / 3].begin(), chart_.triangles[c / 3].end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  std::vector<Index> corners_turned_over() const {
    std::vector<Index> corners;
    for (const Triangle& t : chart_.triangles)
      if (!(cross(uv_[t[1]] - uv_[t[0]], uv_[t[2]] - uv_[t[0]]) > 0)) corners.insert(corners.end(), t.begin(), t.end());
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
  }

  /// Ends of the border's edges that meet, and all between two of them that are few edges apart: where the sides of a
  /// slit have changed places, they meet in two edges alone.
  std::vector<Index> border_that_meets() {
    for (BorderEdge& edge : border_) edge.a = uv_[edge.from], edge.b = uv_[edge.to];
    std::vector<Index> vertices;
    for (const auto& [i, j] : edges_that_meet(border_))
      for (const auto& [first, last] : {std::pair(i, j), std::pair(j, i)}) {
        vertices.insert(vertices.end(), {border_[first].from, border_[first].to});
        const std::vector<Index> between = border_between(first, last);
        vertices.insert(vertices.end(), between.begin(), between.end());
      }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  /// Vertices from the end of an edge of the border to the start of another one; none where these are many.
  std::vector<Index> border_between(Index first, Index last) const {
    std::vector<Index> vertices;
    for (Index e = first; e != last; e = edge_from_[border_[e].to]) {
      if (e == k_none || vertices.size() == k_most_between) return {};
      vertices.push_back(border_[e].to);
    }
    return vertices;
  }

  Vec2 middle_around(Index v) const {
    const auto corners = corners_.of(v);
    Vec2 sum;
    for (const Index c : corners)
      for (const Index k : {1U, 2U}) sum = sum + uv_[chart_.triangles[c / 3][(c % 3 + k) % 3]];
    return (0.5 / static_cast<double>(corners.size())) * sum;
  }

  /// Where the triangles around a vertex would have it, of the shape that they have in space, at the edges opposite to
  /// it.
  Vec2 by_shapes(Index v) const {
    const auto corners = corners_.of(v);
    Vec2 sum;
    for (const Index c : corners) {
      const Triangle& t = chart_.triangles[c / 3];
      const Index a = t[(c % 3 + 1) % 3], b = t[(c % 3 + 2) % 3];
      const Vec3 edge = chart_.positions[b] - chart_.positions[a], out = chart_.positions[v] - chart_.positions[a];
      const double square = dot(edge, edge);
      const Vec2 image = uv_[b] - uv_[a];
      sum = sum + uv_[a];
      if (square > 0)
        sum = sum + (dot(out, edge) / square) * image + (norm(cross(out, edge)) / square) * Vec2{-image.y, image.x};
    }
    return (1 / static_cast<double>(corners.size())) * sum;
  }

  const ChartSurface& chart_;
  const CornersOfVertices& corners_;
  std::vector<Vec2>& uv_;
  std::vector<BorderEdge> border_;
  std::vector<Index> edge_from_;  ///< Per vertex: the edge of the border that begins there.
};

}  // namespace

bool mend_map(const ChartSurface& chart, const CornersOfVertices& corners, std::vector<Vec2>& uv) {
  return Mender(chart, corners, uv).run();
}

}  // namespace papilla::param_detail
