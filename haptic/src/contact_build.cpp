// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "contact_input.hpp"
#include "contact_triangles.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "relief_base.hpp"

namespace papilla {
namespace {

constexpr double k_skin_m = 2e-5;            // Closes gaps of 40 µm; a tenth of the edge that a fingertip resolves.
constexpr double k_skin_share = 1e-3;        // Of the extent, for scenes smaller than 20 mm.
constexpr double k_least_skin_share = 2e-6;  // Of the extent: thirty times the rounding of single precision.

/// The box of three vertices grown by `grow`, rounded outwards to floats.
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

/// The corner normals of the mesh; the face normal where one is not on the face's side.
std::array<ContactTriangles::PackedNormal, 3> ContactTriangles::packed_corner_normals(const ContactMesh& mesh,
                                                                                      std::size_t t) {
  const Vec3 face = normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  std::array<PackedNormal, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 given = mesh.normal(t, k);
    result[k] = packed(is_finite(given) && dot(given, face) > 0 ? given : face);
  }
  return result;
}

ContactTriangles::ContactTriangles(const ContactMesh& mesh, std::vector<ContactMaterial> materials,
                                   std::vector<HeightField> heights, double probe_radius_m,
                                   std::vector<ChannelField> channels)
    : materials_(std::move(materials)),
      heights_(std::move(heights)),
      channels_(std::move(channels)),
      radius_(probe_radius_m) {
  check_contact_input(mesh, materials_, heights_, channels_, radius_);
  const ReliefBase base = make_relief_base(mesh, materials_, heights_);

  const std::size_t n = mesh.triangles.size();
  const auto corners = [&](std::size_t t) {
    return std::array<Vec3, 3>{base.corner(t, 0), base.corner(t, 1), base.corner(t, 2)};
  };
  const auto is_usable = [](const std::array<Vec3, 3>& c) {
    return std::isfinite(norm(c[0]) + norm(c[1]) + norm(c[2])) && norm(cross(c[1] - c[0], c[2] - c[0])) > 0;
  };
  Bounds3 bounds;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < n; ++t) {
    const std::array<Vec3, 3> c = corners(t);
    if (!is_usable(c)) continue;
    ++kept;
    for (const Vec3& corner : c) bounds.add(corner);
  }
  skipped_ = n - kept;
  if (kept == 0) throw InvalidInput("ContactSurface: no triangle with an area");
  low_ = bounds.low;
  high_ = bounds.high;
  origin_ = bounds.middle();
  const double extent = bounds.diagonal();
  if (!(extent < 1e6)) throw InvalidInput("ContactSurface: the scene is larger than 1000 km");
  if (!ContactSurface::is_valid_position(low_) || !ContactSurface::is_valid_position(high_))
    throw InvalidInput("ContactSurface: the scene lies farther than 1000 km from its origin");
  skin_ = std::max(std::min(k_skin_m, k_skin_share * extent), k_least_skin_share * extent);

  const auto has_relief = [&](std::uint32_t t) {
    return base.lowest_shift(t) < 0 || materials_[mesh.material_of(t)].height.has_value();
  };
  const auto has_uv = [&](std::uint32_t t) {
    const ContactMaterial& m = materials_[mesh.material_of(t)];
    return has_relief(t) || m.stimulus.has_value() || m.channels.has_value();
  };
  const auto highest = [&](std::uint32_t t) {
    const auto& height = materials_[mesh.material_of(t)].height;
    return std::max(0.0, (height ? heights_[*height].max_m() : 0.0) - static_cast<double>(base.lowest_shift(t)));
  };
  const auto rounded = [&](Vec3 corner) {
    const Vec3 p = corner - origin_;
    return Corner{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  std::vector<BoxedItem> boxes;
  boxes.reserve(kept);
  bool any_relief = false;
  for (std::uint32_t t = 0; t < n; ++t) {
    const std::array<Vec3, 3> c = corners(t);
    if (!is_usable(c)) continue;
    const double tall = highest(t);
    tallest_ = std::max(tallest_, tall);
    any_relief = any_relief || has_uv(t);
    boxes.push_back({box_of({rounded(c[0]), rounded(c[1]), rounded(c[2])}, tall), t});
  }
  const auto vertices = [&](std::uint32_t t) {
    const bool with_uv = mesh.has_uv() && has_uv(t);
    std::array<TriangleClusters::Vertex, 3> result;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec2 uv = with_uv ? mesh.uv(t, k) : Vec2{};
      if (!is_finite(uv)) uv = {};
      result[k] = {rounded(base.corner(t, k)), {static_cast<float>(uv.x), static_cast<float>(uv.y), base.shift(t, k)}};
    }
    return result;
  };
  clusters_ = TriangleClusters(std::move(boxes), vertices, any_relief);
  source_ = clusters_.take_order();

  material_.reserve(kept);
  for (const std::uint32_t t : source_)
    material_.push_back(static_cast<std::uint16_t>(mesh.material_of(t) | (has_relief(t) ? k_relief_bit : 0U)));
  if (tallest_ > 0) {
    continue_relief(mesh);
    find_arches();
  }
  if (!mesh.has_normals() ||
      std::none_of(materials_.begin(), materials_.end(), [](const auto& m) { return m.shading; }))
    return;
  normals_.reserve(kept);
  for (const std::uint32_t t : source_) normals_.push_back(packed_corner_normals(mesh, t));
}

}  // namespace papilla
