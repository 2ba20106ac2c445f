// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::app {

/// The diagonal of the box around a mesh's positions, mm; 0 without positions. O(n).
double bounding_diagonal_mm(const TriangleMesh& mesh);

}  // namespace papilla::app
