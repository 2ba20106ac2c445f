// SPDX-License-Identifier: MIT
#include "edge_table.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

#include "papilla/core/union_find.hpp"

namespace papilla::detail {
namespace {

/// Sums counts into range starts: begin[i] becomes the sum of the counts before i.
void counts_to_begin(std::vector<Index>& begin) {
  Index sum = 0;
  for (Index& value : begin) sum += std::exchange(value, sum);
}

/// A vertex has few edges to larger ones: three on average.
void sort_short(std::uint64_t* begin, std::uint64_t* end) {
  constexpr std::ptrdiff_t k_short = 16;
  if (end - begin > k_short) {
    std::sort(begin, end);
    return;
  }
  for (std::uint64_t* i = begin; i < end; ++i) {
    const std::uint64_t value = *i;
    std::uint64_t* place = i;
    for (; place > begin && value < place[-1]; --place) *place = place[-1];
    *place = value;
  }
}

constexpr std::uint64_t pack(Index high, Index low) noexcept { return std::uint64_t{high} << 32 | low; }

}  // namespace

EdgeTable::EdgeTable(std::span<const Triangle> triangles, std::size_t vertex_count) {
  std::vector<Index> slot(vertex_count + 1, 0);
  for (const Triangle& t : triangles)
    if (!repeats_corner(t))
      for (std::size_t k = 0; k < 3; ++k) ++slot[std::min(t[k], t[next_corner(k)])];
  counts_to_begin(slot);

  std::vector<std::uint64_t> packed(slot.back());
  for (Index i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    if (repeats_corner(t)) continue;
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[next_corner(k)]);
      packed[slot[low]++] = pack(high, 3 * i + k);
    }
  }

  halfedges_.resize(packed.size());
  begin_.reserve(packed.size() / 2 + 2);
  std::size_t start = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const std::size_t end = slot[v];
    sort_short(packed.data() + start, packed.data() + end);
    for (std::size_t i = start; i < end; ++i) {
      if (i == start || packed[i] >> 32 != packed[i - 1] >> 32) begin_.push_back(static_cast<Index>(i));
      halfedges_[i] = static_cast<Index>(packed[i]);
    }
    start = end;
  }
  begin_.push_back(static_cast<Index>(packed.size()));
}

std::vector<Index> EdgeTable::boundary_halfedges() const {
  std::vector<Index> boundary;
  for (std::size_t e = 0; e < size(); ++e)
    if (begin_[e + 1] - begin_[e] == 1) boundary.push_back(halfedges_[begin_[e]]);
  return boundary;
}

std::vector<Index> opposite_halfedges(std::span<const Triangle> triangles, const EdgeTable& edges) {
  std::vector<Index> opposite(3 * triangles.size(), k_none);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    if (h.size() != 2 || runs_up(triangles, h[0]) == runs_up(triangles, h[1])) continue;
    opposite[h[0]] = h[1];
    opposite[h[1]] = h[0];
  }
  return opposite;
}

std::vector<Index> opposite_within_labels(std::span<const Triangle> triangles, const EdgeTable& edges,
                                          std::span<const std::uint32_t> labels) {
  std::vector<Index> opposite(3 * triangles.size(), k_none);
  for (std::size_t e = 0; e < edges.size(); ++e) link_within_labels(triangles, edges.halfedges(e), labels, opposite);
  return opposite;
}

void link_within_labels(std::span<const Triangle> triangles, std::span<const Index> edge,
                        std::span<const std::uint32_t> labels, std::span<Index> opposite) {
  const auto label_of = [&](Index h) { return labels[triangle_of(h)]; };
  const auto link = [&](Index a, Index b) {
    if (runs_up(triangles, a) != runs_up(triangles, b)) opposite[a] = b, opposite[b] = a;
  };
  if (edge.size() == 2 && label_of(edge[0]) == label_of(edge[1])) link(edge[0], edge[1]);
  if (edge.size() <= 2) return;
  std::vector<std::pair<std::uint32_t, Index>> group;
  for (const Index h : edge) group.emplace_back(label_of(h), h);
  std::sort(group.begin(), group.end());
  for (std::size_t begin = 0, end = 0; begin < group.size(); begin = end) {
    while (end < group.size() && group[end].first == group[begin].first) ++end;
    if (end - begin == 2) link(group[begin].second, group[end - 1].second);
  }
}

UnionFind join_fans(std::span<const Index> opposite) {
  UnionFind fans(opposite.size());
  for (Index h = 0; h < opposite.size(); ++h) {
    if (opposite[h] == k_none || opposite[h] < h) continue;
    fans.unite(h, next_halfedge(opposite[h]));
    fans.unite(next_halfedge(h), opposite[h]);
  }
  return fans;
}

VertexTriangles::VertexTriangles(std::span<const Triangle> mesh_triangles, std::size_t vertex_count)
    : begin(vertex_count + 1, 0), triangles(3 * mesh_triangles.size()) {
  for (const Triangle& t : mesh_triangles)
    for (const Index v : t) ++begin[v];
  counts_to_begin(begin);
  std::vector<Index> slot = begin;
  for (Index i = 0; i < mesh_triangles.size(); ++i)
    for (const Index v : mesh_triangles[i]) triangles[slot[v]++] = i;
}

}  // namespace papilla::detail
