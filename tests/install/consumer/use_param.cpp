// SPDX-License-Identifier: MIT
#include <papilla/param/lscm.hpp>

int main() {
  papilla::TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const papilla::ChartSet whole{.of_triangle = {0, 0}, .count = 1};
  return papilla::flatten_lscm(mesh, whole).uv.indices.size() == 2 ? 0 : 1;
}
