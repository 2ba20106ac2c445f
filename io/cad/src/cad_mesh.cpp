// SPDX-License-Identifier: MIT
#include "cad_mesh.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace papilla::cad {
namespace {

/// Normal of the surface beside a corner where it has none itself, as on a cone's apex: on the way to the triangle's
/// middle.
Vec3 limit_normal(const FacePatch& patch, const FaceSurface& surface, std::uint32_t t, std::size_t k) {
  constexpr double k_step = 1e-3;
  const Vec2 corner = patch.corner_uv(t, k);
  const Vec2 middle = (1.0 / 3) * (patch.corner_uv(t, 0) + patch.corner_uv(t, 1) + patch.corner_uv(t, 2));
  const Vec3 n = surface.at(corner + k_step * (middle - corner)).normal;
  if (norm(n) > 0 && is_finite(n)) return n;
  const Triangle& nodes = patch.triangles[t];
  const Vec3 a = patch.nodes[nodes[0]].position;
  const Vec3 flat = normalized(cross(patch.nodes[nodes[1]].position - a, patch.nodes[nodes[2]].position - a));
  return norm(flat) > 0 ? flat : Vec3{0, 0, 1};
}

bool has_own_values(const PatchNode& node) { return !node.is_singular() && norm(node.normal) > 0.5; }

/// Appends one face's corner values: one per node, and one per corner where the surface is singular.
class CornerWriter {
 public:
  CornerWriter(const FaceMesh& face, TriangleMesh& mesh)
      : face_(face), mesh_(mesh), index_of_(face.patch.nodes.size(), k_no_value) {}

  Index corner(std::uint32_t t, std::size_t k) {
    const FacePatch& patch = face_.patch;
    const Index node = patch.triangles[t][k];
    if (has_own_values(patch.nodes[node])) {
      if (index_of_[node] == k_no_value) index_of_[node] = append(patch.nodes[node].normal, patch.nodes[node].uv);
      return index_of_[node];
    }
    if (!surface_) surface_ = std::make_unique<FaceSurface>(face_.face);
    return append(limit_normal(patch, *surface_, t, k), patch.corner_uv(t, k));
  }

 private:
  Index append(Vec3 normal, Vec2 uv) {
    mesh_.normals.values.push_back(face_.reversed ? -normal : normal);
    mesh_.cad_uv.values.push_back(uv);
    return static_cast<Index>(mesh_.cad_uv.values.size() - 1);
  }

  const FaceMesh& face_;
  TriangleMesh& mesh_;
  std::vector<Index> index_of_;
  std::unique_ptr<FaceSurface> surface_;
};

class Gatherer {
 public:
  Gatherer(const std::vector<Vec3>& points, ShapeMesh& result)
      : points_(points), index_of_(points.size(), k_no_value), result_(result) {}

  void add(const FaceMesh& face, std::uint32_t number) {
    TriangleMesh& mesh = result_.mesh;
    const FacePatch& patch = face.patch;
    std::vector<Index> inner(patch.nodes.size(), k_no_value);
    CornerWriter corners(face, mesh);
    for (const std::uint32_t t : patch.in_rings()) {
      Triangle positions{}, values{};
      for (std::size_t k = 0; k < 3; ++k) positions[k] = position(patch, patch.triangles[t][k], inner);
      if (positions[0] == positions[1] || positions[1] == positions[2] || positions[2] == positions[0]) {
        ++result_.dropped_triangles;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) values[k] = corners.corner(t, k);
      if (face.reversed) {
        std::swap(positions[1], positions[2]);
        std::swap(values[1], values[2]);
      }
      mesh.triangles.push_back(positions);
      mesh.normals.indices.push_back(values);
      mesh.cad_uv.indices.push_back(values);
      mesh.face.push_back(number);
    }
  }

 private:
  Index position(const FacePatch& patch, Index node, std::vector<Index>& inner) {
    const PatchNode& n = patch.nodes[node];
    Index& known = n.shared == k_no_value ? inner[node] : index_of_[n.shared];
    if (known == k_no_value) {
      known = static_cast<Index>(result_.mesh.positions.size());
      result_.mesh.positions.push_back(n.shared == k_no_value ? n.position : points_[n.shared]);
    }
    return known;
  }

  const std::vector<Vec3>& points_;
  std::vector<Index> index_of_;
  ShapeMesh& result_;
};

}  // namespace

ShapeMesh to_mesh(TessellatedShape shape, const std::vector<std::uint32_t>& face_materials) {
  ShapeMesh result;
  Gatherer gatherer(shape.points, result);
  for (std::uint32_t number = 0; number < shape.faces.size(); ++number) {
    gatherer.add(shape.faces[number], number);
    shape.faces[number] = {};
    if (!face_materials.empty()) result.mesh.material.resize(result.mesh.triangles.size(), face_materials[number]);
  }
  return result;
}

}  // namespace papilla::cad
