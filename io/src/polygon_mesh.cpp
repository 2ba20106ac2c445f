// SPDX-License-Identifier: MIT
#include "polygon_mesh.hpp"

#include <array>
#include <span>
#include <utility>

#include "polygon_triangulation.hpp"

namespace papilla {
namespace {

constexpr Triangle k_no_values = {k_no_value, k_no_value, k_no_value};

/// Triangles that have no value of their own take their vertices'.
template <class T>
CornerAttribute<T> merged(Values<T> of_vertices, const std::vector<T>& of_polygons, std::span<const Triangle> own,
                          std::span<const Triangle> triangles) {
  CornerAttribute<T> attribute;
  if (of_vertices.empty() && of_polygons.empty()) return attribute;
  const auto offset = static_cast<Index>(of_vertices.size());
  attribute.indices.assign(triangles.begin(), triangles.end());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle values = t < own.size() ? own[t] : k_no_values;
    if (values != k_no_values)
      attribute.indices[t] = {values[0] + offset, values[1] + offset, values[2] + offset};
    else if (of_vertices.empty())
      attribute.indices[t] = k_no_values;
  }
  attribute.values = std::move(of_vertices);
  attribute.values.insert(attribute.values.end(), of_polygons.begin(), of_polygons.end());
  return attribute;
}

}  // namespace

void PolygonMesh::add(const Polygon& polygon) {
  if (polygon.corners.size() < 3) {
    ++short_polygons_;
    return;
  }
  First first{static_cast<Index>(polygon_uv_.values.size()), static_cast<Index>(polygon_cad_uv_.values.size()),
              k_no_value};
  polygon_uv_.values.insert(polygon_uv_.values.end(), polygon.uv.begin(), polygon.uv.end());
  polygon_cad_uv_.values.insert(polygon_cad_uv_.values.end(), polygon.cad_uv.begin(), polygon.cad_uv.end());
  if (polygon.color) {
    if (polygon_colors_.empty() || !(polygon_colors_.back() == *polygon.color))
      polygon_colors_.push_back(*polygon.color);
    first.color = static_cast<Index>(polygon_colors_.size() - 1);
  }
  if (polygon.corners.size() == 3) return add_triangle(polygon, {0, 1, 2}, first);
  points_.clear();
  for (const Index corner : polygon.corners) points_.push_back(positions[corner]);
  for (const auto& triangle : triangulate_polygon(points_)) add_triangle(polygon, triangle, first);
}

void PolygonMesh::PolygonUv::add_triangle(std::size_t triangle, const std::array<std::size_t, 3>& corners,
                                          Index first) {
  indices.resize(triangle, k_no_values);
  indices.push_back({first + static_cast<Index>(corners[0]), first + static_cast<Index>(corners[1]),
                     first + static_cast<Index>(corners[2])});
}

void PolygonMesh::add_triangle(const Polygon& polygon, std::array<std::size_t, 3> corners, const First& first) {
  const std::size_t before = mesh_.triangles.size();
  mesh_.triangles.push_back({polygon.corners[corners[0]], polygon.corners[corners[1]], polygon.corners[corners[2]]});
  if (!polygon.uv.empty()) polygon_uv_.add_triangle(before, corners, first.uv);
  if (!polygon.cad_uv.empty()) polygon_cad_uv_.add_triangle(before, corners, first.cad_uv);
  if (first.color != k_no_value) {
    color_indices_.resize(before, k_no_values);
    color_indices_.push_back({first.color, first.color, first.color});
  }
  if (polygon.material != 0) {
    mesh_.material.resize(before, 0);
    mesh_.material.push_back(polygon.material);
  }
}

TriangleMesh PolygonMesh::finish() {
  mesh_.positions = std::move(positions);
  if (!normals.empty()) mesh_.normals = {std::move(normals), mesh_.triangles};
  mesh_.uv = merged(std::move(uv), polygon_uv_.values, polygon_uv_.indices, mesh_.triangles);
  mesh_.cad_uv = merged(std::move(cad_uv), polygon_cad_uv_.values, polygon_cad_uv_.indices, mesh_.triangles);
  mesh_.colors = merged(std::move(colors), polygon_colors_, color_indices_, mesh_.triangles);
  if (!mesh_.material.empty()) mesh_.material.resize(mesh_.triangles.size(), 0);
  return std::move(mesh_);
}

}  // namespace papilla
