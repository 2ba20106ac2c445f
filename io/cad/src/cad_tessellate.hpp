// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/cad_reader.hpp"

namespace papilla::cad {

/// A CAD face and where its triangles are.
struct NumberedFace {
  TopoDS_Face cad;        ///< The face of the file.
  TopoDS_Face triangles;  ///< The face that carries the triangulation: `cad` itself, or a scaled or healed copy of it.
  std::uint32_t number = 0;
  double scale = 1;  ///< Size of `triangles` relative to `cad`, a power of two.
};

/// A CAD face that the mesher refused at first.
struct FaceTrouble {
  std::uint32_t number = 0;
  std::string reason;
  bool solved = false;  ///< A later attempt gave triangles.
};

/// The faces of one shape, in the order of their numbers.
struct TessellatedShape {
  std::vector<NumberedFace> faces;  ///< With or without triangles.
  std::vector<FaceTrouble> troubles;
};

/// Diagonal of the box around all shapes; 0 when they are empty.
double diagonal_of(const std::vector<TopoDS_Shape>& shapes);

/// Triangulates every face of the shapes in place, edges shared between faces once. A shape with faces that stay
/// without triangles is triangulated again as a scaled copy: the mesher's absolute tolerances then fall otherwise, and
/// shared edges stay shared. What still has no triangles is healed and triangulated alone.
/// @return one entry per shape.
std::vector<TessellatedShape> tessellate(const std::vector<TopoDS_Shape>& shapes, const CadReadOptions& options,
                                         const Progress& progress);

}  // namespace papilla::cad
