// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/placed_mesh.hpp"

namespace papilla {

/// The parts where they stand in the scene, then turned; those with a material that is blended are not opaque.
std::vector<PlacedMesh> placed_meshes(const Scene& scene, std::span<const Instance> uses,
                                      const Transform& turn = k_identity);

}  // namespace papilla
