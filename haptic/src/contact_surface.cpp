// SPDX-License-Identifier: MIT
#include "papilla/haptic/contact_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "papilla/core/error.hpp"
#include "relief_base.hpp"

namespace papilla {
namespace {

constexpr double k_skin_m = 2e-5;      // Closes gaps of 40 µm; a tenth of what a fingertip resolves as roughness edge.
constexpr double k_skin_share = 1e-3;  // Of the extent, for scenes smaller than 20 mm.
constexpr double k_least_skin_share = 2e-6;  // Of the extent: thirty times the rounding of single precision.
// Of the tolerance. Coplanar neighbours touch later than the face by ε²/2r, ε the distance to the common edge: the
// times must be finer than that, or the neighbour's tilted normal would be taken.
constexpr double k_close = 1e-7;
// Share of a triangle by which a way may miss it in crossings(), so that an edge is met from one side at least.
constexpr double k_edge = 1e-9;
constexpr double k_above = 1 - 1e-6;  // Cosine of less than 1.5 mrad off a triangle's normal.
constexpr int k_newton_steps = 40;
constexpr int k_march_steps = 512;
constexpr int k_bisections = 24;
constexpr std::size_t k_most_materials = 32767;
constexpr double k_first_piece = 0.12, k_piece_growth = 8;  // Of what is known around the start.

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

Vec3 point_of(const std::array<float, 3>& v) noexcept {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
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

/// Gives corners that are the same in place and relief one vertex, by a hash table of open addressing.
struct ContactSurface::Weld {
  LargeArray<Corner>& vertices;
  LargeArray<Relief>& reliefs;
  bool any_relief;
  std::vector<std::uint32_t> slots;

  Weld(std::size_t count, bool relief, LargeArray<Corner>& to, LargeArray<Relief>& to_reliefs)
      : vertices(to), reliefs(to_reliefs), any_relief(relief), slots(std::bit_ceil(2 * count + 16), k_nothing) {}

  std::uint32_t add(const Corner& corner, const Relief& relief) {
    std::array<float, 6> key = {corner[0], corner[1], corner[2], relief.u, relief.v, relief.shift};
    std::uint64_t hash = 0;
    for (float& value : key) {
      value += 0.0F;  // One zero.
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29;
    }
    if (2 * vertices.size() >= slots.size()) grow();
    for (std::size_t at = hash & (slots.size() - 1);; at = (at + 1) & (slots.size() - 1)) {
      const std::uint32_t known = slots[at];
      if (known == k_nothing) {
        slots[at] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back({key[0], key[1], key[2]});
        if (any_relief) reliefs.push_back({key[3], key[4], key[5]});
        hashes.push_back(hash);
        return slots[at];
      }
      if (hashes[known] == hash && vertices[known] == Corner{key[0], key[1], key[2]} &&
          (!any_relief || (reliefs[known].u == key[3] && reliefs[known].v == key[4] && reliefs[known].shift == key[5])))
        return known;
    }
  }

 private:
  std::vector<std::uint64_t> hashes;

  void grow() {
    slots.assign(2 * slots.size(), k_nothing);
    for (std::uint32_t v = 0; v < hashes.size(); ++v) {
      std::size_t at = hashes[v] & (slots.size() - 1);
      while (slots[at] != k_nothing) at = (at + 1) & (slots.size() - 1);
      slots[at] = v;
    }
  }
};

/// Nearest point of a triangle: barycentric weights of b and c, and what part of the triangle it lies on.
struct ContactSurface::Foot {
  Vec3 point;
  double v = 0, w = 0;
  enum class On { face, edge, corner } on = On::face;
  Vec3 edge;  ///< Direction, when on an edge; not normalised.
};

/// A moving probe at t, and where it stands to a triangle.
struct ContactSurface::Approach {
  double t = 0, distance = 0;
  Vec3 d;  ///< From the nearest point.
};

/// f_T and its gradient (not normalised).
struct ContactSurface::Clearance {
  double value = 0;
  double distance = 0;
  Vec3 gradient;
};

ContactSurface::ContactSurface(const ContactMesh& mesh, std::vector<ContactMaterial> materials,
                               std::vector<HeightField> heights, double probe_radius_m)
    : materials_(std::move(materials)), heights_(std::move(heights)), radius_(probe_radius_m) {
  check(mesh, materials_, heights_, radius_);
  const ReliefBase base = relief_base(mesh, materials_, heights_);

  const std::size_t n = mesh.triangles.size();
  std::vector<std::uint32_t> kept;
  kept.reserve(n);
  low_ = {1e300, 1e300, 1e300};
  high_ = {-1e300, -1e300, -1e300};
  for (std::size_t t = 0; t < n; ++t) {
    const Vec3* c = &base.corners[3 * t];
    const bool usable = is_finite(c[0]) && is_finite(c[1]) && is_finite(c[2]) &&
                        std::isfinite(norm(c[0]) + norm(c[1]) + norm(c[2])) &&
                        norm(cross(c[1] - c[0], c[2] - c[0])) > 0;
    if (!usable) continue;
    kept.push_back(static_cast<std::uint32_t>(t));
    for (int k = 0; k < 3; ++k) {
      low_ = {std::min(low_.x, c[k].x), std::min(low_.y, c[k].y), std::min(low_.z, c[k].z)};
      high_ = {std::max(high_.x, c[k].x), std::max(high_.y, c[k].y), std::max(high_.z, c[k].z)};
    }
  }
  skipped_ = n - kept.size();
  if (kept.empty()) throw InvalidInput("ContactSurface: no triangle with an area");
  origin_ = 0.5 * (low_ + high_);
  const double extent = norm(high_ - low_);
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
  bvh_ = Bvh(boxes);
  boxes = {};

  triangles_.reserve(kept.size());
  material_.reserve(kept.size());
  source_.reserve(kept.size());
  Weld weld(kept.size(), any_relief, vertices_, reliefs_);
  for (const std::uint32_t item : bvh_.take_leaf_order()) {
    const std::uint32_t t = kept[item];
    std::array<std::uint32_t, 3> named{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 uv = has_uv(t) && !mesh.corner_uv.empty() ? mesh.corner_uv[3 * t + k] : Vec2{};
      named[k] = weld.add(rounded(t, k),
                          {static_cast<float>(is_finite(uv) ? uv.x : 0), static_cast<float>(is_finite(uv) ? uv.y : 0),
                           static_cast<float>(base.shifts[3 * t + k])});
    }
    triangles_.push_back(named);
    material_.push_back(static_cast<std::uint16_t>(material_of(t) | (has_relief(t) ? k_relief_bit : 0U)));
    source_.push_back(t);
  }
  vertices_.shrink_to_fit();
  reliefs_.shrink_to_fit();
}

std::size_t ContactSurface::bytes() const noexcept {
  return triangles_.size() * (sizeof(triangles_[0]) + sizeof(material_[0]) + sizeof(source_[0])) +
         vertices_.size() * sizeof(Corner) + reliefs_.size() * sizeof(Relief) + bvh_.bytes();
}

ContactSurface::Corners ContactSurface::corners(std::uint32_t place) const noexcept {
  const auto& t = triangles_[place];
  return {point_of(vertices_[t[0]]), point_of(vertices_[t[1]]), point_of(vertices_[t[2]])};
}

/// The highest that the relief of a triangle can be above its base.
double ContactSurface::top_of(std::uint32_t place) const noexcept {
  if (!has_relief(place)) return 0;
  const auto& height = materials_[material_of(place)].height;
  const float lowest = std::min({relief(place, 0).shift, relief(place, 1).shift, relief(place, 2).shift});
  return std::max(0.0, (height ? heights_[*height].max_m() : 0.0) - static_cast<double>(lowest));
}

/// Ericson, Real-Time Collision Detection (2005), 5.1.5: by the Voronoi region that x lies in.
[[gnu::always_inline]] inline ContactSurface::Foot ContactSurface::foot(const Corners& t, Vec3 x) noexcept {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = x - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {t.a, 0, 0, Foot::On::corner, {}};
  const Vec3 bp = x - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {t.b, 1, 0, Foot::On::corner, {}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {t.a + v * ab, v, 0, Foot::On::edge, ab};
  }
  const Vec3 cp = x - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {t.c, 0, 1, Foot::On::corner, {}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {t.a + w * ac, 0, w, Foot::On::edge, ac};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {t.b + w * (t.c - t.b), 1 - w, w, Foot::On::edge, t.c - t.b};
  }
  const double scale = 1 / (va + vb + vc), v = vb * scale, w = vc * scale;
  return {t.a + v * ab + w * ac, v, w, Foot::On::face, {}};
}

/// ∇h = (∂h/∂v) ∇v + (∂h/∂w) ∇w with the gradients of the barycentric weights in the plane; zero on a needle.
Vec3 ContactSurface::in_plane(const Corners& t, double by_v, double by_w) noexcept {
  const Vec3 ab = t.b - t.a, ac = t.c - t.a;
  const double aa = dot(ab, ab), bb = dot(ac, ac), c = dot(ab, ac), det = aa * bb - c * c;
  if (!(det > 0)) return {};
  return (1 / det) * ((by_v * bb - by_w * c) * ab + (by_w * aa - by_v * c) * ac);
}

/// Height of the relief above the base at a foot, and its gradient within the triangle's plane.
double ContactSurface::relief_at(std::uint32_t place, const Corners& t, const Foot& foot,
                                 Vec3* gradient) const noexcept {
  const auto corner = [&](std::size_t k) {
    return Vec2{static_cast<double>(relief(place, k).u), static_cast<double>(relief(place, k).v)};
  };
  const auto shift = [&](std::size_t k) { return static_cast<double>(relief(place, k).shift); };
  const double s0 = shift(0), sv = shift(1) - s0, sw = shift(2) - s0;
  const Vec2 by_v = corner(1) - corner(0), by_w = corner(2) - corner(0);
  HeightSample sample;
  if (const auto& height = materials_[material_of(place)].height)
    sample = heights_[*height].sample(corner(0) + foot.v * by_v + foot.w * by_w);
  const double height = sample.height_m - (s0 + foot.v * sv + foot.w * sw);
  if (gradient == nullptr) return std::max(0.0, height);
  *gradient = {};
  if (height <= 0) return 0;
  *gradient = in_plane(t, dot(sample.gradient_m, by_v) - sv, dot(sample.gradient_m, by_w) - sw);
  return height;
}

ContactSurface::Clearance ContactSurface::clearance_of(std::uint32_t place, const Corners& t, Vec3 x) const noexcept {
  const Foot f = foot(t, x);
  const Vec3 d = x - f.point;
  Clearance result;
  result.distance = norm(d);
  const double contact = contact_radius_m();
  if (result.distance == 0) {
    result.gradient = normalized(cross(t.b - t.a, t.c - t.a));
    result.value = -contact;
    return result;
  }
  const Vec3 out = (1 / result.distance) * d;
  result.gradient = out;
  result.value = result.distance - contact;
  if (!has_relief(place)) return result;

  const Vec3 area = cross(t.b - t.a, t.c - t.a);
  double cosine = dot(area, out);
  if (cosine <= 0) return result;
  cosine = f.on == Foot::On::face ? 1 : std::min(1.0, cosine / norm(area));
  Vec3 slope;
  result.value -= cosine * relief_at(place, t, f, &slope);
  // Beside the triangle the foot moves along its edge only, or not at all. Right above the edge it moves both ways:
  // there a neighbour goes on.
  const bool above = f.on == Foot::On::face || cosine > k_above;
  if (f.on == Foot::On::edge && !above) slope = (dot(slope, f.edge) / dot(f.edge, f.edge)) * f.edge;
  if (f.on != Foot::On::corner || above) result.gradient = result.gradient - cosine * slope;
  return result;
}

/// How many texels of the relief a way over the triangle crosses.
double ContactSurface::texels_on(std::uint32_t place, const Corners& t, Vec3 way) const noexcept {
  const auto& height = materials_[material_of(place)].height;
  if (!height) return 0;
  const Vec3 ab = t.b - t.a, ac = t.c - t.a;
  const double aa = dot(ab, ab), bb = dot(ac, ac), c = dot(ab, ac), det = aa * bb - c * c;
  if (!(det > 0)) return 0;
  const double p = dot(way, ab), q = dot(way, ac), v = (p * bb - q * c) / det, w = (q * aa - p * c) / det;
  const auto along = [&](float Relief::*axis) {
    const double u0 = static_cast<double>(relief(place, 0).*axis);
    return v * (static_cast<double>(relief(place, 1).*axis) - u0) +
           w * (static_cast<double>(relief(place, 2).*axis) - u0);
  };
  const std::array<Vec2, 2> per_uv = heights_[*height].texels_per_uv();
  return norm(along(&Relief::u) * per_uv[0] + along(&Relief::v) * per_uv[1]);
}

/// The earlier of two hits; of those at the same place, usually the start, the deeper one: where triangles meet flat,
/// it is the one that x stands above.
bool ContactSurface::comes_before(const SweepHit& a, const SweepHit& b) noexcept {
  return a.t != b.t ? a.t < b.t : a.penetration_m > b.penetration_m;
}

[[gnu::always_inline]] inline void ContactSurface::look(const Corners& t, Vec3 from, Vec3 way, double at,
                                                        Approach& state) noexcept {
  const Vec3 x = from + at * way;
  state.t = at;
  state.d = x - foot(t, x).point;
  state.distance = norm(state.d);
}

/// Goes on from `state` to the first t up to t_max where from + t·way is within `radius` of the triangle. The distance
/// to a convex set is convex on a line, so Newton's steps from outside end at or before the contact: nothing is passed
/// over. @returns false when there is none.
bool ContactSurface::approach(const Corners& t, Vec3 from, Vec3 way, double radius, double t_max,
                              Approach& state) const noexcept {
  const double close = k_close * tolerance_m();
  for (int step = 0; step < k_newton_steps; ++step) {
    if (state.distance <= radius + close) return true;
    const double descent = -dot(state.d, way);
    if (descent <= 0) return false;
    const double way_there = (state.distance - radius) * state.distance;
    if (way_there > (t_max - state.t) * descent) return false;
    look(t, from, way, state.t + way_there / descent, state);
  }
  return true;
}

void ContactSurface::sweep_one(std::uint32_t place, Vec3 from, Vec3 way, double t_max,
                               std::optional<SweepHit>& best) const noexcept {
  if (best) t_max = best->t;
  if (has_relief(place))
    sweep_relief(place, from, way, t_max, best);
  else
    sweep_plain(place, from, way, t_max, best);
}

void ContactSurface::sweep_plain(std::uint32_t place, Vec3 from, Vec3 way, double t_max,
                                 std::optional<SweepHit>& best) const noexcept {
  const Corners t = corners(place);
  const double contact = contact_radius_m();
  Approach touch;
  look(t, from, way, 0, touch);
  if (!approach(t, from, way, contact, t_max, touch)) return;
  Vec3 normal = (1 / touch.distance) * touch.d;
  if (!(touch.distance > 0)) {
    normal = normalized(cross(t.b - t.a, t.c - t.a));
    if (dot(normal, way) > 0) normal = -normal;
  }
  if (dot(normal, way) >= 0) return;
  const SweepHit hit{touch.t, normal, contact - touch.distance, skin_, source_[place], material_of(place)};
  if (best && !comes_before(hit, *best)) return;
  if (approach(t, from, way, contact - tolerance_m(), 1, touch)) best = hit;
}

/// Steps over the relief, at most half a texel at a time while it is near, and bisects the step that goes in.
void ContactSurface::sweep_relief(std::uint32_t place, Vec3 from, Vec3 way, double t_max,
                                  std::optional<SweepHit>& best) const noexcept {
  const Corners t = corners(place);
  const double length = norm(way), contact = contact_radius_m(), top = top_of(place);
  Approach entry;
  look(t, from, way, 0, entry);
  if (!approach(t, from, way, contact + top, t_max, entry)) return;
  const double finest = std::max(0.5 / std::max(texels_on(place, t, way), 0.5), 1.0 / k_march_steps);

  // On a hollow every tangent goes in at once: half the tolerance lets the probe get on.
  const double level = -0.5 * tolerance_m();
  double outside = entry.t, at = entry.t, allowed = -tolerance_m();
  for (bool first = true;; first = false) {
    const Vec3 x = from + at * way;
    const Clearance now = clearance_of(place, t, x);
    // A probe that is too deep already may rise.
    if (now.value < allowed && (!first || dot(now.gradient, way) < 0)) break;
    allowed = std::min(-tolerance_m(), now.value);
    if (now.value >= level) outside = at;
    if (at >= t_max) return;
    // Above the highest point and leaving: the rest of the way is free.
    if (now.distance > contact + top && dot(x - foot(t, x).point, way) >= 0) return;
    // Not past the base either: behind it the clearance grows again.
    const double base = std::max(0.5 * now.distance, tolerance_m());
    at = std::min(t_max, at + std::min(std::max(finest, 0.5 * now.value / length), base / length));
  }
  for (int i = 0; i < k_bisections && at - outside > 1e-9; ++i) {
    const double middle = 0.5 * (outside + at);
    (clearance_of(place, t, from + middle * way).value >= level ? outside : at) = middle;
  }
  const Clearance there = clearance_of(place, t, from + outside * way);
  // The relief carries the skin on top of its height; along the normal that is less by the slope's cosine.
  const double slope = norm(there.gradient);
  const SweepHit hit{outside,        normalized(there.gradient), -there.value, slope > 1 ? skin_ / slope : skin_,
                     source_[place], material_of(place)};
  if (!best || comes_before(hit, *best)) best = hit;
}

/// The box that a probe sweeps, rounded outwards.
Box3f ContactSurface::way_box_of(Vec3 a, Vec3 b) const noexcept {
  const double size =
      std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  const double grow = contact_radius_m() + 2 * static_cast<double>(std::numeric_limits<float>::epsilon()) * size;
  const auto low = [grow](double x, double y) { return static_cast<float>(std::min(x, y) - grow); };
  const auto high = [grow](double x, double y) { return static_cast<float>(std::max(x, y) + grow); };
  Box3f box;
  box.low = {low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)};
  box.high = {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)};
  return box;
}

bool ContactSurface::beside(std::uint32_t place, const Box3f& box) const noexcept {
  const auto& t = triangles_[place];
  const Corner &a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
  bool apart = false;
  for (std::size_t i = 0; i < 3; ++i) {
    apart |= std::max(a[i], std::max(b[i], c[i])) < box.low[i];
    apart |= std::min(a[i], std::min(b[i], c[i])) > box.high[i];
  }
  return apart;
}

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to) const noexcept {
  const Vec3 start = from - origin_, way = to - from;
  std::optional<SweepHit> best;
  double t_max = 1;
  Box3f way_box = way_box_of(start, start + way);
  bvh_.along(start, way, contact_radius_m(), t_max, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    for (std::uint32_t place = begin; place < end; ++place) {
      if (!has_relief(place) && beside(place, way_box)) continue;
      sweep_one(place, start, way, 1, best);
    }
    if (best && best->t < t_max) {
      t_max = best->t;
      way_box = way_box_of(start, start + t_max * way);
    }
  });
  return best;
}

bool ContactSurface::gather(Vec3 centre, double radius_m, Neighbourhood& near) const noexcept {
  near.begin(centre - origin_, radius_m);
  bool fits = true;
  double radius = radius_m + contact_radius_m();
  bvh_.within(centre - origin_, radius, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    fits = fits && !near.full(end - begin);
    if (!fits) radius = 0;  // Ends the walk.
    for (std::uint32_t place = begin; place < end && fits; ++place) {
      const auto& t = triangles_[place];
      near.add(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]], static_cast<float>(top_of(place)), place);
    }
  });
  if (fits)
    near.finish();
  else
    near.clear();
  return fits;
}

/// The first hit before t_max among what was gathered; the whole way up to there must lie within its reach.
std::optional<SweepHit> ContactSurface::sweep_near(const Neighbourhood& near, Vec3 start, Vec3 way,
                                                   double t_max) const noexcept {
  Neighbourhood::Mask mask;
  near.near_way(start, t_max * way, contact_radius_m(), mask);
  std::optional<SweepHit> best;
  for (std::uint32_t i = 0; i < near.count(); ++i)
    if (mask[i] != 0) sweep_one(near.place(i), start, way, t_max, best);
  return best;
}

std::optional<SweepHit> ContactSurface::sweep(Vec3 from, Vec3 to, const Neighbourhood& near) const noexcept {
  const Vec3 way = to - from;
  const Vec3 start = from - origin_;
  const double length = norm(way), margin = near.margin(start);
  if (!(margin > 0)) return sweep(from, to);
  const double known = length > margin ? margin / length : 1;
  // Most ways end soon: in pieces that grow, what lies far ahead is seldom looked at.
  for (double t = std::min(known, k_first_piece * margin / length);; t = std::min(known, k_piece_growth * t)) {
    if (const auto hit = sweep_near(near, start, way, t)) return hit;
    if (t >= 1) return std::nullopt;
    if (t >= known) return sweep(from, to);
  }
}

template <class Accept>
std::optional<SurfacePoint> ContactSurface::nearest(Vec3 p, double radius, Accept&& accept) const noexcept {
  const Vec3 x = p - origin_;
  std::uint32_t found = k_nothing;
  Foot at;
  // The tree's boxes are grown by the relief, which only makes them visited earlier.
  double reach = radius;
  bvh_.within(x, reach, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    for (std::uint32_t place = begin; place < end; ++place) {
      if (!accept(material_of(place))) continue;
      const Foot f = foot(corners(place), x);
      const double distance = norm(x - f.point);
      if (distance > reach) continue;
      reach = distance;
      found = place;
      at = f;
    }
  });
  if (found == k_nothing) return std::nullopt;
  const Corners t = corners(found);
  SurfacePoint point;
  point.point = at.point + origin_;
  point.face_normal = normalized(cross(t.b - t.a, t.c - t.a));
  point.distance_m = reach;
  point.height_m = has_relief(found) ? relief_at(found, t, at, nullptr) : 0;
  point.on_border = at.on != Foot::On::face;
  point.triangle = source_[found];
  point.material = material_of(found);
  return point;
}

std::optional<SurfacePoint> ContactSurface::closest_point(Vec3 p, double radius_m) const noexcept {
  return nearest(p, radius_m, [](std::uint32_t) noexcept { return true; });
}

std::optional<SurfacePoint> ContactSurface::closest_point(Vec3 p, double radius_m,
                                                          std::uint32_t material) const noexcept {
  return nearest(p, radius_m, [material](std::uint32_t other) noexcept { return other == material; });
}

std::optional<StimulusSample> ContactSurface::stimulus(Vec3 p, double radius_m) const noexcept {
  std::uint32_t found = k_nothing;
  Foot at;
  double reach = radius_m;
  const Vec3 x = p - origin_;
  bvh_.within(x, reach, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    for (std::uint32_t place = begin; place < end; ++place) {
      if (!materials_[material_of(place)].stimulus) continue;
      const Foot f = foot(corners(place), x);
      const double distance = norm(x - f.point);
      if (distance > reach) continue;
      reach = distance;
      found = place;
      at = f;
    }
  });
  if (found == k_nothing) return std::nullopt;
  const Corners t = corners(found);
  const HeightField& field = heights_[*materials_[material_of(found)].stimulus];
  const auto uv = [&](std::size_t k) {
    return Vec2{static_cast<double>(relief(found, k).u), static_cast<double>(relief(found, k).v)};
  };
  const Vec2 by_v = uv(1) - uv(0), by_w = uv(2) - uv(0);
  const HeightSample height = field.sample(uv(0) + at.v * by_v + at.w * by_w);
  const Vec3 area = cross(t.b - t.a, t.c - t.a);
  const auto texels = field.texels_per_uv();
  const double texel_area =
      std::abs(cross(by_v.x * texels[0] + by_v.y * texels[1], by_w.x * texels[0] + by_w.y * texels[1]));
  StimulusSample sample;
  sample.point = at.point + origin_;
  sample.normal = normalized(area);
  sample.height_m = height.height_m;
  sample.grey = field.greys_per_m() * height.height_m;
  sample.slope = field.greys_per_m() * in_plane(t, dot(height.gradient_m, by_v), dot(height.gradient_m, by_w));
  sample.along_u = normalized(in_plane(t, by_v.x, by_w.x));
  sample.pixel_m = texel_area > 0 ? std::sqrt(norm(area) / texel_area) : 0;
  sample.material = material_of(found);
  return sample;
}

int ContactSurface::crossings(Vec3 from, Vec3 to) const noexcept {
  constexpr int k_most = 16;
  const Vec3 start = from - origin_, way = to - from;
  double places[k_most];
  int count = 0;
  double t_max = 1;
  bvh_.along(start, way, 0, t_max, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    for (std::uint32_t place = begin; place < end && count < k_most; ++place) {
      const Corners t = corners(place);
      const Vec3 ab = t.b - t.a, ac = t.c - t.a, p = cross(way, ac);
      const double det = dot(ab, p);
      if (det == 0) continue;
      const Vec3 s = start - t.a, q = cross(s, ab);
      const double u = dot(s, p) / det, v = dot(way, q) / det, at = dot(ac, q) / det;
      if (u < -k_edge || v < -k_edge || u + v > 1 + k_edge || at < 0 || at >= 1) continue;
      const bool known =
          std::any_of(places, places + count, [at](double other) noexcept { return std::abs(at - other) < k_edge; });
      if (!known) places[count++] = at;
    }
  });
  return count;
}

double ContactSurface::clearance(Vec3 x, double radius_m) const noexcept {
  const Vec3 y = x - origin_;
  double least = radius_m - contact_radius_m(), reach = radius_m;
  bvh_.within(y, reach, [&](std::uint32_t begin, std::uint32_t end) noexcept {
    for (std::uint32_t place = begin; place < end; ++place)
      least = std::min(least, clearance_of(place, corners(place), y).value);
    // Boxes hold the relief: what is farther than least + r + s from the box has more clearance than `least`.
    reach = std::min(reach, std::max(0.0, least + contact_radius_m()));
  });
  return least;
}

}  // namespace papilla
