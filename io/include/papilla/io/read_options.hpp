// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>

#include "papilla/io/scene.hpp"

namespace papilla {

class StageCache;

/// Choices that a file leaves open. Each format ignores the options that do not apply to it.
struct ReadOptions {
  /// Instead of the unit that a CAD file or one that assimp reads states; of STL, OBJ, PLY, OFF and AC3D, which state
  /// none: 1 when not given.
  /// In (0, 1e9].
  std::optional<double> millimetres_per_unit;
  std::optional<UpAxis> up;  ///< Overrides the format's convention: OBJ, glTF, AC3D and X3D y, FBX and COLLADA as they
                             ///< state, all others z.
  double chord_mm = 0.1;     ///< CAD surfaces: largest distance between surface and triangle.
  double angle_deg = 20;     ///< CAD surfaces: largest angle between neighbouring normals.
  double max_edge_mm = 0;    ///< CAD surfaces: longest edge of a triangle; 0: any.
  std::filesystem::path tags;         ///< glTF: GltfReadOptions::tags.
  bool tag_channel = false;           ///< glTF: GltfReadOptions::tag_channel.
  const StageCache* cache = nullptr;  ///< Of what CAD files hold and of their tessellation.
};

}  // namespace papilla
