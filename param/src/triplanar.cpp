// SPDX-License-Identifier: MIT
#include "papilla/param/triplanar.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "adjacency.hpp"
#include "chart_pieces.hpp"
#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "sheets.hpp"
#include "tile_phase.hpp"
#include "triplanar_labels.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_triplanar";

/// Absorbing a piece can make another one small; a few rounds settle real parts.
constexpr int k_absorption_rounds = 4;

void check_options(const TriplanarOptions& o) {
  const auto require = [](bool good, const std::string& what) {
    if (!good) throw InvalidInput(std::string(k_function) + ": " + what);
  };
  require(o.smoothing_cosine >= 0.05 && o.smoothing_cosine <= 0.5774,
          "smoothing_cosine is " + std::to_string(o.smoothing_cosine) + ", expected 0.05 to 0.577");
  require(o.absorption_cosine >= 0.05 && o.absorption_cosine <= o.smoothing_cosine,
          "absorption_cosine is " + std::to_string(o.absorption_cosine) + ", expected 0.05 to smoothing_cosine");
  require(o.small_piece >= 0 && o.small_piece <= 1,
          "small_piece is " + std::to_string(o.small_piece) + ", expected 0 to 1");
  require(o.smoothing_rounds >= 0, "smoothing_rounds is negative");
  require(std::isfinite(o.tile_mm.x) && std::isfinite(o.tile_mm.y) && o.tile_mm.x >= 0 && o.tile_mm.y >= 0,
          "tile_mm is negative or not finite");
}

void smooth(const TriangleMesh& mesh, const Adjacency& across, const TriplanarOptions& options, const Stopwatch& clock,
            LabelledTriangles& triangles, Flattening& result) {
  const auto sample = [&] {
    result.trace.push_back({clock.seconds(), static_cast<double>(count_lone_triangles(across, triangles))});
  };
  sample();
  result.stop = StopReason::iteration_limit;
  for (int round = 0; round < options.smoothing_rounds; ++round) {
    const std::size_t changed = smooth_labels_once(mesh, across, options.smoothing_cosine, triangles);
    if (changed == 0) {
      result.stop = StopReason::converged;
      break;
    }
    sample();
  }
}

Sheets make_sheets(const TriangleMesh& mesh, const Adjacency& across, const TriplanarOptions& options,
                   LabelledTriangles& triangles, std::uint32_t& folded) {
  Sheets sheets = connect_sheets(across, triangles.label);
  for (int round = 0; round < k_absorption_rounds; ++round) {
    if (absorb_small_sheets(mesh, across, sheets, options, triangles) == 0) break;
    sheets = connect_sheets(across, triangles.label);
  }
  folded = split_folded_sheets(mesh, across, triangles.label, options.up, sheets);
  join_lone_triangles(mesh, across, options.absorption_cosine, options.up, triangles, sheets);
  renumber(sheets);
  return sheets;
}

/// One uv value per vertex and chart, in the order of charts.
CornerAttribute<Vec2> project_corners(const TriangleMesh& mesh, const Sheets& sheets,
                                      const std::vector<std::uint8_t>& label, UpAxis up) {
  CornerAttribute<Vec2> uv;
  uv.indices = mesh.triangles;  // of vertices; those of values take their places
  uv.values.reserve(mesh.positions.size() + mesh.positions.size() / 8);
  const TrianglesOfCharts members = sort_by_chart(sheets.of_triangle, sheets.count);
  std::vector<Index> values_then(mesh.positions.size());  // after the vertex got its last value; 0: it has none
  for (std::uint32_t s = 0; s < sheets.count; ++s) {
    const auto own = members.of(s);
    const std::uint8_t l = label[own.front()];
    const ProjectionAxes axes = projection_axes(l >> 1, l & 1, up);
    const auto values_before = static_cast<Index>(uv.values.size());
    for (const Index t : own)
      for (Index& corner : uv.indices[t]) {
        const Index v = corner;
        if (values_then[v] <= values_before) {
          uv.values.push_back(project(mesh.positions[v], axes));
          values_then[v] = static_cast<Index>(uv.values.size());
        }
        corner = values_then[v] - 1;
      }
  }
  return uv;
}

BorderJump measure_jump(const TriangleMesh& mesh, const Adjacency& across, const Flattening& flattening, Vec2 tile) {
  BorderJump jump;
  for (std::size_t h = 0; h < across.size(); ++h) {
    const std::size_t t = h / 3, k = h % 3;
    const Index other = across[h];
    if (other == k_no_triangle || other < t) continue;
    if (flattening.charts.of_triangle[t] == flattening.charts.of_triangle[other]) continue;
    const SeamEdge edge = seam_edge(mesh, flattening.uv, t, k, other);
    for (const Vec2 difference : {edge.here[0] - edge.there[0], edge.here[1] - edge.there[1]}) {
      const double size = norm(wrap_to_tile(difference, tile));
      jump.mean_mm += 0.5 * edge.length_mm * size;
      jump.rms_mm += 0.5 * edge.length_mm * size * size;
      jump.max_mm = std::max(jump.max_mm, size);
    }
    jump.seam_mm += edge.length_mm;
  }
  if (jump.seam_mm > 0) {
    jump.mean_mm /= jump.seam_mm;
    jump.rms_mm = std::sqrt(jump.rms_mm / jump.seam_mm);
  }
  return jump;
}

}  // namespace

TriplanarResult flatten_triplanar(const TriangleMesh& mesh, const TriplanarOptions& options) {
  check_options(options);
  check_mesh(mesh, k_function);
  const Stopwatch total;
  TriplanarResult result;
  Flattening& flattening = result.flattening;

  LabelledTriangles triangles = label_triangles(mesh);
  result.seconds.project = total.seconds();
  const Adjacency across = connect_triangles(mesh);
  result.seconds.connect = total.seconds() - result.seconds.project;
  fill_missing_labels(across, triangles);
  smooth(mesh, across, options, total, triangles, flattening);
  result.seconds.smooth = total.seconds() - result.seconds.connect - result.seconds.project;

  Stopwatch clock;
  Sheets sheets = make_sheets(mesh, across, options, triangles, result.folded_sheets);
  result.seconds.sheets = clock.seconds();

  clock = Stopwatch();
  flattening.uv = project_corners(mesh, sheets, triangles.label, options.up);
  result.seconds.project += clock.seconds();

  flattening.charts.of_triangle = std::move(sheets.of_triangle);
  flattening.charts.count = sheets.count;
  result.border_jump = measure_jump(mesh, across, flattening, options.tile_mm);
  flattening.charts.seam_length_mm = result.border_jump.seam_mm;
  result.label = std::move(triangles.label);
  result.seconds.total = total.seconds();
  return result;
}

}  // namespace papilla
