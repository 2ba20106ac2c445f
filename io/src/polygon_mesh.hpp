// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Makes a triangle mesh of a file's vertices, which carry all attributes, and polygons of vertex numbers, as PLY and
/// OFF have them. Polygons may bring texture coordinates of their own per corner and a colour, which go before
/// the vertices'.
class PolygonMesh {
 public:
  Values<Vec3> positions;
  Values<Vec3> normals;  ///< As many as positions, or none; so are uv, cad_uv and colours.
  Values<Vec2> uv, cad_uv;
  Values<Color> colors;

  struct Polygon {
    std::span<const Index> corners;
    std::span<const Vec2> uv;  ///< As many as corners, or none.
    std::optional<Color> color;
    std::uint32_t material = 0;
    std::span<const Vec2> cad_uv = {};  ///< As many as corners, or none.
  };

  /// Cuts a polygon into triangles. One of fewer than three corners is only counted.
  /// @pre corners below positions.size(), attribute lists complete.
  /// @throws InvalidInput as triangulate_polygon().
  void add(const Polygon& polygon);

  std::size_t short_polygons() const noexcept { return short_polygons_; }

  /// The mesh, with the attributes that vertices or polygons have; unused vertices are kept.
  TriangleMesh finish();

 private:
  /// Values that polygons bring per corner; the indices may end early.
  struct PolygonUv {
    std::vector<Vec2> values;
    std::vector<Triangle> indices;

    void add_triangle(std::size_t triangle, const std::array<std::size_t, 3>& corners, Index first);
  };

  /// Where the values of a polygon begin.
  struct First {
    Index uv, cad_uv, color;
  };

  void add_triangle(const Polygon& polygon, std::array<std::size_t, 3> corners, const First& first);

  TriangleMesh mesh_;
  PolygonUv polygon_uv_, polygon_cad_uv_;
  std::vector<Color> polygon_colors_;
  std::vector<Triangle> color_indices_;  ///< Into the list above; may end early.
  std::vector<Vec3> points_;
  std::size_t short_polygons_ = 0;
};

}  // namespace papilla
