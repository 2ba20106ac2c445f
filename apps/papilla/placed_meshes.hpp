// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/meshing/placed_mesh.hpp"

namespace papilla::app {

/// The parts where they stand in the scene, y up; all of them hide what lies behind, glass too.
std::vector<PlacedMesh> placed_y_up(const Scene& scene, std::span<const Instance> uses);

}  // namespace papilla::app
