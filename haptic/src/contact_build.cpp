// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "relief_base.hpp"

namespace papilla {
namespace {

constexpr double k_skin_m = 2e-5;      // Closes gaps of 40 µm; a tenth of what a fingertip resolves as roughness edge.
constexpr double k_skin_share = 1e-3;  // Of the extent, for scenes smaller than 20 mm.
constexpr double k_least_skin_share = 2e-6;  // Of the extent: thirty times the rounding of single precision.
constexpr std::size_t k_most_materials = 32767;

void check(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
           const std::vector<HeightField>& heights, double radius) {
  const auto fail = [](const std::string& what) { throw InvalidInput("ContactSurface: " + what); };
  const std::size_t n = mesh.triangles.size();
  if (!(radius >= 0) || !std::isfinite(radius)) fail("the probe radius " + std::to_string(radius) + " is not >= 0");
  if (materials.empty()) fail("no material");
  if (materials.size() > k_most_materials) fail("more than 32767 materials");
  if (!mesh.material.empty() && mesh.material.size() != n) fail("material needs one entry per triangle");
  if (!mesh.corner_uv.empty() && mesh.corner_uv.size() != 3 * n) fail("corner_uv needs three entries per triangle");
  if (!mesh.corner_normals.empty() && mesh.corner_normals.size() != 3 * n)
    fail("corner_normals needs three entries per triangle");
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const ContactMaterial& m = materials[i];
    for (const double value : {m.stiffness, m.damping, m.static_friction, m.dynamic_friction, m.stribeck_velocity})
      if (!(value >= 0) || !std::isfinite(value))
        fail("material " + std::to_string(i) + " has a number that is not >= 0");
    if (!std::isfinite(m.amplitude)) fail("material " + std::to_string(i) + " has an amplitude that is not finite");
    if (m.stimulus && *m.stimulus >= heights.size())
      fail("material " + std::to_string(i) + " names a missing height field");
    if (m.stimulus && mesh.corner_uv.empty())
      fail("material " + std::to_string(i) + " has a stimulus but the mesh has no uv");
    if (m.height && *m.height >= heights.size())
      fail("material " + std::to_string(i) + " names a missing height field");
    if (m.height && mesh.corner_uv.empty())
      fail("material " + std::to_string(i) + " has a relief but the mesh has no uv");
  }
  for (std::size_t t = 0; t < n; ++t) {
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.positions.size()) fail("triangle " + std::to_string(t) + " names a missing vertex");
    if (!mesh.material.empty() && mesh.material[t] >= materials.size())
      fail("triangle " + std::to_string(t) + " names a missing material");
  }
}

/// A box of the float just below low − grow and just above high + grow.
Box3f box_of(const std::array<std::array<float, 3>, 3>& v, double grow) noexcept {
  Box3f box;
  for (std::size_t i = 0; i < 3; ++i) {
    const float low = std::min({v[0][i], v[1][i], v[2][i]}), high = std::max({v[0][i], v[1][i], v[2][i]});
    const float infinity = std::numeric_limits<float>::infinity();
    box.low[i] = grow > 0 ? std::nextafter(static_cast<float>(static_cast<double>(low) - grow), -infinity) : low;
    box.high[i] = grow > 0 ? std::nextafter(static_cast<float>(static_cast<double>(high) + grow), infinity) : high;
  }
  return box;
}

}  // namespace

/// Those of the mesh where they are on the face's side, else the face's.
std::array<ContactSurface::PackedNormal, 3> ContactSurface::corner_normals(const ContactMesh& mesh, std::size_t t) {
  const auto at = [&](std::size_t k) { return mesh.positions[mesh.triangles[t][k]]; };
  const Vec3 face = normalized(cross(at(1) - at(0), at(2) - at(0)));
  std::array<PackedNormal, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 given = mesh.corner_normals[3 * t + k];
    result[k] = packed(is_finite(given) && dot(given, face) > 0 ? given : face);
  }
  return result;
}

ContactSurface::ContactSurface(const ContactMesh& mesh, std::vector<ContactMaterial> materials,
                               std::vector<HeightField> heights, double probe_radius_m)
    : materials_(std::move(materials)), heights_(std::move(heights)), radius_(probe_radius_m) {
  check(mesh, materials_, heights_, radius_);
  const ReliefBase base = relief_base(mesh, materials_, heights_);

  const std::size_t n = mesh.triangles.size();
  std::vector<std::uint32_t> kept;
  kept.reserve(n);
  Bounds3 bounds;
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3* c = &base.corners[3 * t];
    const bool usable = is_finite(c[0]) && is_finite(c[1]) && is_finite(c[2]) &&
                        std::isfinite(norm(c[0]) + norm(c[1]) + norm(c[2])) &&
                        norm(cross(c[1] - c[0], c[2] - c[0])) > 0;
    if (!usable) continue;
    kept.push_back(static_cast<std::uint32_t>(t));
    for (int k = 0; k < 3; ++k) bounds.add(c[k]);
  }
  skipped_ = n - kept.size();
  if (kept.empty()) throw InvalidInput("ContactSurface: no triangle with an area");
  low_ = bounds.low;
  high_ = bounds.high;
  origin_ = bounds.middle();
  const double extent = bounds.diagonal();
  if (!(extent < 1e6)) throw InvalidInput("ContactSurface: the scene is larger than 1000 km");
  skin_ = std::max(std::min(k_skin_m, k_skin_share * extent), k_least_skin_share * extent);

  const auto material_of = [&](std::uint32_t t) { return mesh.material.empty() ? 0U : mesh.material[t]; };
  const auto has_relief = [&](std::uint32_t t) {
    const double* s = &base.shifts[3 * t];
    return s[0] < 0 || s[1] < 0 || s[2] < 0 || materials_[material_of(t)].height.has_value();
  };
  const auto has_uv = [&](std::uint32_t t) { return has_relief(t) || materials_[material_of(t)].stimulus.has_value(); };
  const auto highest = [&](std::uint32_t t) {
    const double* s = &base.shifts[3 * t];
    const auto& height = materials_[material_of(t)].height;
    return std::max(0.0, (height ? heights_[*height].max_m() : 0.0) - std::min({s[0], s[1], s[2]}));
  };
  const auto rounded = [&](std::uint32_t t, std::size_t k) {
    const Vec3 p = base.corners[3 * t + k] - origin_;
    return Corner{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  std::vector<Box3f> boxes(kept.size());
  bool any_relief = false;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const double tall = highest(kept[i]);
    tallest_ = std::max(tallest_, tall);
    any_relief = any_relief || has_uv(kept[i]);
    boxes[i] = box_of({rounded(kept[i], 0), rounded(kept[i], 1), rounded(kept[i], 2)}, tall);
  }
  const auto vertex = [&](std::uint32_t item, std::size_t k) {
    const std::uint32_t t = kept[item];
    const Vec2 uv = has_uv(t) && !mesh.corner_uv.empty() ? mesh.corner_uv[3 * t + k] : Vec2{};
    return TriangleClusters::Vertex{
        rounded(t, k),
        {static_cast<float>(is_finite(uv) ? uv.x : 0), static_cast<float>(is_finite(uv) ? uv.y : 0),
         static_cast<float>(base.shifts[3 * t + k])}};
  };
  clusters_ = TriangleClusters(boxes, vertex, any_relief);

  material_.reserve(kept.size());
  source_.reserve(kept.size());
  const bool any_shading = !mesh.corner_normals.empty() &&
                           std::any_of(materials_.begin(), materials_.end(), [](const auto& m) { return m.shading; });
  if (any_shading) normals_.reserve(kept.size());
  for (const std::uint32_t item : clusters_.take_order()) {
    const std::uint32_t t = kept[item];
    material_.push_back(static_cast<std::uint16_t>(material_of(t) | (has_relief(t) ? k_relief_bit : 0U)));
    source_.push_back(t);
    if (any_shading) normals_.push_back(corner_normals(mesh, t));
  }
}

}  // namespace papilla
