// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// A mesh where it stands in a scene.
struct PlacedMesh {
  const TriangleMesh* mesh = nullptr;
  /// Row-major affine map of column vectors, translation in mm.
  std::array<double, 16> world{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  bool opaque = true;  ///< Hides what lies behind it.
};

}  // namespace papilla
