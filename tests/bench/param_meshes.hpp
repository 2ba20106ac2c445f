// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::bench {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// The dashboard with 1 % of its triangles squashed to `height` of their longest edge, no two of them near each other.
TriangleMesh squashed(const TriangleMesh& mesh, double height);

/// The mesh without what lies in three circles seen along z: a trimmed panel.
TriangleMesh trimmed(const TriangleMesh& mesh);

/// A crowned panel, 2 × 5, of 2000 × 5 quads; x shrunk by `squeeze`: triangles of aspect 1000 / squeeze.
TriangleMesh needle_panel(double squeeze);

/// Disks that no linear method maps without flips: fingers, a hand, a head, nearly closed spheres, cut tori, spirals.
std::vector<NamedMesh> curved_disks(bool quick);

}  // namespace papilla::bench
