// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "contact_triangles.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_skin_m = 2e-5;            // Closes gaps of 40 µm; a tenth of the edge that a fingertip resolves.
constexpr double k_skin_share = 1e-3;        // Of the extent, for scenes smaller than 20 mm.
constexpr double k_least_skin_share = 2e-6;  // Of the extent: thirty times the rounding of single precision.
constexpr std::size_t k_most_materials = 32767;
constexpr int k_shortenings = 8;  // Halvings of the offset before a vertex that inverts triangles keeps its place.
constexpr double k_least_cosine = 0.3;  // A face that tilts by more than 72 degrees counts as inverted.
constexpr double k_least_miter = 0.5;   // Sharp corners move at most twice the height.

/// The mesh moved inwards to the lowest height of each material's relief.
struct ReliefBase {
  std::vector<Vec3> corners;   ///< Three per triangle.
  std::vector<double> shifts;  ///< Three per triangle: offset of the corner along its vertex normal, ≤ 0.
};

void check_input(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                 const std::vector<HeightField>& heights, const std::vector<ChannelField>& channels, double radius) {
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
    for (const double value :
         {m.stiffness, m.damping, m.static_friction, m.dynamic_friction, m.stribeck_velocity, m.backing_stiffness})
      if (!(value >= 0) || !std::isfinite(value))
        fail("material " + std::to_string(i) + " has a number that is not >= 0");
    if (!std::isfinite(m.amplitude)) fail("material " + std::to_string(i) + " has an amplitude that is not finite");
    if (!(m.backing_depth_m >= 0)) fail("material " + std::to_string(i) + " has a backing at no depth");
    if (m.channels && *m.channels >= channels.size()) fail("material " + std::to_string(i) + " names missing maps");
    if (m.channels && mesh.corner_uv.empty())
      fail("material " + std::to_string(i) + " has maps but the mesh has no uv");
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

Vec3 face_normal(Vec3 a, Vec3 b, Vec3 c) { return normalized(cross(b - a, c - a)); }

double angle_at(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = normalized(b - a), v = normalized(c - a);
  return std::acos(std::clamp(dot(u, v), -1.0, 1.0));
}

/// For each vertex the index of its position, the same for vertices that coincide.
std::vector<std::uint32_t> places_of(const std::vector<Vec3>& positions, std::size_t& count) {
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return positions[a] < positions[b]; });
  count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && !(positions[order[i]] == positions[order[i - 1]])) ++count;
    place[order[i]] = static_cast<std::uint32_t>(count);
  }
  if (!order.empty()) ++count;
  return place;
}

/// Vertices at the same position move together, by the lowest height of the materials that meet there, along the mean
/// of their normals weighted by angle (corner normals where given, else face normals), lengthened at sharp edges so
/// that faces move by the full height. The offset is shortened where a triangle would be inverted. Cost: a sort of the
/// vertices.
ReliefBase relief_base(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                       const std::vector<HeightField>& heights) {
  const std::size_t n = mesh.triangles.size();
  const auto corner = [&](std::size_t t, std::size_t k) { return mesh.positions[mesh.triangles[t][k]]; };
  const auto lowest = [&](std::size_t t) {
    const auto& height = materials[mesh.material.empty() ? 0 : mesh.material[t]].height;
    return height ? std::min(0.0, heights[*height].min_m()) : 0.0;
  };
  ReliefBase base;
  base.corners.resize(3 * n);
  base.shifts.assign(3 * n, 0.0);
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) base.corners[3 * t + k] = corner(t, k);
  bool moves = false;
  for (std::size_t t = 0; t < n && !moves; ++t) moves = lowest(t) < 0;
  if (!moves) return base;

  std::size_t count = 0;
  const std::vector<std::uint32_t> place = places_of(mesh.positions, count);
  std::vector<Vec3> normal(count);
  std::vector<double> shift(count, 0.0), cosines(count, 0.0), weights(count, 0.0);
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3 face = face_normal(corner(t, 0), corner(t, 1), corner(t, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = place[mesh.triangles[t][k]];
      const double angle = angle_at(corner(t, k), corner(t, (k + 1) % 3), corner(t, (k + 2) % 3));
      const Vec3 given = mesh.corner_normals.empty() ? face : mesh.corner_normals[3 * t + k];
      normal[p] = normal[p] + angle * (is_finite(given) && dot(given, face) > 0 ? normalized(given) : face);
      shift[p] = std::min(shift[p], lowest(t));
    }
  }
  for (Vec3& v : normal) v = normalized(v);
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3 face = face_normal(corner(t, 0), corner(t, 1), corner(t, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t p = place[mesh.triangles[t][k]];
      const double angle = angle_at(corner(t, k), corner(t, (k + 1) % 3), corner(t, (k + 2) % 3));
      cosines[p] += angle * dot(face, normal[p]);
      weights[p] += angle;
    }
  }
  for (std::size_t p = 0; p < count; ++p)
    if (weights[p] > 0) normal[p] = (1 / std::clamp(cosines[p] / weights[p], k_least_miter, 1.0)) * normal[p];

  const auto moved = [&](std::size_t t, std::size_t k) {
    const std::uint32_t p = place[mesh.triangles[t][k]];
    return corner(t, k) + shift[p] * normal[p];
  };
  for (int round = 0; round <= k_shortenings; ++round) {
    std::vector<std::uint32_t> inverted;
    for (std::size_t t = 0; t < n; ++t) {
      const Vec3 before = face_normal(corner(t, 0), corner(t, 1), corner(t, 2));
      if (before == Vec3{} || dot(before, face_normal(moved(t, 0), moved(t, 1), moved(t, 2))) >= k_least_cosine)
        continue;
      for (const std::uint32_t v : mesh.triangles[t]) inverted.push_back(place[v]);
    }
    if (inverted.empty()) break;
    std::sort(inverted.begin(), inverted.end());
    inverted.erase(std::unique(inverted.begin(), inverted.end()), inverted.end());
    for (const std::uint32_t p : inverted) shift[p] = round == k_shortenings ? 0 : 0.5 * shift[p];
  }
  for (std::size_t t = 0; t < n; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      base.corners[3 * t + k] = moved(t, k);
      base.shifts[3 * t + k] = shift[place[mesh.triangles[t][k]]];
    }
  return base;
}

}  // namespace

/// The corner normals of the mesh; the face normal where one is not on the face's side.
std::array<ContactTriangles::PackedNormal, 3> ContactTriangles::packed_corner_normals(const ContactMesh& mesh,
                                                                                      std::size_t t) {
  const auto at = [&](std::size_t k) { return mesh.positions[mesh.triangles[t][k]]; };
  const Vec3 face = normalized(cross(at(1) - at(0), at(2) - at(0)));
  std::array<PackedNormal, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 given = mesh.corner_normals[3 * t + k];
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
  check_input(mesh, materials_, heights_, channels_, radius_);
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
  if (!ContactSurface::is_valid_position(low_) || !ContactSurface::is_valid_position(high_))
    throw InvalidInput("ContactSurface: the scene lies farther than 1000 km from its origin");
  skin_ = std::max(std::min(k_skin_m, k_skin_share * extent), k_least_skin_share * extent);

  const auto material_of = [&](std::uint32_t t) { return mesh.material.empty() ? 0U : mesh.material[t]; };
  const auto has_relief = [&](std::uint32_t t) {
    const double* s = &base.shifts[3 * t];
    return s[0] < 0 || s[1] < 0 || s[2] < 0 || materials_[material_of(t)].height.has_value();
  };
  const auto has_uv = [&](std::uint32_t t) {
    const ContactMaterial& m = materials_[material_of(t)];
    return has_relief(t) || m.stimulus.has_value() || m.channels.has_value();
  };
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
    if (any_shading) normals_.push_back(packed_corner_normals(mesh, t));
  }
}

}  // namespace papilla
