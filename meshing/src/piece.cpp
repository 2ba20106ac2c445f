// SPDX-License-Identifier: MIT
#include "piece.hpp"

#include <algorithm>
#include <utility>

#include "papilla/core/union_find.hpp"

namespace papilla::detail {

double Piece::area(Index t) const noexcept {
  const Triangle& c = triangles[t];
  return 0.5 * norm(cross(positions[c[1]] - positions[c[0]], positions[c[2]] - positions[c[0]]));
}

double Piece::area() const noexcept {
  double sum = 0;
  for (Index t = 0; t < size(); ++t) sum += area(t);
  return sum;
}

Piece PieceCutter::cut(std::vector<Index> triangles) {
  Piece piece;
  piece.triangle_of = std::move(triangles);
  for (Index i = 0; i < piece.triangle_of.size(); ++i) local_[piece.triangle_of[i]] = i;
  const std::size_t halfedges = 3 * piece.triangle_of.size();
  piece.opposite.assign(halfedges, k_none);
  for (Index h = 0; h < halfedges; ++h) {
    const Index global = piece.halfedge_of(h), other = surface_.opposite[global];
    if (other == k_none || seam_[global]) continue;
    piece.opposite[h] = 3 * local_[triangle_of(other)] + other % 3;
  }
  UnionFind fans = join_fans(piece.opposite);
  Index count = 0;
  const std::vector<Index> vertex = fans.labels(count);
  piece.triangles.resize(piece.triangle_of.size());
  piece.positions.resize(count);
  piece.out.assign(count, k_none);
  for (Index h = 0; h < halfedges; ++h) {
    const Index v = vertex[h];
    piece.triangles[h / 3][h % 3] = v;
    piece.positions[v] = surface_.positions[from_vertex(surface_.triangles, piece.halfedge_of(h))];
    if (piece.out[v] == k_none || piece.opposite[h] == k_none) piece.out[v] = h;
  }
  return piece;
}

std::vector<std::vector<Index>> border_loops(const Piece& piece) {
  std::vector<std::vector<Index>> loops;
  std::vector<double> lengths;
  std::vector<std::uint8_t> seen(piece.opposite.size(), 0);
  for (Index start = 0; start < piece.opposite.size(); ++start) {
    if (piece.opposite[start] != k_none || seen[start]) continue;
    std::vector<Index>& loop = loops.emplace_back();
    double& length = lengths.emplace_back(0);
    Index h = start;
    do {
      seen[h] = 1;
      loop.push_back(h);
      length += piece.length(h);
      h = piece.out[piece.to(h)];
    } while (h != start);
  }
  if (!loops.empty())
    std::iter_swap(loops.begin(), loops.begin() + (std::max_element(lengths.begin(), lengths.end()) - lengths.begin()));
  return loops;
}

}  // namespace papilla::detail
