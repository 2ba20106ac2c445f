// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "check_mesh.hpp"
#include "mesh_frame.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/param/projections.hpp"

namespace papilla {

using namespace param_detail;

CornerAttribute<Vec2> environment_uv(const TriangleMesh& mesh, const EnvironmentOptions& options) {
  constexpr const char* k_function = "environment_uv";
  check_mesh(mesh, k_function);
  if (options.eye && !is_finite(*options.eye)) throw InvalidInput(std::string(k_function) + ": eye is not finite");
  const Bounds3 bounds = bounds_of(mesh);
  const UprightFrame world = upright_frame(options.up);
  const Vec3 eye = options.eye.value_or(bounds.middle() - (3 * std::max(bounds.diagonal(), 1e-300)) * world.back);
  Vec3 back = normalized(eye - bounds.middle());
  if (!(norm(back) > 0)) back = -world.back;
  Vec3 right = cross(world.up, back);
  right = norm(right) > 1e-9 ? normalized(right) : world.right;  // an eye right above or below
  const Vec3 up = cross(back, right);

  const std::vector<Vec3> normals = vertex_normals(mesh);
  CornerAttribute<Vec2> uv;
  uv.indices = mesh.triangles;
  uv.values.reserve(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 view = normalized(mesh.positions[v] - eye);
    const Vec3 r = view - 2 * dot(view, normals[v]) * normals[v];
    const double x = dot(right, r), y = dot(up, r), z = dot(back, r);
    const double m = 2 * std::sqrt(x * x + y * y + (z + 1) * (z + 1));
    uv.values.push_back(m > 0 ? Vec2{x / m + 0.5, y / m + 0.5} : Vec2{0.5, 0.5});
  }
  return uv;
}

}  // namespace papilla
