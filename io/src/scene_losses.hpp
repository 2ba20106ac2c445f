// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// What a file format keeps of a scene.
struct FormatKeeps {
  bool parts = false;             ///< Their division and names.
  bool nodes = false;             ///< The tree with its transforms; a part that several nodes show is stored once.
  bool materials = false;         ///< Names, colours and the base colour, emission and normal pictures.
  bool all_of_materials = false;  ///< Every texture, extensions and extras too.
  bool normals = false, uv = false, uv1 = false, colors = false;
  bool faces = false;   ///< Face numbers of triangles.
  bool extras = false;  ///< Of scene, nodes and parts.
  bool cad_uv = false;
};

/// What the shown parts of the scene hold that the format has no place for, one sentence each.
/// @throws InvalidInput as instances().
std::vector<std::string> scene_losses(const Scene& scene, const FormatKeeps& keeps);

}  // namespace papilla
