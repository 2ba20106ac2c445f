// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/shown_mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "papilla/io/vertex_normals.hpp"

namespace papilla {
namespace {

/// Numbers of position, normal, uv and uv1 of a corner.
using Corner = std::array<Index, 4>;

Index value_of(const CornerAttribute<Vec2>& attribute, std::size_t t, std::size_t k) {
  return attribute.has_value(t) ? attribute.indices[t][k] : k_no_value;
}

void push(std::vector<float>& list, Vec3 v) {
  for (const double x : {v.x, v.y, v.z}) list.push_back(static_cast<float>(x));
}

void push(std::vector<float>& list, Vec2 v) {
  for (const double x : {v.x, v.y}) list.push_back(static_cast<float>(x));
}

/// Where triangles lie that share an edge, their uv at its ends.
void add_seams(const TriangleMesh& mesh, std::vector<float>& seams) {
  if (mesh.uv.empty()) return;
  struct Side {
    Index low, high;        // Positions.
    Index uv_low, uv_high;  // Values of uv there.
    bool operator<(const Side& other) const {
      return std::tie(low, high, uv_low, uv_high) < std::tie(other.low, other.high, other.uv_low, other.uv_high);
    }
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      Side side{mesh.triangles[t][k], mesh.triangles[t][l], value_of(mesh.uv, t, k), value_of(mesh.uv, t, l)};
      if (side.low > side.high) std::swap(side.low, side.high), std::swap(side.uv_low, side.uv_high);
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end());
  const auto agrees = [&](const Side& a, const Side& b) {
    const auto same = [&](Index x, Index y) {
      return x == y || (x != k_no_value && y != k_no_value && mesh.uv.values[x] == mesh.uv.values[y]);
    };
    return same(a.uv_low, b.uv_low) && same(a.uv_high, b.uv_high);
  };
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    bool is_seam = false;
    for (end = begin; end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high;
         ++end)
      is_seam = is_seam || !agrees(sides[begin], sides[end]);
    if (end - begin != 1 && !is_seam) continue;
    push(seams, mesh.positions[sides[begin].low]);
    push(seams, mesh.positions[sides[begin].high]);
  }
}

}  // namespace

ShownMesh shown_mesh(const TriangleMesh& mesh, const DistortionReport& report, bool has_uv1) {
  const CornerAttribute<Vec3> made = mesh.normals.empty() ? vertex_normals(mesh) : CornerAttribute<Vec3>();
  const CornerAttribute<Vec3>& normals = mesh.normals.empty() ? made : mesh.normals;
  const std::size_t corners = 3 * mesh.triangles.size();
  std::vector<Corner> corner(corners);
  for (std::size_t i = 0; i < corners; ++i) {
    const std::size_t t = i / 3, k = i % 3;
    corner[i] = {mesh.triangles[t][k], normals.has_value(t) ? normals.indices[t][k] : k_no_value,
                 value_of(mesh.uv, t, k), has_uv1 ? value_of(mesh.uv1, t, k) : k_no_value};
  }
  std::vector<std::size_t> order(corners);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return corner[a] < corner[b]; });
  ShownMesh shown;
  shown.indices.resize(corners);
  struct Around {
    double weight = 0, stretch = 0, angle = 0;
  };
  std::vector<Around> around;
  for (std::size_t i = 0; i < corners; ++i) {
    const std::size_t c = order[i];
    if (i == 0 || corner[order[i - 1]] != corner[c]) {
      const auto [position, normal, uv, uv1] = corner[c];
      push(shown.positions, mesh.positions[position]);
      push(shown.normals, normal == k_no_value ? Vec3{0, 0, 1} : normals.values[normal]);
      push(shown.uv, uv == k_no_value ? Vec2{} : mesh.uv.values[uv]);
      if (has_uv1) push(shown.uv1, uv1 == k_no_value ? Vec2{} : mesh.uv1.values[uv1]);
      around.emplace_back();
    }
    shown.indices[c] = static_cast<std::uint32_t>(around.size() - 1);
    if (c / 3 >= report.per_triangle.size() || !report.per_triangle[c / 3].measured) continue;
    const TriangleDistortion& distortion = report.per_triangle[c / 3];
    Around& vertex = around.back();
    vertex.weight += distortion.area_mm2;
    vertex.stretch += distortion.area_mm2 * distortion.stretch_l2;
    vertex.angle += distortion.area_mm2 * distortion.angle_error_deg;
  }
  for (const Around& vertex : around) {
    const bool measured = vertex.weight > 0;
    push(shown.measured, measured ? Vec2{vertex.stretch / vertex.weight, vertex.angle / vertex.weight} : Vec2{-1, -1});
  }
  add_seams(mesh, shown.seams);
  return shown;
}

TriangleMesh triangle_mesh(const ShownMesh& shown) {
  const auto vec3_at = [](const std::vector<float>& values, std::size_t i) {
    return Vec3{double{values[3 * i]}, double{values[3 * i + 1]}, double{values[3 * i + 2]}};
  };
  const auto vec2_at = [](const std::vector<float>& values, std::size_t i) {
    return Vec2{double{values[2 * i]}, double{values[2 * i + 1]}};
  };
  TriangleMesh mesh;
  for (std::size_t i = 0; 3 * i < shown.positions.size(); ++i) {
    mesh.positions.push_back(vec3_at(shown.positions, i));
    mesh.normals.values.push_back(vec3_at(shown.normals, i));
    mesh.uv.values.push_back(vec2_at(shown.uv, i));
    if (!shown.uv1.empty()) mesh.uv1.values.push_back(vec2_at(shown.uv1, i));
  }
  for (std::size_t i = 0; i < shown.indices.size(); i += 3)
    mesh.triangles.push_back({shown.indices[i], shown.indices[i + 1], shown.indices[i + 2]});
  mesh.normals.indices = mesh.uv.indices = mesh.triangles;
  if (!shown.uv1.empty()) mesh.uv1.indices = mesh.triangles;
  return mesh;
}

}  // namespace papilla
