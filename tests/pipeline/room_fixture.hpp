// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla::test {

inline void turn_all(TriangleMesh& mesh) { turn_triangles(mesh, std::vector<std::uint8_t>(mesh.triangles.size(), 1)); }

/// Adds a part and a node of the same name that shows it.
inline void add_part(Scene& scene, const std::string& name, TriangleMesh mesh,
                     std::vector<std::uint32_t> materials = {}) {
  Part part;
  part.name = name;
  part.mesh = std::move(mesh);
  part.materials = std::move(materials);
  Node node;
  node.name = name;
  node.part = static_cast<std::uint32_t>(scene.parts.size());
  scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
  scene.nodes.push_back(node);
  scene.parts.push_back(std::move(part));
}

/// The six walls of the room [0, 1000]³ mm without uv, 32 triangles each, fronts to its inside, with one material:
/// floor, ceiling, left, right, front, back.
inline Scene room() {
  constexpr double k_side = 1000;
  Scene scene;
  scene.format = "STEP";
  scene.materials.emplace_back().name = "paint";
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const struct {
    const char* name;
    Vec3 corner, a, b;
  } walls[] = {{"floor", {}, x, y}, {"ceiling", {0, 0, k_side}, y, x},
               {"left", {}, y, z},  {"right", {k_side, 0, 0}, z, y},
               {"front", {}, z, x}, {"back", {0, k_side, 0}, x, z}};
  for (const auto& wall : walls) {
    TriangleMesh mesh = plane(k_side, k_side, 4, 4);
    for (Vec3& p : mesh.positions) p = wall.corner + p.x * wall.a + p.y * wall.b;
    mesh.uv = {};
    add_part(scene, wall.name, std::move(mesh), {0});
  }
  return scene;
}

}  // namespace papilla::test
