// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "check_mesh.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/meshing/placed_mesh.hpp"
#include "triangle_bvh.hpp"

namespace papilla::detail {

/// Of the scene's diagonal: so far off its surface a ray starts.
inline constexpr double k_ray_start = 1e-5;

/// The parts' triangles in the scene's space, one part after the other.
struct WorldScene {
  std::vector<TriangleMesh> parts;
  Bounds3 bounds;
};

/// @throws InvalidInput naming function and part when a mesh is missing or has a bad index or coordinate, or is not
///         finite where it stands.
WorldScene place(std::span<const PlacedMesh> parts, const std::string& function);

/// The triangles of the parts that are opaque as one list.
/// @param first  becomes a number a part: where its triangles begin, or k_no_value when it is not opaque.
TriangleMesh opaque_triangles(const WorldScene& scene, std::span<const PlacedMesh> parts, std::vector<Index>& first);

/// What hides in a scene.
struct Occluders {
  std::shared_ptr<const TriangleBvh> bvh;
  double diagonal_mm;  ///< Of the scene.
  double start_mm;     ///< k_ray_start of it.
};

/// @throws InvalidInput as place().
Occluders occluders(std::span<const PlacedMesh> parts, const std::string& function);

}  // namespace papilla::detail
