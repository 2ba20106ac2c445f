// SPDX-License-Identifier: MIT
#include <cmath>

#include "check_mesh.hpp"
#include "corner_charts.hpp"
#include "mesh_frame.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/projections.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// The direction d of greatest Σ A (n·d)², on the side of Σ A n.
Vec3 dominant_normal(const TriangleMesh& mesh) {
  Vec3 sum, x, y, z;  // the last three: rows of Σ A n nᵀ
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 doubled = cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0));
    const double area = norm(doubled);
    if (!(area > 0)) continue;
    sum = sum + doubled;
    x = x + (doubled.x / area) * doubled, y = y + (doubled.y / area) * doubled, z = z + (doubled.z / area) * doubled;
  }
  const Vec3 best = principal_axis({x, y, z});
  return dot(best, sum) < 0 ? -best : best;
}

/// The direction along which v grows in a plane; any where the grain has no preference.
Vec3 upward_in_plane(Vec3 outward, UpAxis up) {
  const Vec3 grain = grain_direction(outward, up);
  if (norm(grain) > 1e-6) return normalized(grain);
  const UprightFrame frame = upright_frame(up);
  return normalized(frame.back - dot(frame.back, outward) * outward);
}

}  // namespace

ProjectionResult flatten_planar(const TriangleMesh& mesh, const PlanarOptions& options) {
  constexpr const char* k_function = "flatten_planar";
  check_mesh(mesh, k_function);
  ProjectionResult result;
  if (options.direction && !(is_finite(*options.direction) && norm(*options.direction) > 0))
    throw InvalidInput(std::string(k_function) + ": direction is not a finite vector with a length");
  result.direction = options.direction ? normalized(*options.direction) : dominant_normal(mesh);
  const Vec3 v = upward_in_plane(result.direction, options.up), u = cross(v, result.direction);
  std::vector<CornerUv> uv(mesh.triangles.size());
  for (std::size_t t = 0; t < uv.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.corner(t, static_cast<int>(k));
      uv[t][k] = {dot(u, p), dot(v, p)};
    }
  CornerCharts charts = charts_of_corners(mesh, uv, std::vector<std::uint32_t>(uv.size(), 0));
  result.flattening = std::move(charts.flattening);
  result.turned_over = charts.turned_over;
  return result;
}

}  // namespace papilla
