// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

inline std::size_t triangles_of(const NamedMesh& input) { return input.mesh.triangles.size(); }

/// Meshes that are made to break mesh algorithms: needles to an aspect of 1e7, areas from 1e-20 to 1e20 mm²,
/// coordinates scaled by 1e-9 to 1e9 and 1e6 from the origin, vertices on top of each other and on a line, one
/// triangle, extreme curvature, a million triangles. All are connected disks by index; where vertices coincide
/// welding makes edges of four triangles. All but sphere, finger and the single triangle have CAD
/// parameters. The first one is well shaped, for comparison.
std::vector<NamedMesh> extreme_meshes();

}  // namespace papilla
