// SPDX-License-Identifier: GPL-3.0-or-later
#include "placed_meshes.hpp"

namespace papilla::app {

std::vector<PlacedMesh> placed_y_up(const Scene& scene, std::span<const Instance> uses) {
  std::vector<PlacedMesh> placed;
  for (const Instance& use : uses)
    placed.push_back({&scene.parts[use.part].mesh, multiply(to_y_up(scene.up), use.world)});
  return placed;
}

}  // namespace papilla::app
