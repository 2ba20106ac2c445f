// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "edge_net.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::cad {

/// A CAD face that the mesher refused at first.
struct FaceTrouble {
  std::uint32_t number = 0;
  std::string reason;
  std::vector<std::string> tried;
  bool solved = false;  ///< It has triangles up to its whole boundary.
};

/// A face whose triangles stay further off than asked for.
struct FaceOff {
  std::uint32_t number = 0;
  std::string reason;
};

/// The faces of one shape, in the order of their numbers, refined.
struct TessellatedShape {
  std::vector<FaceMesh> faces;  ///< With or without triangles.
  std::vector<Vec3> points;     ///< What PatchNode::shared numbers.
  std::vector<FaceTrouble> troubles;
  std::vector<FaceOff> off;
  double max_deviation_mm = 0, max_angle_deg = 0;
  std::size_t added_nodes = 0;  ///< By refinement, on edges and inside of faces.
};

/// Diagonal of the box around all shapes; 0 when they are empty.
double diagonal_of(const std::vector<TopoDS_Shape>& shapes);

/// Triangulates every face of the shapes, edges shared between faces once, and refines edges and then faces until both
/// keep chord and angle.
/// @return one entry per shape.
std::vector<TessellatedShape> tessellate(const std::vector<TopoDS_Shape>& shapes, const CadReadOptions& options,
                                         const ProgressCallback& progress);

struct ShapeMesh {
  TriangleMesh mesh;
  std::size_t dropped_triangles = 0;  ///< Corners that are one point of the CAD file.
};

/// The faces' triangles as one mesh, welded along shared edges. Empties the faces.
ShapeMesh to_mesh(TessellatedShape shape);

}  // namespace papilla::cad
