// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "adjacency.hpp"
#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla::param_detail {

/// Label of a triangle without area until a neighbour gives it one.
inline constexpr std::uint8_t k_no_label = 6;

/// The label of each triangle, 2 * dominant axis + (1 when the normal looks along the negative axis), and the doubled
/// area as a weight; 0 for triangles that count as without area.
struct LabelledTriangles {
  std::vector<std::uint8_t> label;
  std::vector<float> doubled_area;
};

LabelledTriangles label_triangles(const TriangleMesh& mesh);

/// Whether triangle t may take `label`: |n·axis| >= cosine with the label's sign. Without area: yes.
bool accepts(const TriangleMesh& mesh, Index t, std::uint8_t label, double cosine);

/// Gives every triangle without area the label of a neighbour that has one, nearest first; 0 when there is none.
void fill_missing_labels(const Adjacency& across, LabelledTriangles& triangles);

/// One pass in index order. A triangle with at most one neighbour of its own label and two or more of another one joins
/// the other. Each move shortens the class borders counted in edges, so that repeated passes end.
/// @return how many labels changed.
std::size_t smooth_labels_once(const TriangleMesh& mesh, const Adjacency& across, double cosine,
                               LabelledTriangles& triangles);

/// Triangles that have a neighbour, but none of their own label.
std::size_t count_lone_triangles(const Adjacency& across, const LabelledTriangles& triangles);

}  // namespace papilla::param_detail
