// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::test {

// Whole parts in millimetres, closed and counter-clockwise from outside.

/// The dashboard as a sheet 10 thick: two crowned faces and a thin wall around. 4 (n m + n + m) triangles.
TriangleMesh panel_mesh(int columns, int rows);
/// Radius 500, height 2000, as CAD tessellates it: one quad per segment around, a fan for each cap. 4 n triangles.
TriangleMesh capped_cylinder_mesh(int segments);
/// Radii 1000 and 250. 2 n m triangles.
TriangleMesh torus_mesh(int around, int across);

}  // namespace papilla::test
