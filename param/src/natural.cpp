// SPDX-License-Identifier: MIT
#include "papilla/param/natural.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "check_mesh.hpp"
#include "corner_charts.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "flatten_natural";

/// Doubled area in parameters, as a fraction of the longest edge squared, below which a triangle has none.
constexpr double k_no_area = 1e-12;

/// What a face's parameters are worth in millimetres.
struct FaceScale {
  double area = 0, u_length = 0, v_length = 0;
};

Vec2 parameter(const TriangleMesh& mesh, std::size_t t, std::size_t k) {
  return mesh.cad_uv.values[mesh.cad_uv.indices[t][k]];
}

bool has_parameters(const TriangleMesh& mesh, std::size_t t) {
  if (!mesh.cad_uv.has_value(t)) return false;
  const Vec2 m = parameter(mesh, t, 1) - parameter(mesh, t, 0), n = parameter(mesh, t, 2) - parameter(mesh, t, 0);
  const Vec2 r = n - m;
  return std::abs(cross(m, n)) > k_no_area * std::max({dot(m, m), dot(n, n), dot(r, r)});
}

/// |∂p/∂u| and |∂p/∂v| of the affine map from parameters to space.
Vec2 speeds(const TriangleMesh& mesh, std::size_t t) {
  const Vec2 m = parameter(mesh, t, 1) - parameter(mesh, t, 0), n = parameter(mesh, t, 2) - parameter(mesh, t, 0);
  const Vec3 p = mesh.corner(t, 1) - mesh.corner(t, 0), q = mesh.corner(t, 2) - mesh.corner(t, 0);
  const double det = cross(m, n);
  return {norm((1 / det) * (n.y * p - m.y * q)), norm((1 / det) * (m.x * q - n.x * p))};
}

std::uint32_t face_of(const TriangleMesh& mesh, std::size_t t) { return mesh.face.empty() ? 0 : mesh.face[t]; }

std::map<std::uint32_t, FaceScale> face_scales(const TriangleMesh& mesh, const std::vector<char>& usable) {
  std::map<std::uint32_t, FaceScale> scales;
  for (std::size_t t = 0; t < usable.size(); ++t) {
    if (!usable[t]) continue;
    const double area = norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
    const Vec2 speed = speeds(mesh, t);
    FaceScale& scale = scales[face_of(mesh, t)];
    scale.area += area, scale.u_length += area * speed.x, scale.v_length += area * speed.y;
  }
  return scales;
}

/// Adds triplanar charts for the triangles that are not usable.
void project_rest(const TriangleMesh& mesh, const std::vector<char>& usable, const NaturalOptions& options,
                  Flattening& result) {
  TriangleMesh rest;
  rest.positions = mesh.positions;
  std::vector<Index> triangle;
  for (Index t = 0; t < usable.size(); ++t)
    if (!usable[t]) rest.triangles.push_back(mesh.triangles[t]), triangle.push_back(t);
  if (triangle.empty()) return;
  TriplanarOptions projection = options.projection;
  projection.up = options.up;
  const Flattening projected = flatten_triplanar(rest, projection).flattening;
  const auto first = static_cast<Index>(result.uv.values.size());
  result.uv.values.insert(result.uv.values.end(), projected.uv.values.begin(), projected.uv.values.end());
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) result.uv.indices[triangle[i]][k] = first + projected.uv.indices[i][k];
    result.charts.of_triangle[triangle[i]] = result.charts.count + projected.charts.of_triangle[i];
  }
  result.notes.push_back({result.charts.count, std::to_string(triangle.size()) + " triangles (the first: triangle[" +
                                                   std::to_string(triangle.front()) +
                                                   "]) have no usable CAD parameters; projected as " +
                                                   std::to_string(projected.charts.count) + " planar pieces instead"});
  result.charts.count += projected.charts.count;
}

/// Numbers charts without gaps, in order of their first triangle.
void renumber(Flattening& f) {
  std::vector<std::uint32_t> number(f.charts.count, ~std::uint32_t{0});
  std::uint32_t count = 0;
  for (std::uint32_t& chart : f.charts.of_triangle) {
    if (number[chart] == ~std::uint32_t{0}) number[chart] = count++;
    chart = number[chart];
  }
  f.charts.count = count;
}

}  // namespace

Flattening flatten_natural(const TriangleMesh& mesh, const NaturalOptions& options) {
  check_mesh(mesh, k_function);
  const std::size_t count = mesh.triangles.size();
  if (count == 0) return {};
  if (mesh.cad_uv.indices.size() != count)
    throw InvalidInput(std::string(k_function) + ": the mesh has no CAD parameters; read it from STEP, IGES or BREP");
  for (std::size_t t = 0; t < count; ++t)
    for (const Index i : mesh.cad_uv.indices[t])
      if (mesh.cad_uv.has_value(t) && (i >= mesh.cad_uv.values.size() || !is_finite(mesh.cad_uv.values[i])))
        throw InvalidInput(std::string(k_function) + ": triangle[" + std::to_string(t) +
                           "] has CAD parameters that do not exist or are not finite");
  std::vector<char> usable(count);
  for (std::size_t t = 0; t < count; ++t) {
    usable[t] = has_parameters(mesh, t);
    if (!usable[t] && !options.fall_back)
      throw InvalidInput(std::string(k_function) + ": triangle[" + std::to_string(t) +
                         "] has no usable CAD parameters");
  }
  const auto scales = face_scales(mesh, usable);
  std::vector<CornerUv> uv(count);
  std::vector<std::uint32_t> label(count);
  for (std::size_t t = 0; t < count; ++t) {
    label[t] = usable[t] ? face_of(mesh, t) : ~std::uint32_t{0};
    if (!usable[t]) continue;
    const FaceScale& scale = scales.at(face_of(mesh, t));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 p = parameter(mesh, t, k);
      uv[t][k] = {scale.u_length / scale.area * p.x, scale.v_length / scale.area * p.y};
    }
  }
  Flattening result = charts_of_corners(mesh, uv, label).flattening;
  project_rest(mesh, usable, options, result);
  renumber(result);
  return result;
}

}  // namespace papilla
