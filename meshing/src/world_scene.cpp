// SPDX-License-Identifier: MIT
#include "world_scene.hpp"

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla::detail {
namespace {

Vec3 transformed(const std::array<double, 16>& m, const Vec3& p) noexcept {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
          m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

}  // namespace

WorldScene place(std::span<const PlacedMesh> parts, const std::string& function) {
  WorldScene scene;
  scene.parts.resize(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = function + ": parts[" + std::to_string(i) + "]";
    if (parts[i].mesh == nullptr) throw InvalidInput(name + " has no mesh");
    Bounds3 own;
    check_distance_input(*parts[i].mesh, name + ".mesh", own);
    TriangleMesh& world = scene.parts[i];
    world.triangles = parts[i].mesh->triangles;
    for (const Vec3& p : parts[i].mesh->positions) world.positions.push_back(transformed(parts[i].world, p));
    check_distance_input(world, name + ", placed", scene.bounds);
  }
  return scene;
}

TriangleMesh opaque_triangles(const WorldScene& scene, std::span<const PlacedMesh> parts, std::vector<Index>& first) {
  TriangleMesh opaque;
  first.assign(parts.size(), k_no_value);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].opaque) continue;
    first[i] = static_cast<Index>(opaque.triangles.size());
    const auto offset = static_cast<Index>(opaque.positions.size());
    opaque.positions.insert(opaque.positions.end(), scene.parts[i].positions.begin(), scene.parts[i].positions.end());
    for (const Triangle& t : scene.parts[i].triangles)
      opaque.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return opaque;
}

Occluders occluders(std::span<const PlacedMesh> parts, const std::string& function) {
  const WorldScene scene = place(parts, function);
  std::vector<Index> first;
  const TriangleMesh opaque = opaque_triangles(scene, parts, first);
  const double diagonal = scene.bounds.diagonal();
  return {std::make_shared<TriangleBvh>(opaque.positions, opaque.triangles), diagonal, k_ray_start * diagonal};
}

}  // namespace papilla::detail
