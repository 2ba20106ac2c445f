// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include "contact_input.hpp"
#include "contact_triangles.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_skin_m = 2e-5;            // Closes gaps of 40 µm; a tenth of the edge that a fingertip resolves.
constexpr double k_skin_share = 1e-3;        // Of the extent, for scenes smaller than 20 mm.
constexpr double k_least_skin_share = 2e-6;  // Of the extent: thirty times the rounding of single precision.
constexpr int k_shortenings = 8;  // Halvings of the offset before a vertex that inverts triangles keeps its place.
constexpr double k_least_cosine = 0.3;  // A face that tilts by more than 72 degrees counts as inverted.
constexpr double k_least_miter = 0.5;   // Sharp corners move at most twice the height.

/// The mesh moved inwards to the lowest height of each material's relief. A mesh without relief needs no memory.
class ReliefBase {
 public:
  explicit ReliefBase(const ContactMesh& mesh) noexcept : mesh_(&mesh) {}

  /// Where a vertex is moved, and by how much along its normal, ≤ 0.
  struct Move {
    std::array<float, 3> way{};
    float shift = 0;
  };
  /// @param place for each vertex the index of its move.
  void set(std::vector<std::uint32_t> place, std::vector<Move> moves) {
    place_ = std::move(place);
    moves_ = std::move(moves);
  }

  Vec3 corner(std::size_t t, std::size_t k) const {
    const Vec3 p = mesh_->corner(t, k);
    if (moves_.empty()) return p;
    const auto& [x, y, z] = moves_[place_[mesh_->triangles[t][k]]].way;
    return p + Vec3{double{x}, double{y}, double{z}};
  }
  float shift(std::size_t t, std::size_t k) const {
    return moves_.empty() ? 0 : moves_[place_[mesh_->triangles[t][k]]].shift;
  }
  float lowest_shift(std::size_t t) const { return std::min({shift(t, 0), shift(t, 1), shift(t, 2)}); }

 private:
  const ContactMesh* mesh_;
  std::vector<std::uint32_t> place_;
  std::vector<Move> moves_;
};

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

/// For each vertex the index of its position, the same for vertices that coincide; by a hash table with linear probing.
std::vector<std::uint32_t> places_of(const std::vector<Vec3>& positions, std::size_t& count) {
  constexpr std::uint32_t k_free = 0xffffffffU;
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // −0 becomes +0.
  const auto same = [&](Vec3 a, Vec3 b) {
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
  };
  std::vector<std::uint32_t> place(positions.size()), table(std::bit_ceil(2 * positions.size() + 1), k_free);
  count = 0;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const Vec3 p = positions[i];
    std::uint64_t hash = (bits(p.x) * 0x9E3779B97F4A7C15U ^ bits(p.y)) * 0xC2B2AE3D27D4EB4FU ^ bits(p.z);
    hash = (hash ^ hash >> 32) * 0x9E3779B97F4A7C15U;
    std::size_t slot = (hash ^ hash >> 32) & (table.size() - 1);
    while (table[slot] != k_free && !same(positions[table[slot]], p)) slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == k_free) {
      table[slot] = i;
      place[i] = static_cast<std::uint32_t>(count++);
    } else {
      place[i] = place[table[slot]];
    }
  }
  return place;
}

/// Angles of a triangle at its corners; a right angle where an edge has no length.
std::array<double, 3> angles_of(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 u = normalized(b - a), v = normalized(c - b), w = normalized(a - c);
  const auto between = [](Vec3 from, Vec3 to) { return std::acos(std::clamp(-dot(from, to), -1.0, 1.0)); };
  return {between(w, u), between(u, v), between(v, w)};
}

/// Vertices at the same position move together, by the lowest height of the materials that meet there, along the mean
/// of their normals weighted by angle (corner normals where given, else face normals), lengthened at sharp edges so
/// that faces move by the full height. The offset is shortened where a triangle would be inverted. Cost: linear.
ReliefBase relief_base(const ContactMesh& mesh, const std::vector<ContactMaterial>& materials,
                       const std::vector<HeightField>& heights) {
  const std::size_t n = mesh.triangles.size();
  std::vector<double> lowest(materials.size(), 0.0);
  for (std::size_t m = 0; m < materials.size(); ++m)
    if (const auto& height = materials[m].height) lowest[m] = std::min(0.0, heights[*height].min_m());
  ReliefBase base(mesh);
  bool moves = false;
  for (std::size_t t = 0; t < n && !moves; ++t) moves = lowest[mesh.material_of(t)] < 0;
  if (!moves) return base;

  struct Mean {
    Vec3 normal, faces;  ///< Sums over the triangles, weighted by angle.
    double weight = 0, shift = 0;
  };
  std::size_t count = 0;
  std::vector<std::uint32_t> place = places_of(mesh.positions, count);
  std::vector<Mean> means(count);
  for (std::size_t t = 0; t < n; ++t) {
    const std::array<Vec3, 3> at = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    const Vec3 face = face_normal(at[0], at[1], at[2]);
    const std::array<double, 3> angles = angles_of(at[0], at[1], at[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      Mean& mean = means[place[mesh.triangles[t][k]]];
      const Vec3 given = mesh.has_normals() ? mesh.normal(t, k) : face;
      const Vec3 weighted = angles[k] * face;
      mean.normal = mean.normal + (is_finite(given) && dot(given, face) > 0 ? angles[k] * normalized(given) : weighted);
      mean.faces = mean.faces + weighted;
      mean.weight += angles[k];
      mean.shift = std::min(mean.shift, lowest[mesh.material_of(t)]);
    }
  }
  for (Mean& mean : means) {
    mean.normal = normalized(mean.normal);
    if (mean.weight > 0)
      mean.normal = (1 / std::clamp(dot(mean.faces, mean.normal) / mean.weight, k_least_miter, 1.0)) * mean.normal;
  }

  const auto moved = [&](std::size_t t, std::size_t k) {
    const Mean& mean = means[place[mesh.triangles[t][k]]];
    return mesh.corner(t, k) + mean.shift * mean.normal;
  };
  for (int round = 0; round <= k_shortenings; ++round) {
    std::vector<std::uint32_t> inverted;
    for (std::size_t t = 0; t < n; ++t) {
      const Vec3 before = face_normal(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
      if (before == Vec3{} || dot(before, face_normal(moved(t, 0), moved(t, 1), moved(t, 2))) >= k_least_cosine)
        continue;
      for (const std::uint32_t v : mesh.triangles[t]) inverted.push_back(place[v]);
    }
    if (inverted.empty()) break;
    std::sort(inverted.begin(), inverted.end());
    inverted.erase(std::unique(inverted.begin(), inverted.end()), inverted.end());
    for (const std::uint32_t p : inverted) means[p].shift = round == k_shortenings ? 0 : 0.5 * means[p].shift;
  }
  std::vector<ReliefBase::Move> vertex_moves;
  vertex_moves.reserve(count);
  for (const Mean& mean : means) {
    const Vec3 way = mean.shift * mean.normal;
    vertex_moves.push_back({{static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z)},
                            static_cast<float>(mean.shift)});
  }
  base.set(std::move(place), std::move(vertex_moves));
  return base;
}

}  // namespace

/// The corner normals of the mesh; the face normal where one is not on the face's side.
std::array<ContactTriangles::PackedNormal, 3> ContactTriangles::packed_corner_normals(const ContactMesh& mesh,
                                                                                      std::size_t t) {
  const Vec3 face = face_normal(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
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
  const ReliefBase base = relief_base(mesh, materials_, heights_);

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
  if (!mesh.has_normals() ||
      std::none_of(materials_.begin(), materials_.end(), [](const auto& m) { return m.shading; }))
    return;
  normals_.reserve(kept);
  for (const std::uint32_t t : source_) normals_.push_back(packed_corner_normals(mesh, t));
}

}  // namespace papilla
