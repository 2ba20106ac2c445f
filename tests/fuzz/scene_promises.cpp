// SPDX-License-Identifier: MIT
#include "scene_promises.hpp"

#include <algorithm>
#include <cmath>

#include "fuzz_input.hpp"

namespace papilla::fuzz {
namespace {

bool is_finite_value(Vec2 v) { return is_finite(v); }
bool is_finite_value(Vec3 v) { return is_finite(v); }
bool is_finite_value(const Color& c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) && std::isfinite(c.a);
}

template <class T>
void require_attribute(const CornerAttribute<T>& attribute, const TriangleMesh& mesh) {
  require(std::all_of(attribute.values.begin(), attribute.values.end(), [](const T& v) { return is_finite_value(v); }),
          "attribute values are finite");
  if (attribute.empty()) return;
  require(attribute.indices.size() == mesh.triangles.size(), "an attribute has an entry per triangle");
  for (const Triangle& indices : attribute.indices) {
    const auto missing = std::count(indices.begin(), indices.end(), k_no_value);
    require(missing == 0 || missing == 3, "a triangle has all three values or none");
    for (const Index index : indices)
      require(index == k_no_value || index < attribute.values.size(), "attribute indices are in range");
  }
}

void require_part(const Scene& scene, const Part& part) {
  const TriangleMesh& mesh = part.mesh;
  for (const Vec3& position : mesh.positions) require(is_finite(position), "positions are finite");
  for (const Triangle& triangle : mesh.triangles)
    for (const Index index : triangle) require(index < mesh.positions.size(), "position indices are in range");
  require_attribute(mesh.normals, mesh);
  require_attribute(mesh.uv, mesh);
  require_attribute(mesh.uv1, mesh);
  require_attribute(mesh.cad_uv, mesh);
  require_attribute(mesh.colors, mesh);
  require(mesh.material.empty() || mesh.material.size() == mesh.triangles.size(), "a material per triangle");
  require(mesh.face.empty() || mesh.face.size() == mesh.triangles.size(), "a face number per triangle");
  for (const std::uint32_t slot : mesh.material)
    require(slot < std::max<std::size_t>(part.materials.size(), 1), "material slots exist");
  for (const std::uint32_t material : part.materials) require(material < scene.materials.size(), "materials exist");
}

void require_one_line(const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    require(!line.empty() && line.find('\n') == std::string::npos, "a loss or warning is one line");
}

}  // namespace

void require_promises(const Scene& scene) {
  for (const Part& part : scene.parts) require_part(scene, part);
  for (const Instance& instance : instances(scene))
    require(std::all_of(instance.world.begin(), instance.world.end(), [](double x) { return !std::isnan(x); }),
            "transforms are numbers");
  require_one_line(scene.losses);
  require_one_line(scene.warnings);
}

}  // namespace papilla::fuzz
