// SPDX-License-Identifier: MIT
#include <papilla/meshing/statistics.hpp>

int main() {
  papilla::TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  return papilla::mesh_statistics(mesh).area_mm2 == 6 ? 0 : 1;
}
