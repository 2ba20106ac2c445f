// SPDX-License-Identifier: MIT
#include "papilla/meshing/chart_cuts.hpp"

#include <algorithm>
#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/chart_topology.hpp"
#include "papilla/meshing/submesh.hpp"
#include "piece_cuts.hpp"
#include "seam_set.hpp"
#include "segmentation_steps.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Edges bent by this angle hide a seam as well as sharper ones, as in SegmentationOptions.
constexpr double k_feature_angle_deg = 45;

}  // namespace

ChartSet open_charts(const TriangleMesh& mesh, const ChartSet& charts, bool disks) {
  check_charts(mesh, charts, "open_charts");
  const SegmentedMesh surface(mesh);
  const SeamWeights weights(surface, triangle_openness(surface), k_feature_angle_deg);
  std::vector<std::uint8_t> seam = seams_of(surface, charts.of_triangle, charts.cuts);
  PieceCutter cutter(surface, seam);
  for (auto& triangles : triangles_of_charts(charts_between(surface, seam)))
    open_patch(surface, weights, disks, std::move(triangles), cutter, seam);
  return charts_between(surface, seam);
}

ChartSet open_closed_charts(const TriangleMesh& mesh, const ChartSet& charts) {
  const std::vector<ChartTopology> topologies = chart_topologies(mesh, charts);
  const auto is_open = [](const ChartTopology& t) { return !t.closed() && t.genus() == 0; };
  if (std::all_of(topologies.begin(), topologies.end(), is_open)) return charts;
  const SegmentedMesh surface(mesh);
  const SeamWeights weights(surface, triangle_openness(surface), k_feature_angle_deg);
  std::vector<std::uint8_t> seam = seams_of(surface, charts.of_triangle, charts.cuts);
  PieceCutter cutter(surface, seam);
  for (auto& triangles : triangles_of_charts(charts_between(surface, seam)))
    if (!is_open(topologies[charts.of_triangle[triangles.front()]]))
      open_patch(surface, weights, true, std::move(triangles), cutter, seam);
  return charts_between(surface, seam);
}

struct ChartHalver::Surface {
  explicit Surface(const TriangleMesh& m)
      : mesh(m), surface(m), weights(surface, triangle_openness(surface), k_feature_angle_deg) {}

  const TriangleMesh& mesh;
  SegmentedMesh surface;
  SeamWeights weights;
};

ChartHalver::ChartHalver(const TriangleMesh& mesh) {
  check_mesh(mesh, "ChartHalver");
  surface_ = std::make_unique<Surface>(mesh);
}

ChartHalver::~ChartHalver() = default;

ChartSet ChartHalver::halve(const ChartSet& charts, std::span<const std::uint32_t> numbers) const {
  const auto& [mesh, surface, weights] = *surface_;
  check_charts(mesh, charts, "ChartHalver");
  std::vector<std::uint8_t> seam = seams_of(surface, charts.of_triangle, charts.cuts);
  PieceCutter cutter(surface, seam);
  const auto triangles = triangles_of_charts(charts);
  for (const std::uint32_t c : numbers) {
    if (c >= charts.count)
      throw InvalidInput("ChartHalver: chart " + std::to_string(c) + " of " + std::to_string(charts.count));
    if (triangles[c].size() < 2) continue;
    const Piece piece = cutter.cut(triangles[c]);
    for (const Index h : cut_in_halves(piece, weights)) {
      const Index global = piece.halfedge_of(h);
      seam[global] = seam[surface.opposite[global]] = 1;
    }
  }
  return charts_between(surface, seam);
}

}  // namespace papilla
