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
  std::vector<std::uint32_t> not_finite;  ///< Faces left out because of NaN or infinity.
  std::size_t dropped_triangles = 0;
  double max_deviation_mm = 0;
};

/// The triangles that the faces carry, as one mesh welded along shared edges.
/// @param face_materials slot of each CAD face, by number, or empty.
ShapeMesh to_mesh(const std::vector<NumberedFace>& faces, const std::vector<std::uint32_t>& face_materials);

}  // namespace papilla::cad
