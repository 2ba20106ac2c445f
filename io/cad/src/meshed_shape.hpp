// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <vector>

#include "cad_tessellate.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::cad {

/// What is left of a shape that was tessellated.
struct MeshedShape {
  TriangleMesh mesh;  ///< Without materials: TriangleMesh::face tells them.
  std::size_t faces = 0, dropped_triangles = 0, added_nodes = 0;
  std::vector<FaceTrouble> troubles;
  std::vector<FaceOff> off;
  double max_deviation_mm = 0, max_angle_deg = 0;
};

/// tessellate() and to_mesh(). With CadReadOptions::cache, shapes whose geometry was tessellated before with the same
/// options are not tessellated again; shapes that share edges are remembered together, as their edges are divided
/// together.
/// @return one entry per shape.
std::vector<MeshedShape> mesh_shapes(const std::vector<TopoDS_Shape>& shapes, const CadReadOptions& options,
                                     const ProgressCallback& progress);

}  // namespace papilla::cad
