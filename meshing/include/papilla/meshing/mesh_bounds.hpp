// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/bounds.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Of the vertices that triangles use, millimetres.
inline Bounds3 bounds_of(const TriangleMesh& mesh) noexcept {
  Bounds3 bounds;
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) bounds.add(mesh.positions[v]);
  return bounds;
}

}  // namespace papilla
