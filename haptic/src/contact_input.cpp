// SPDX-License-Identifier: MIT
#include "contact_input.hpp"

#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_most_materials = 32767;

}  // namespace

void check_contact_input(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                         const std::vector<HeightField>& heights, const std::vector<ChannelField>& channels,
                         double radius) {
  const auto fail = [](const std::string& what) { throw InvalidInput("ContactSurface: " + what); };
  const std::size_t n = mesh.triangles.size();
  if (!(radius >= 0) || !std::isfinite(radius)) fail("the probe radius " + std::to_string(radius) + " is not >= 0");
  if (materials.empty()) fail("no material");
  if (materials.size() > k_most_materials) fail("more than 32767 materials");
  if (!mesh.material.empty() && mesh.material.size() != n) fail("material needs one entry per triangle");
  if (!mesh.corner_uv.empty() && mesh.corner_uv.size() != 3 * n) fail("corner_uv needs three entries per triangle");
  if (!mesh.corner_normals.empty() && mesh.corner_normals.size() != 3 * n)
    fail("corner_normals needs three entries per triangle");
  if (!mesh.vertex_uv.empty() && mesh.vertex_uv.size() != mesh.positions.size())
    fail("vertex_uv needs one entry per position");
  if (!mesh.vertex_normals.empty() && mesh.vertex_normals.size() != mesh.positions.size())
    fail("vertex_normals needs one entry per position");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const ContactMaterial& m = materials[i];
    for (const double value :
         {m.stiffness, m.damping, m.static_friction, m.dynamic_friction, m.stribeck_velocity, m.backing_stiffness})
      if (!(value >= 0) || !std::isfinite(value))
        fail("material " + std::to_string(i) + " has a number that is not >= 0");
    if (!std::isfinite(m.amplitude)) fail("material " + std::to_string(i) + " has an amplitude that is not finite");
    if (!(m.backing_depth_m >= 0)) fail("material " + std::to_string(i) + " has a backing at no depth");
    if (m.channels && *m.channels >= channels.size()) fail("material " + std::to_string(i) + " names missing maps");
    if (m.channels && !mesh.has_uv()) fail("material " + std::to_string(i) + " has maps but the mesh has no uv");
    if (m.stimulus && *m.stimulus >= heights.size())
      fail("material " + std::to_string(i) + " names a missing height field");
    if (m.stimulus && !mesh.has_uv()) fail("material " + std::to_string(i) + " has a stimulus but the mesh has no uv");
    if (m.height && *m.height >= heights.size())
      fail("material " + std::to_string(i) + " names a missing height field");
    if (m.height && !mesh.has_uv()) fail("material " + std::to_string(i) + " has a relief but the mesh has no uv");
  }
  for (std::size_t t = 0; t < n; ++t) {
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.positions.size()) fail("triangle " + std::to_string(t) + " names a missing vertex");
    if (!mesh.material.empty() && mesh.material[t] >= materials.size())
      fail("triangle " + std::to_string(t) + " names a missing material");
  }
}

}  // namespace papilla
