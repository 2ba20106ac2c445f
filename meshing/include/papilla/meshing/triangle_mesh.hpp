// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "papilla/core/values.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {

using Index = std::uint32_t;
using Triangle = std::array<Index, 3>;

/// Stands in CornerAttribute::indices for "this triangle has no value".
inline constexpr Index k_no_value = 0xffffffffu;

/// A value per triangle corner, stored once and indexed, so that it may jump over a seam
/// while the positions stay welded. Either empty, or `indices` has one entry per triangle.
template <class T>
struct CornerAttribute {
  Values<T> values;
  Values<Triangle> indices;
  bool empty() const noexcept { return indices.empty(); }
  bool has_value(std::size_t triangle) const noexcept { return !empty() && indices[triangle][0] != k_no_value; }
};

struct Color {
  float r = 1, g = 1, b = 1, a = 1;  ///< Linear, in [0, 1].
  friend bool operator==(const Color&, const Color&) = default;
};

/// A triangle soup or surface in millimetres, counter-clockwise seen from outside.
/// Readers promise finite positions and indices in range; nothing else: neither welded
/// nor manifold nor oriented. Every stage states what it adds.
struct TriangleMesh {
  Values<Vec3> positions;
  Values<Triangle> triangles;

  CornerAttribute<Vec3> normals;
  CornerAttribute<Vec2> uv;      ///< Texture channel 0; the unit is the owner's (charts: mm, files: texture repeats).
  CornerAttribute<Vec2> uv1;     ///< Texture channel 1, the non-overlapping atlas.
  CornerAttribute<Vec2> cad_uv;  ///< The CAD surface's own parameters.
  CornerAttribute<Color> colors;

  Values<std::uint32_t> material;  ///< Per triangle: slot in the owner's material list; empty: all 0.
  Values<std::uint32_t> face;      ///< Per triangle: number of the CAD face or file group; empty: none.

  Vec3 corner(std::size_t triangle, int k) const { return positions[triangles[triangle][static_cast<std::size_t>(k)]]; }
};

}  // namespace papilla
