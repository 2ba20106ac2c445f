// SPDX-License-Identifier: MIT
#include "border_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "papilla/core/bounds.hpp"

namespace papilla::param_detail {
namespace {

/// Edges are not brought closer than this fraction of their mean length.
constexpr double k_contact = 1e-3;

/// Reach of the barrier over the shortest edge at hand.
constexpr double k_reach = 0.25;

/// How hard a vertex and an edge of the border push each other away, in mean areas of a triangle.
constexpr double k_push = 0.05;

/// Cells of the grid per edge of the border, at most.
constexpr double k_cells_per_edge = 16;

double length(Vec2 a) { return std::sqrt(dot(a, a)); }

Bounds2 bounds_of(std::span<const BorderPair> border, std::span<const Vec2> uv) {
  Bounds2 bounds;
  for (const BorderPair& pair : border) bounds.add(uv[pair[0]]);
  return bounds;
}

/// The point of a segment that is closest to a vertex.
struct Closest {
  double along = 0;  ///< 0 at the start, 1 at the end.
  Vec2 away;         ///< From there to the vertex.
};

Closest closest(Vec2 vertex, Vec2 from, Vec2 to) {
  const Vec2 d = to - from;
  const double square = dot(d, d);
  const double along = square > 0 ? std::clamp(dot(vertex - from, d) / square, 0.0, 1.0) : 0.0;
  return {along, vertex - from - along * d};
}

}  // namespace

BorderGuard::BorderGuard(std::vector<BorderPair> border, std::vector<Vec2> uv)
    : border_(std::move(border)), uv_(std::move(uv)), edges_of_(uv_.size(), {k_no_edge, k_no_edge}) {
  const Bounds2 extent = bounds_of(border_, uv_);
  double total = 0;
  for (const BorderPair& pair : border_) total += length(uv_[pair[1]] - uv_[pair[0]]);
  const double edges = static_cast<double>(border_.size());
  cell_ = std::max(total / edges, std::max(extent.size().x, extent.size().y) / std::sqrt(k_cells_per_edge * edges));
  tolerance_ = k_contact * total / edges;
  low_ = extent.low;
  columns_ = static_cast<std::size_t>((extent.high.x - extent.low.x) / cell_) + 1;
  rows_ = static_cast<std::size_t>((extent.high.y - extent.low.y) / cell_) + 1;
  cells_.resize(columns_ * rows_);
  for (Index e = 0; e < border_.size(); ++e) {
    edges_of_[border_[e][0]][1] = edges_of_[border_[e][1]][0] = e;
    put_in(e);
  }
}

std::size_t BorderGuard::column(double x) const {
  return static_cast<std::size_t>(std::clamp((x - low_.x) / cell_, 0.0, static_cast<double>(columns_ - 1)));
}

std::size_t BorderGuard::row(double y) const {
  return static_cast<std::size_t>(std::clamp((y - low_.y) / cell_, 0.0, static_cast<double>(rows_ - 1)));
}

template <class Visit>
bool BorderGuard::any_cell(const BorderEdge& e, Visit visit) const {
  const std::size_t x1 = column(std::max(e.a.x, e.b.x)), y1 = row(std::max(e.a.y, e.b.y));
  for (std::size_t y = row(std::min(e.a.y, e.b.y)); y <= y1; ++y)
    for (std::size_t x = column(std::min(e.a.x, e.b.x)); x <= x1; ++x)
      if (visit(y * columns_ + x)) return true;
  return false;
}

void BorderGuard::put_in(Index e) {
  any_cell(edge(e), [&](std::size_t cell) {
    cells_[cell].push_back(e);
    return false;
  });
}

void BorderGuard::take_out(Index e) {
  any_cell(edge(e), [&](std::size_t cell) {
    std::erase(cells_[cell], e);
    return false;
  });
}

template <class LeavesOut>
bool BorderGuard::are_free(std::span<const BorderEdge> edges, LeavesOut leaves_out) const {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (edges_conflict(edges[i], edges[j], tolerance_)) return false;
    const bool conflict = any_cell(edges[i], [&](std::size_t cell) {
      return std::any_of(cells_[cell].begin(), cells_[cell].end(), [&](Index other) {
        return !leaves_out(other) && !edges_apart(edges[i], edge(other), tolerance_) &&
               edges_conflict(edges[i], edge(other), tolerance_);
      });
    });
    if (conflict) return false;
  }
  return true;
}

bool BorderGuard::may_move(Index vertex, Vec2 place) const {
  std::array<BorderEdge, 2> moved{edge(edges_of_[vertex][0]), edge(edges_of_[vertex][1])};
  moved[0].b = moved[1].a = place;
  return are_free(moved, [&](Index other) { return other == edges_of_[vertex][0] || other == edges_of_[vertex][1]; });
}

bool BorderGuard::may_split(Index from, Index to, Index vertex, Vec2 place) const {
  const Index old = edges_of_[from][1];
  const std::array<BorderEdge, 2> halves{BorderEdge{from, vertex, uv_[from], place},
                                         BorderEdge{vertex, to, place, uv_[to]}};
  return are_free(halves, [&](Index other) { return other == old; });
}

void BorderGuard::split(Index from, Index to, Index vertex, Vec2 place) {
  const Index first = edges_of_[from][1], second = static_cast<Index>(border_.size());
  take_out(first);
  uv_[vertex] = place;
  border_[first][1] = vertex;
  border_.push_back({vertex, to});
  edges_of_[to][0] = second;
  edges_of_[vertex] = {first, second};
  put_in(first);
  put_in(second);
}

void BorderGuard::move(Index vertex, Vec2 place) {
  const auto box = [&](Index e) {
    const BorderEdge own = edge(e);
    return std::array{column(std::min(own.a.x, own.b.x)), column(std::max(own.a.x, own.b.x)),
                      row(std::min(own.a.y, own.b.y)), row(std::max(own.a.y, own.b.y))};
  };
  const Vec2 before = uv_[vertex];
  for (const Index e : edges_of_[vertex]) {
    uv_[vertex] = place;
    const auto next = box(e);
    uv_[vertex] = before;
    if (next == box(e)) continue;
    take_out(e);
    uv_[vertex] = place;
    put_in(e);
  }
  uv_[vertex] = place;
}

BorderBarrier::BorderBarrier(std::vector<BorderPair> border, std::span<const Vec2> uv, double weight)
    : border_(std::move(border)), reach_(uv.size(), std::numeric_limits<double>::infinity()), weight_(weight) {
  for (const auto& [from, to] : border_) {
    const double reach = k_reach * length(uv[to] - uv[from]);
    reach_[from] = std::min(reach_[from], reach);
    reach_[to] = std::min(reach_[to], reach);
    most_reach_ = std::max(most_reach_, reach);
  }
}

std::vector<BorderBarrier::Pair> BorderBarrier::near_pairs(std::span<const Vec2> uv, double widening) const {
  if (border_.empty()) return {};
  const Bounds2 extent = bounds_of(border_, uv);
  const double edges = static_cast<double>(border_.size());
  const double cell =
      std::max(most_reach_ / k_reach, std::max(extent.size().x, extent.size().y) / std::sqrt(k_cells_per_edge * edges));
  const auto columns = static_cast<std::size_t>((extent.high.x - extent.low.x) / cell) + 1;
  const auto rows = static_cast<std::size_t>((extent.high.y - extent.low.y) / cell) + 1;
  const auto number = [cell](double distance, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(distance / cell, 0.0, static_cast<double>(count - 1)));
  };
  const auto column = [&](double x) { return number(x - extent.low.x, columns); };
  const auto row = [&](double y) { return number(y - extent.low.y, rows); };
  // The border's vertices sorted by cell.
  std::vector<Index> first(columns * rows + 2, 0), sorted(border_.size());
  const auto cell_of = [&](Vec2 p) { return row(p.y) * columns + column(p.x); };
  for (const BorderPair& pair : border_) ++first[cell_of(uv[pair[0]]) + 2];
  for (std::size_t c = 2; c < first.size(); ++c) first[c] += first[c - 1];
  for (const BorderPair& pair : border_) sorted[first[cell_of(uv[pair[0]]) + 1]++] = pair[0];
  std::vector<Pair> pairs;
  for (const auto& [from, to] : border_) {
    const Vec2 a = uv[from], b = uv[to];
    const double edge_reach = std::min(reach_[from], reach_[to]), around = widening * edge_reach;
    const Vec2 low{std::min(a.x, b.x) - around, std::min(a.y, b.y) - around};
    const Vec2 high{std::max(a.x, b.x) + around, std::max(a.y, b.y) + around};
    const std::size_t x0 = column(low.x), x1 = column(high.x), y1 = row(high.y);
    for (std::size_t y = row(low.y); y <= y1; ++y)
      for (Index i = first[y * columns + x0]; i < first[y * columns + x1 + 1]; ++i) {
        const Index v = sorted[i];
        const Vec2 p = uv[v];
        if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y || v == from || v == to) continue;
        const double reach = std::min(edge_reach, reach_[v]);
        const Vec2 away = closest(p, a, b).away;
        if (dot(away, away) < widening * widening * reach * reach) pairs.push_back({v, from, to, reach});
      }
  }
  return pairs;
}

double BorderBarrier::value(const Pair& pair, std::span<const Vec2> uv) const {
  const double d = length(closest(uv[pair.vertex], uv[pair.from], uv[pair.to]).away);
  const double excess = pair.reach / d - 1;
  return excess > 0 ? weight_ * excess * excess : 0;
}

std::array<Vec2, 3> BorderBarrier::gradient(const Pair& pair, std::span<const Vec2> uv) const {
  const Closest c = closest(uv[pair.vertex], uv[pair.from], uv[pair.to]);
  const double d = length(c.away);
  if (!(d < pair.reach)) return {};
  // The closest point may be held: it is a minimum.
  const Vec2 by_vertex = (-2 * weight_ * (pair.reach / d - 1) * pair.reach / (d * d * d)) * c.away;
  return {by_vertex, (c.along - 1) * by_vertex, -c.along * by_vertex};
}

void BorderBarrier::hessian(const Pair& pair, std::span<const Vec2> uv, double* matrix) const {
  const Closest c = closest(uv[pair.vertex], uv[pair.from], uv[pair.to]);
  const double d = length(c.away);
  std::fill_n(matrix, 36, 0.0);
  if (!(d < pair.reach)) return;
  const double curvature = 2 * weight_ * pair.reach / (d * d * d) * (3 * pair.reach / d - 2);
  const std::array<double, 3> share{1, c.along - 1, -c.along};
  std::array<double, 6> direction;
  for (std::size_t k = 0; k < 3; ++k)
    direction[2 * k] = share[k] * c.away.x / d, direction[2 * k + 1] = share[k] * c.away.y / d;
  for (std::size_t j = 0; j < 6; ++j)
    for (std::size_t i = 0; i < 6; ++i) matrix[6 * j + i] = curvature * direction[i] * direction[j];
}

bool BorderBarrier::is_simple(std::span<const Vec2> uv) const {
  std::vector<BorderEdge> edges;
  edges.reserve(border_.size());
  for (const auto& [from, to] : border_) edges.push_back({from, to, uv[from], uv[to]});
  return border_proves_injective(edges);
}

BorderBarrier barrier_of(std::vector<BorderPair> border, std::span<const Vec2> uv, double area, std::size_t triangles) {
  return {std::move(border), uv, k_push * area / static_cast<double>(triangles)};
}

std::vector<BorderPair> border_of(std::span<const Triangle> triangles, std::size_t vertices) {
  // Around a vertex within, every neighbour comes once before and once after it.
  std::vector<Index> one_sided(vertices, 0);
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) one_sided[t[k]] += t[(k + 1) % 3] - t[(k + 2) % 3];
  std::vector<BorderPair> border, back;  // edges between vertices of the border, as triangles have them and turned
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = t[k], to = t[(k + 1) % 3];
      if (one_sided[from] == 0 || one_sided[to] == 0) continue;
      border.push_back({from, to});
      back.push_back({to, from});
    }
  std::sort(back.begin(), back.end());
  std::erase_if(border,
                [&](const BorderPair& edge) { return std::binary_search(back.begin(), back.end(), edge); });  // within
  return border;
}

}  // namespace papilla::param_detail
