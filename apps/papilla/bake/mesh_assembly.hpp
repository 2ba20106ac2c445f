// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::app {

/// The named triangles as a mesh of their own, with all attributes. Unused positions and values are left out;
/// order is kept. Cost: O(size of mesh).
TriangleMesh extract_triangles(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles);

/// Appends `piece` to `mesh`. Attributes that only one of the two has are filled with "no value" (numbers per
/// triangle: 0) for the other.
void append_mesh(TriangleMesh& mesh, const TriangleMesh& piece);

}  // namespace papilla::app
