// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cad_tessellate.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::cad {

struct ShapeMesh {
  TriangleMesh mesh;
  std::size_t dropped_triangles = 0;  ///< Corners that are one point of the CAD file.
};

/// The faces' triangles as one mesh, welded along shared edges. Empties the faces.
/// @param face_materials slot of each CAD face, by number, or empty.
ShapeMesh to_mesh(TessellatedShape shape, const std::vector<std::uint32_t>& face_materials);

}  // namespace papilla::cad
