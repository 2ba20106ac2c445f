// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adjacency.hpp"
#include "papilla/param/bounded_seams.hpp"
#include "rest_shape.hpp"

namespace papilla::param_detail {

/// A mesh by its half-edges 3 t + k, with what seams cost on it.
struct SeamMesh {
  /// @param costs per half-edge. @throws InvalidInput when they are not as many as half-edges.
  SeamMesh(const TriangleMesh& of, std::span<const double> costs);

  Index from(Index h) const { return mesh.triangles[h / 3][h % 3]; }
  Index to(Index h) const { return mesh.triangles[h / 3][(h % 3 + 1) % 3]; }
  double length(Index h) const { return norm(mesh.positions[to(h)] - mesh.positions[from(h)]); }

  const TriangleMesh& mesh;
  std::span<const double> cost;
  std::vector<Index> opposite;  ///< k_no_triangle at borders.
  std::vector<RestShape> rest;
  std::vector<char> on_border;  ///< Per vertex.
  double area = 0;
};

/// Charts and their map, measured.
struct SeamState {
  ChartedMap charted;
  std::vector<std::uint8_t> seam;     ///< Per half-edge, the same on both sides; 1 at borders.
  std::vector<double> excess;         ///< Per triangle: A (e - 4).
  double distortion = 0, energy = 0;  ///< Of the bound; Σ excess.
  double seam_mm = 0, cost_mm = 0;
  std::vector<std::uint8_t> without_map;  ///< Per triangle: its chart has none by the method; empty: none is known of.
  bool valid = false;                     ///< Every chart has a map by the method.

  Vec2 uv(Index h) const { return charted.flattening.uv.values[value(h)]; }
  Vec2 uv_at_end(Index h) const { return charted.flattening.uv.values[value_at_end(h)]; }
  /// The number of the uv at the start of a half-edge.
  Index value(Index h) const { return charted.flattening.uv.indices[h / 3][h % 3]; }
  Index value_at_end(Index h) const { return charted.flattening.uv.indices[h / 3][(h % 3 + 1) % 3]; }
  std::uint32_t chart(Index h) const { return charted.flattening.charts.of_triangle[h / 3]; }
};

SeamState measured(const SeamMesh& mesh, ChartedMap charted, const DistortionBound& bound);

/// What the energy rose by from one state to another around each place, a set of half-edges of seam: every triangle
/// counts for the place that is fewest triangles away.
std::vector<double> raised_around(const SeamMesh& mesh, const SeamState& before, const SeamState& after,
                                  const std::vector<std::vector<Index>>& places);

/// The charts that seams leave.
ChartSet charts_between(const SeamMesh& mesh, const std::vector<std::uint8_t>& seam);

}  // namespace papilla::param_detail
