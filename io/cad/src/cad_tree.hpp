// SPDX-License-Identifier: MIT
#pragma once

#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <vector>

#include "cad_document.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::cad {

/// A scene whose parts have no mesh yet, and the shape of each part.
struct CadTree {
  Scene scene;
  std::vector<TopoDS_Shape> shapes;  ///< One per part.
  std::vector<std::vector<std::uint32_t>>
      face_materials;  ///< Per part and face: slot in Part::materials; may be empty.
};

/// Turns the document's assembly tree into nodes, parts and materials. Shapes without faces are left out and named
/// in Scene::losses.
/// @throws InvalidInput when the tree has over 4 million nodes or is nested over 500 deep.
CadTree build_tree(const CadDocument& document);

}  // namespace papilla::cad
