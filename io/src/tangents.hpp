// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// +1 or −1: whether u to the right, v up and the normal make a right-handed system on the triangle.
float tangent_handedness(const std::array<Vec2, 3>& uv);

/// glTF tangents (x, y, z, handedness) per vertex: the direction in which u grows, averaged over the vertex's triangles
/// weighted with their angle there, as MikkTSpace does, and made perpendicular to the normal. Vertices whose uv give no
/// direction get any perpendicular one.
/// @param uv  with v up; every vertex's triangles must agree in tangent_handedness().
std::vector<std::array<float, 4>> vertex_tangents(std::span<const Vec3> positions, std::span<const Vec3> normals,
                                                  std::span<const Vec2> uv, std::span<const Triangle> triangles);

}  // namespace papilla
