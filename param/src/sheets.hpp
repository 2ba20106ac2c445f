// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "adjacency.hpp"
#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/grain_frame.hpp"
#include "triplanar_labels.hpp"

namespace papilla::param_detail {

/// Connected pieces of equal label: the piece of each triangle, numbered by their first triangle.
struct Sheets {
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 0;
};

Sheets connect_sheets(const Adjacency& across, const std::vector<std::uint8_t>& label);

/// Gives sheets below `small_piece` of the area of a neighbouring sheet that neighbour's label (the neighbour with the
/// longest common border first), when every triangle of the sheet lies within `cosine` of its axis.
/// @return how many sheets were given away; `label` changes, the sheets do not.
std::size_t absorb_small_sheets(const TriangleMesh& mesh, const Adjacency& across, const Sheets& sheets,
                                const TriplanarOptions& options, LabelledTriangles& triangles);

/// Splits every sheet that overlaps itself in projection; new sheets get the numbers from `count` on.
/// @return how many sheets were split.
std::uint32_t split_folded_sheets(const TriangleMesh& mesh, const Adjacency& across,
                                  const std::vector<std::uint8_t>& label, UpAxis up, Sheets& sheets);

/// Sheets of one triangle join a neighbouring sheet, or take a neighbouring triangle from a larger one, as far as
/// `cosine` and the projection allow. Numbers stay; sheets may become empty.
void join_lone_triangles(const TriangleMesh& mesh, const Adjacency& across, double cosine, UpAxis up,
                         LabelledTriangles& triangles, Sheets& sheets);

/// Renumbers the sheets by their first triangle, without gaps.
void renumber(Sheets& sheets);

inline double coordinate(const Vec3& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

inline Vec2 project(const Vec3& p, const ProjectionAxes& axes) {
  return {axes.u_sign * coordinate(p, axes.u_axis), axes.v_sign * coordinate(p, axes.v_axis)};
}

}  // namespace papilla::param_detail
