// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "papilla/io/scene.hpp"
#include "scene_losses.hpp"

namespace papilla {

/// All instances of a scene as one mesh of vertices that carry attributes, node transforms applied: what PLY and OFF
/// hold. Positions stay shared over seams; an attribute that jumps at a position, or that some part lacks, has no place
/// with the vertices.
struct FlatMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  std::vector<Vec3> normals;  ///< As many as positions, or none; so are uv and colours.
  std::vector<Vec2> uv, cad_uv;
  std::vector<Color> colors;  ///< White on parts without colours.
  /// Per triangle, when `uv` or `cad_uv` has no place with the vertices; nothing on triangles without.
  std::vector<std::optional<std::array<Vec2, 3>>> triangle_uv, triangle_cad_uv;

  FormatKeeps keeps;  ///< Which attributes are here in full: normals, uv, cad_uv and colours.
};

/// @throws InvalidInput as place(), or when there are 2^32 − 1 positions or more.
FlatMesh flatten(const Scene& scene);

}  // namespace papilla
