// SPDX-License-Identifier: MIT
#include "chart_pieces.hpp"

#include <algorithm>

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
  // The corner where the edge that leaves a corner begins in the triangle beyond, at its other end.
  std::vector<Index> twin(3 * triangles.size());
  for_chunks(triangles.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& own = mesh_->triangles[triangles[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        twin[3 * i + k] = k_no_corner;
        const Index other = (*across_)[3 * std::size_t{triangles[i]} + k];
        if (other == k_no_triangle || charts_->of_triangle[other] != chart) continue;
        surface.across[i][k] = local_[other];
        const Triangle& theirs = mesh_->triangles[other];
        for (Index at = 0; at < 3; ++at)
          if (theirs[at] == own[(k + 1) % 3] && theirs[(at + 1) % 3] == own[k]) {
            twin[3 * i + k] = 3 * local_[other] + at;
            break;
          }
      }
    }
  });
  // The corner at the same vertex beyond the edge that leaves it, or arrives there.
  const auto beyond = [&](Index corner, bool leaving) {
    const Index other = twin[leaving ? corner : previous(corner)];
    return leaving && other != k_no_corner ? next(other) : other;
  };
  const auto number = [&](Index corner) -> Index& { return surface.triangles[corner / 3][corner % 3]; };
  const auto border = static_cast<std::size_t>(std::count(twin.begin(), twin.end(), k_no_corner));
  surface.positions.reserve((triangles.size() + border) / 2 + 1);  // Euler's formula: what a disk has.
  for (Index first = 0; first < 3 * triangles.size(); ++first) {
    if (number(first) != k_no_vertex) continue;
    const auto count = static_cast<Index>(surface.positions.size());
    surface.positions.push_back(mesh_->positions[mesh_->triangles[triangles[first / 3]][first % 3]]);
    number(first) = count;
    for (const bool leaving : {true, false})
      for (Index c = beyond(first, leaving); c != k_no_corner && number(c) == k_no_vertex; c = beyond(c, leaving))
        number(c) = count;
  }
  return surface;
}

}  // namespace papilla::param_detail
