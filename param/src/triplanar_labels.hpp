// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "adjacency.hpp"
#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla::detail {

/// Label of a triangle without area until a neighbour gives it one.
inline constexpr std::uint8_t k_no_label = 6;

/// Normals with the length of the doubled area, one array per component, and the label of each triangle:
/// 2 * dominant axis + (1 when the normal looks along the negative axis).
struct LabelledTriangles {
  std::vector<double> normal[3];
  std::vector<double> doubled_area;
  std::vector<std::uint8_t> label;

  /// Whether triangle t may take `wanted`: |n·axis| >= cosine with the label's sign. Without area: yes.
  bool accepts(Index t, std::uint8_t wanted, double cosine) const {
    const double along = normal[wanted >> 1][t];
    return (wanted & 1 ? -along : along) >= cosine * doubled_area[t];
  }
};

LabelledTriangles label_triangles(const TriangleMesh& mesh);

/// Gives every triangle without area the label of a neighbour that has one, nearest first; 0 when there is none.
void fill_missing_labels(const Adjacency& across, LabelledTriangles& triangles);

/// One pass in index order. A triangle with at most one neighbour of its own label and two or more of another one joins the other.
/// Each move shortens the class borders counted in edges, so that repeated passes end.
/// @return how many labels changed.
std::size_t smooth_labels_once(const Adjacency& across, double cosine, LabelledTriangles& triangles);

/// Triangles that have a neighbour, but none of their own label.
std::size_t count_lone_triangles(const Adjacency& across, const LabelledTriangles& triangles);

}  // namespace papilla::detail
