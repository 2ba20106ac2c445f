// SPDX-License-Identifier: MIT
#include "chart_pieces.hpp"

#include "chunks.hpp"

namespace papilla::param_detail {
namespace {

constexpr Index k_no_vertex = ~Index{0}, k_no_corner = ~Index{0};

}  // namespace

TrianglesOfCharts sort_by_chart(const std::vector<std::uint32_t>& chart_of_triangle, std::uint32_t count) {
  TrianglesOfCharts result;
  result.first.assign(std::size_t{count} + 2, 0);
  for (const std::uint32_t chart : chart_of_triangle) ++result.first[std::size_t{chart} + 2];
  for (std::size_t c = 2; c < result.first.size(); ++c) result.first[c] += result.first[c - 1];
  result.triangles.resize(chart_of_triangle.size());
  for (std::size_t t = 0; t < chart_of_triangle.size(); ++t)
    result.triangles[result.first[std::size_t{chart_of_triangle[t]} + 1]++] = static_cast<Index>(t);
  result.first.pop_back();
  return result;
}

double seam_length(const TriangleMesh& mesh, const Adjacency& across, const std::vector<std::uint32_t>& chart) {
  double length = 0;
  for (std::size_t h = 0; h < across.size(); ++h) {
    const std::size_t t = h / 3;
    if (across[h] == k_no_triangle || across[h] < t || chart[across[h]] == chart[t]) continue;
    const int k = static_cast<int>(h % 3);
    length += norm(mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k));
  }
  return length;
}

ChartSurface ChartCutter::cut(std::uint32_t chart, std::span<const Index> triangles) const {
  ChartSurface surface;
  surface.triangles.assign(triangles.size(), {k_no_vertex, k_no_vertex, k_no_vertex});
  surface.across.assign(triangles.size(), {k_no_triangle, k_no_triangle, k_no_triangle});
  for_chunks(triangles.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index other = (*across_)[3 * std::size_t{triangles[i]} + k];
        if (other != k_no_triangle && charts_->of_triangle[other] == chart) surface.across[i][k] = local_[other];
      }
  });
  const auto vertex = [&](Index corner) { return mesh_->triangles[triangles[corner / 3]][corner % 3]; };
  // The corner at the same vertex beyond the edge that leaves it, or arrives there. It runs the other way in the
  // neighbour.
  const auto beyond = [&](Index corner, bool leaving) {
    const Index edge = leaving ? corner : previous(corner), other = surface.across[edge / 3][edge % 3];
    if (other == k_no_triangle) return k_no_corner;
    const Index from = vertex(edge), to = vertex(next(edge));
    for (Index at = 3 * other; at < 3 * other + 3; ++at)
      if (vertex(at) == to && vertex(next(at)) == from) return leaving ? next(at) : at;
    return k_no_corner;
  };
  const auto number = [&](Index corner) -> Index& { return surface.triangles[corner / 3][corner % 3]; };
  for (Index first = 0; first < 3 * triangles.size(); ++first) {
    if (number(first) != k_no_vertex) continue;
    const auto count = static_cast<Index>(surface.positions.size());
    surface.positions.push_back(mesh_->positions[vertex(first)]);
    number(first) = count;
    for (const bool leaving : {true, false})
      for (Index c = beyond(first, leaving); c != k_no_corner && number(c) == k_no_vertex; c = beyond(c, leaving))
        number(c) = count;
  }
  return surface;
}

}  // namespace papilla::param_detail
