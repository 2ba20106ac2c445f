// SPDX-License-Identifier: MIT
#include "world_scene.hpp"

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"

namespace papilla::detail {
namespace {

/// The triangles of the opaque parts as one list.
TriangleMesh opaque_triangles(const WorldScene& scene) {
  TriangleMesh opaque;
  for (const PlacedTriangles& part : scene.parts) {
    if (!part.is_opaque()) continue;
    for (const Triangle& t : part.triangles()) {
      const auto next = static_cast<Index>(opaque.positions.size());
      for (const Index v : t) opaque.positions.push_back(part.position(v));
      opaque.triangles.push_back({next, next + 1, next + 2});
    }
  }
  return opaque;
}

}  // namespace

WorldScene place(std::span<const PlacedMesh> parts, const std::string& function) {
  WorldScene scene;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = function + ": parts[" + std::to_string(i) + "]";
    if (parts[i].mesh == nullptr) throw InvalidInput(name + " has no mesh");
    Bounds3 own;
    check_distance_input(*parts[i].mesh, name + ".mesh", own);
    scene.parts.emplace_back(parts[i]);
    for (const Triangle& t : scene.parts.back().triangles())
      for (const Index v : t) {
        const Vec3 p = scene.parts.back().position(v);
        if (!is_distance_position(p))
          throw InvalidInput(name + ", placed.positions[" + std::to_string(v) + "]: " + k_no_distance_position);
        scene.bounds.add(p);
      }
  }
  return scene;
}

Occluders occluders(std::span<const PlacedMesh> parts, const std::string& function) {
  const WorldScene scene = place(parts, function);
  const TriangleMesh opaque = opaque_triangles(scene);
  const double diagonal = scene.bounds.diagonal();
  return {std::make_shared<TriangleBvh>(opaque.positions, opaque.triangles), diagonal, k_ray_start * diagonal};
}

}  // namespace papilla::detail
