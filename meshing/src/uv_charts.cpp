// SPDX-License-Identifier: MIT
#include "papilla/meshing/uv_charts.hpp"

#include <cmath>
#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "seam_set.hpp"
#include "segmented_mesh.hpp"

namespace papilla {
namespace {

using namespace detail;

void check_uv(const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const Index i : mesh.uv.indices[t]) {
      if (i >= mesh.uv.values.size())
        throw InvalidInput("uv_charts: triangle[" + std::to_string(t) + "] names uv " + std::to_string(i) + " of " +
                           std::to_string(mesh.uv.values.size()));
      if (!std::isfinite(mesh.uv.values[i].x) || !std::isfinite(mesh.uv.values[i].y))
        throw InvalidInput("uv_charts: a uv of triangle[" + std::to_string(t) + "] is not finite");
    }
}

}  // namespace

void require_uv(const TriangleMesh& mesh) {
  std::size_t without = mesh.triangles.size(), first = 0;
  if (mesh.uv.indices.size() == mesh.triangles.size()) {
    without = 0;
    for (std::size_t t = mesh.triangles.size(); t-- > 0;)
      if (!mesh.uv.has_value(t)) ++without, first = t;
  }
  if (without > 0)
    throw InvalidInput(std::to_string(without) + " of " + std::to_string(mesh.triangles.size()) +
                       " triangles have no texture coordinates whose seams could be charts, the first is triangle[" +
                       std::to_string(first) + "]");
}

ChartSet uv_charts(const TriangleMesh& mesh) {
  check_mesh(mesh, "uv_charts");
  require_uv(mesh);
  check_uv(mesh);
  const SegmentedMesh surface(mesh);
  const auto uv_at = [&](Index h) { return mesh.uv.values[mesh.uv.indices[h / 3][h % 3]]; };
  const auto next = [](Index h) { return h % 3 == 2 ? h - 2 : h + 1; };
  std::vector<std::uint8_t> seam(surface.opposite.size());
  for (Index h = 0; h < seam.size(); ++h) {
    const Index other = surface.opposite[h];
    seam[h] = other == k_none || uv_at(h) != uv_at(next(other)) || uv_at(next(h)) != uv_at(other);
  }
  return charts_between(surface, seam);
}

}  // namespace papilla
