// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

inline constexpr Index k_none = 0xffffffffu;

/// The corner after and before corner k.
constexpr std::size_t next_corner(std::size_t k) noexcept { return k == 2 ? 0 : k + 1; }
constexpr std::size_t previous_corner(std::size_t k) noexcept { return k == 0 ? 2 : k - 1; }

template <class Mesh, class Visit>
void for_each_corner_attribute(Mesh& mesh, const Visit& visit) {
  visit(mesh.normals);
  visit(mesh.uv);
  visit(mesh.uv1);
  visit(mesh.cad_uv);
  visit(mesh.colors);
}

template <class Mesh, class Visit>
void for_each_label(Mesh& mesh, const Visit& visit) {
  visit(mesh.material);
  visit(mesh.face);
}

/// True when two corners of the triangle are the same vertex.
constexpr bool repeats_corner(const Triangle& t) noexcept { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// Keeps the triangles whose flag is set, with everything they carry, in their order.
void keep_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& keep);

/// Drops triangles that repeat a corner; returns how many.
std::size_t drop_repeated_corners(TriangleMesh& mesh);

/// Drops positions and attribute values that no triangle names; the order of the rest stays.
void drop_unused(TriangleMesh& mesh);

/// Reverses the triangles whose flag is set: corners 1 and 2 swapped, normals negated.
void reverse_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& reverse);

/// Splits the edge from corner k of a triangle to the next one at `vertex`, which lies at fraction s of it.
/// The triangle keeps the first half, the returned new one (at the end) takes the second; attributes are interpolated.
Index split_triangle(TriangleMesh& mesh, Index triangle, std::size_t k, Index vertex, double s);

/// Twice the area vector of a triangle.
inline Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) noexcept { return cross(b - a, c - a); }

}  // namespace papilla::detail
