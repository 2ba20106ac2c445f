// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "check_mesh.hpp"
#include "mesh_frame.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "papilla/param/projections.hpp"

namespace papilla {

using namespace param_detail;

namespace {

/// Directions nearer to up or down than this have no longitude.
constexpr double k_pole = 1e-9;

Vec2 on_ball(Vec3 r) {
  const double m = 2 * std::sqrt(r.x * r.x + r.y * r.y + (r.z + 1) * (r.z + 1));
  return m > 0 ? Vec2{r.x / m + 0.5, r.y / m + 0.5} : Vec2{0.5, 0.5};
}

Vec2 on_panorama(Vec3 r) { return {0.5 * (1 + std::atan2(r.x, r.z) / std::numbers::pi), 0.5 * (r.y + 1)}; }

/// Adds 1 to what lies left of the largest gap between the values, on a circle of length 1.
void close_ranks(std::vector<double>& u) {
  std::vector<double> sorted = u;
  std::sort(sorted.begin(), sorted.end());
  double largest = sorted.front() + 1 - sorted.back(), first = sorted.front();
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i] - sorted[i - 1] > largest) largest = sorted[i] - sorted[i - 1], first = sorted[i];
  for (double& value : u)
    if (value < first) value += 1;
}

/// Gives corners of triangles that the panorama's ends or poles cut apart values of their own.
void keep_together(const std::vector<char>& at_pole, CornerAttribute<Vec2>& uv) {
  std::map<std::pair<Index, double>, Index> added;  // by vertex and u
  const auto value_with = [&](Index vertex, double u) {
    const auto [place, is_new] = added.try_emplace({vertex, u}, static_cast<Index>(uv.values.size()));
    if (is_new) uv.values.push_back({u, uv.values[vertex].y});
    return place->second;
  };
  for (Triangle& t : uv.indices) {
    std::vector<double> u;
    for (const Index v : t)
      if (!at_pole[v]) u.push_back(uv.values[v].x);
    if (u.empty()) continue;
    close_ranks(u);
    const double mean = std::accumulate(u.begin(), u.end(), 0.0) / static_cast<double>(u.size());
    auto next = u.begin();
    for (Index& corner : t) {
      const double own = at_pole[corner] ? mean : *next++;
      if (own != uv.values[corner].x) corner = value_with(corner, own);
    }
  }
}

}  // namespace

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

  const bool is_panorama = options.map == EnvironmentMap::equal_area;
  const std::vector<Vec3> normals = vertex_normals(mesh);
  std::vector<char> at_pole(mesh.positions.size(), 0);
  CornerAttribute<Vec2> uv;
  uv.indices = mesh.triangles;
  uv.values.reserve(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 view = normalized(mesh.positions[v] - eye);
    const Vec3 r = view - 2 * dot(view, normals[v]) * normals[v];
    if (is_panorama) {
      const Vec3 own{dot(world.right, r), dot(world.up, r), -dot(world.back, r)};
      at_pole[v] = !(std::hypot(own.x, own.z) > k_pole);
      uv.values.push_back(on_panorama(own));
    } else {
      uv.values.push_back(on_ball({dot(right, r), dot(up, r), dot(back, r)}));
    }
  }
  if (is_panorama) keep_together(at_pole, uv);
  return uv;
}

}  // namespace papilla
