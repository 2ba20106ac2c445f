// SPDX-License-Identifier: MIT
#include "placed_mesh.hpp"

#include <fmt/core.h>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// Normals turn with the cofactors of the linear part: (M⁻¹)ᵀ without the division.
Vec3 transform_normal(const Transform& t, Vec3 n) {
  const Vec3 x{t[0], t[4], t[8]}, y{t[1], t[5], t[9]}, z{t[2], t[6], t[10]};
  return normalized(n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y));
}

template <class T>
void check(const CornerAttribute<T>& attribute, const Part& part, const char* name) {
  if (!attribute.empty() && attribute.indices.size() != part.mesh.triangles.size())
    throw InvalidInput(fmt::format("part '{}': {} has {} entries for {} triangles", part.name, name,
                                   attribute.indices.size(), part.mesh.triangles.size()));
  for (const Triangle& indices : attribute.indices)
    for (const Index index : indices)
      if (index >= attribute.values.size() && index != k_no_value)
        throw InvalidInput(
            fmt::format("part '{}': {} {} of {} does not exist", part.name, name, index, attribute.values.size()));
}

void check(const Part& part) {
  for (const Triangle& triangle : part.mesh.triangles)
    for (const Index index : triangle)
      if (index >= part.mesh.positions.size())
        throw InvalidInput(
            fmt::format("part '{}': position {} of {} does not exist", part.name, index, part.mesh.positions.size()));
  check(part.mesh.uv, part, "texture coordinate");
  check(part.mesh.normals, part, "normal");
  check(part.mesh.colors, part, "colour");
}

}  // namespace

PlacedMesh place(const Scene& scene, const Instance& instance) {
  const Part& part = scene.parts[instance.part];
  check(part);
  PlacedMesh placed;
  const std::string& node_name = scene.nodes[instance.node].name;
  placed.name = node_name.empty() ? part.name : node_name;
  placed.part = &part;
  const double d = determinant(instance.world);
  placed.mirrored = d < 0;
  placed.positions.reserve(part.mesh.positions.size());
  for (const Vec3& position : part.mesh.positions) {
    placed.positions.push_back(transform_point(instance.world, position));
    if (!is_finite(placed.positions.back()))
      throw InvalidInput(fmt::format("part '{}': position {} is not finite", part.name, placed.positions.size() - 1));
  }
  placed.normals.reserve(part.mesh.normals.values.size());
  for (const Vec3& normal : part.mesh.normals.values) {
    const Vec3 turned = transform_normal(instance.world, normal);
    placed.normals.push_back(d < 0 ? -turned : turned);
  }
  return placed;
}

}  // namespace papilla
