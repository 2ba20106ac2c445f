// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::detail {

/// Throws InvalidInput naming `function`, the array and the index unless every index of the mesh is in range,
/// every referenced position is finite, per-triangle arrays are empty or complete, and half-edges fit into Index.
void check_mesh(const TriangleMesh& mesh, std::string_view function);

}  // namespace papilla::detail
