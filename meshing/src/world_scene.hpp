// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/meshing/placed_mesh.hpp"
#include "triangle_bvh.hpp"

namespace papilla::detail {

/// Of the scene's diagonal: so far off its surface a ray starts.
inline constexpr double k_ray_start = 1e-5;

/// The triangles of a part where it stands.
class PlacedTriangles {
 public:
  PlacedTriangles() = default;
  explicit PlacedTriangles(const PlacedMesh& part) noexcept : part_(part) {}

  std::size_t size() const noexcept { return part_.mesh->triangles.size(); }
  Index vertices() const noexcept { return static_cast<Index>(part_.mesh->positions.size()); }
  std::span<const Triangle> triangles() const noexcept { return part_.mesh->triangles; }
  bool is_opaque() const noexcept { return part_.opaque; }

  /// Whether triangles run clockwise that ran counter-clockwise.
  bool is_mirrored() const noexcept {
    const auto& m = part_.world;
    return dot(Vec3{m[0], m[4], m[8]}, cross(Vec3{m[1], m[5], m[9]}, Vec3{m[2], m[6], m[10]})) < 0;
  }

  Vec3 position(Index vertex) const noexcept {
    const auto& m = part_.world;
    const Vec3& p = part_.mesh->positions[vertex];
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
  }
  Vec3 corner(std::size_t triangle, int k) const noexcept {
    return position(part_.mesh->triangles[triangle][static_cast<std::size_t>(k)]);
  }

 private:
  PlacedMesh part_;
};

/// The parts in the scene's space. Their meshes must outlive it.
struct WorldScene {
  std::vector<PlacedTriangles> parts;
  Bounds3 bounds;
};

/// @throws InvalidInput naming function and part when a mesh is missing or has a bad index or coordinate, or is not
///         finite where it stands.
WorldScene place(std::span<const PlacedMesh> parts, const std::string& function);

/// What hides in a scene.
struct Occluders {
  std::shared_ptr<const TriangleBvh> bvh;
  double diagonal_mm;  ///< Of the scene.
  double start_mm;     ///< k_ray_start of it.
};

/// @throws InvalidInput as place().
Occluders occluders(std::span<const PlacedMesh> parts, const std::string& function);

}  // namespace papilla::detail
