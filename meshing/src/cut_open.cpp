// SPDX-License-Identifier: MIT
#include "papilla/meshing/cut_open.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"

namespace papilla {

using namespace detail;

CutOpener::CutOpener(const TriangleMesh& mesh) : mesh_(mesh) {
  check_mesh(mesh, "cut_open");
  const EdgeTable edges(mesh.triangles, mesh.positions.size());
  opposite_ = opposite_halfedges(mesh.triangles, edges);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    if (h.size() > 2) crowded_.emplace_back(h.begin(), h.end());
  }
}

/// The opposite half-edges within each chart.
std::vector<Index> CutOpener::opposite_within(const ChartSet& charts) const {
  std::vector<Index> opposite(opposite_.size());
  const auto chart_of = [&](Index h) { return charts.of_triangle[triangle_of(h)]; };
  for (Index h = 0; h < opposite.size(); ++h) {
    const Index other = opposite_[h];
    opposite[h] = other != k_none && chart_of(h) == chart_of(other) ? other : k_none;
  }
  for (const std::vector<Index>& edge : crowded_)
    link_within_labels(mesh_.triangles, edge, charts.of_triangle, opposite);
  return opposite;
}

/// The same with the cuts open.
std::vector<Index> CutOpener::opposite_where_closed(const ChartSet& charts, const char* function) const {
  std::vector<Index> opposite = opposite_within(charts);
  open_cuts(charts.cuts, opposite, function);
  return opposite;
}

double CutOpener::length_of_seams(const std::vector<Index>& closed) const {
  double length = 0;
  for (Index h = 0; h < opposite_.size(); ++h) {
    const Index other = opposite_[h];
    if (other == k_none || other < h || closed[h] != k_none) continue;
    length += norm(mesh_.positions[to_vertex(mesh_.triangles, h)] - mesh_.positions[from_vertex(mesh_.triangles, h)]);
  }
  return length;
}

TriangleMesh CutOpener::open(const ChartSet& charts) const {
  check_chart_numbers(mesh_, charts, "cut_open");
  TriangleMesh mesh = mesh_;
  if (charts.cuts.empty()) return mesh;
  const std::vector<Index> closed = opposite_where_closed(charts, "cut_open");
  std::vector<std::uint8_t> divided(mesh.positions.size(), 0);
  for (const Index h : charts.cuts) divided[from_vertex(mesh.triangles, h)] = divided[to_vertex(mesh.triangles, h)] = 1;
  UnionFind fans(closed.size());
  for (Index h = 0; h < closed.size(); ++h) {
    if (closed[h] == k_none) continue;
    if (divided[from_vertex(mesh.triangles, h)]) fans.unite(h, next_halfedge(closed[h]));
  }
  // The first fan of a chart at a vertex keeps its number; so do all fans of charts that no cut divides there.
  std::vector<Index> copy(closed.size(), k_none);
  std::unordered_map<Index, std::vector<std::uint32_t>> charts_at;
  for (Index c = 0; c < copy.size(); ++c) {
    const Index v = from_vertex(mesh_.triangles, c);
    if (!divided[v]) continue;
    const Index fan = fans.find(c);
    if (fan == c) {
      const std::uint32_t chart = charts.of_triangle[triangle_of(c)];
      auto& here = charts_at[v];
      if (std::find(here.begin(), here.end(), chart) == here.end()) {
        here.push_back(chart);
      } else {
        copy[c] = static_cast<Index>(mesh.positions.size());
        mesh.positions.push_back(mesh.positions[v]);
      }
    }
    if (copy[fan] != k_none) mesh.triangles[triangle_of(c)][corner_of(c)] = copy[fan];
  }
  return mesh;
}

double CutOpener::seam_length(const ChartSet& charts) const {
  check_chart_numbers(mesh_, charts, "seam_length");
  return length_of_seams(opposite_where_closed(charts, "seam_length"));
}

void CutOpener::keep_cuts(std::span<const Index> halfedges, ChartSet& charts) const {
  check_chart_numbers(mesh_, charts, "keep_cuts");
  std::vector<Index> closed = opposite_within(charts);
  charts.cuts.clear();
  for (const Index h : halfedges) {
    if (h >= closed.size())
      throw InvalidInput("keep_cuts: half-edge " + std::to_string(h) + " of " + std::to_string(closed.size()));
    if (closed[h] != k_none) charts.cuts.push_back(h);
  }
  open_cuts(charts.cuts, closed, "keep_cuts");
  charts.seam_length_mm = length_of_seams(closed);
}

TriangleMesh cut_open(const TriangleMesh& mesh, const ChartSet& charts) {
  if (charts.cuts.empty()) return check_charts(mesh, charts, "cut_open"), mesh;
  return CutOpener(mesh).open(charts);
}

double seam_length(const TriangleMesh& mesh, const ChartSet& charts) { return CutOpener(mesh).seam_length(charts); }

}  // namespace papilla
