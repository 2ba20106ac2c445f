// SPDX-License-Identifier: MIT
#include "placed_meshes.hpp"

#include <algorithm>

namespace papilla {
namespace {

bool is_opaque(const Scene& scene, const Part& part) {
  return std::none_of(part.materials.begin(), part.materials.end(), [&](std::uint32_t m) {
    return m < scene.materials.size() && scene.materials[m].alpha_mode == "BLEND";
  });
}

}  // namespace

std::vector<PlacedMesh> placed_meshes(const Scene& scene, std::span<const Instance> uses, const Transform& turn) {
  std::vector<PlacedMesh> placed;
  for (const Instance& use : uses) {
    const Part& part = scene.parts[use.part];
    placed.push_back({&part.mesh, multiply(turn, use.world), is_opaque(scene, part)});
  }
  return placed;
}

}  // namespace papilla
