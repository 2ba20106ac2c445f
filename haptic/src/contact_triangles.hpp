// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "neighbourhood.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "triangle_clusters.hpp"

namespace papilla {

/// The constants at a place of a surface.
struct LocalConstants {
  ContactConstants constants;
  Vec3 stiffness_slope;  ///< Gradient of the stiffness along the surface, N/m per metre.
};

/// What ContactSurface holds and what the proxy sweeps against. Triangles are named by their place in the clusters.
class ContactTriangles {
 public:
  static constexpr std::uint32_t k_no_place = 0xffffffffU;
  /// A triangle relative to origin().
  struct Corners {
    Vec3 a, b, c;

    std::array<Vec3, 3> all() const noexcept { return {a, b, c}; }
  };
  /// Closest point of a triangle.
  struct Foot {
    Vec3 point;
    double v = 0, w = 0;  ///< Barycentric weights of b and c.
    enum class On { face, edge, corner } on = On::face;
    Vec3 edge;  ///< Direction of the edge, when on one; not normalised.
  };
  /// The state of an advancing probe at t relative to one triangle.
  struct Approach {
    double t = 0, distance = 0;
    Vec3 d;              ///< From the closest point to the probe.
    bool above = false;  ///< The closest point is inside the face.
  };
  /// f_T and its gradient.
  struct Clearance {
    double value = 0;
    double distance = 0;
    Vec3 d;           ///< From the closest point to the probe.
    double lift = 0;  ///< Height of the relief there; its upper bound where the triangle is seen from behind.
    Vec3 gradient;    ///< Not normalised.
  };
  /// A triangle with everything that is needed to evaluate its clearance at many points.
  struct Face {
    Corners t;
    Vec3 ab, ac, normal;                                      ///< The normal is zero for a needle.
    double ab_ab = 0, ab_ac = 0, ac_ac = 0, inverse_det = 0;  ///< Gram matrix of the edges; 1/det is 0 for a needle.
    bool has_relief = false;
    const HeightField* height = nullptr;
    Vec2 texel, texel_v, texel_w;                ///< Texel coordinates at a, and their derivatives by v and w.
    double shift = 0, shift_v = 0, shift_w = 0;  ///< The same of the base's offset.
    double top = 0;                              ///< Upper bound of the relief above the base.
    double steepest = 0;                         ///< Upper bound of its slope.

    /// Weights of b and c of the vector in the triangle's plane whose products with ab and ac are given; zero for a
    /// needle.
    Vec2 weights_by(Vec2 products) const noexcept {
      return inverse_det * Vec2{products.x * ac_ac - products.y * ab_ac, products.y * ab_ab - products.x * ab_ac};
    }
    Vec2 weights_of(Vec3 way) const noexcept { return weights_by({dot(way, ab), dot(way, ac)}); }
    Vec3 vector_of(Vec2 weights) const noexcept { return weights.x * ab + weights.y * ac; }
    /// ∇h = (∂h/∂v) ∇v + (∂h/∂w) ∇w with the gradients of the barycentric weights in the plane; zero for a needle.
    Vec3 in_plane(double by_v, double by_w) const noexcept { return vector_of(weights_by({by_v, by_w})); }
  };
  /// Height of the relief above the base.
  struct ReliefSample {
    double height = 0;
    Vec2 slope;        ///< Weights of b and c of its gradient ∇h in the triangle's plane.
    double steep = 0;  ///< |∇h|².
  };
  /// Where a triangle counts; see contact_room.cpp.
  struct Room {
    bool ends = false;             ///< Else it is everywhere.
    double tilt = 0;               ///< Tangent of the largest angle to the triangles around.
    std::array<Vec3, 3> out{};     ///< Across edge k, from corner k to the next.
    std::array<double, 3> end{};   ///< out · x of a place on the edge.
    std::array<Vec3, 3> beyond{};  ///< Away from the edge in the plane of the triangle behind it.
  };
  /// A face with relief, and its clearance where a sweep asked for it last.
  struct KnownFace {
    std::uint32_t place = k_no_place;  ///< In the clusters.
    Face face{};
    Room room{};
    Vec3 x{std::numeric_limits<double>::quiet_NaN(), 0, 0};  ///< Relative to origin().
    Clearance clearance{};
  };
  /// The faces that a probe swept last, from sweep to sweep: most begin where another ended.
  class KnownFaces {
   public:
    /// The entry of a place; it has another face, or none, when that was not swept lately.
    KnownFace& of(std::uint32_t place) noexcept { return faces_[place % faces_.size()]; }
    /// Needed before use with another surface.
    void clear() noexcept { *this = {}; }

    std::uint32_t touched = k_no_place;  ///< What a sweep met last: most often the next one does, too.

   private:
    std::array<KnownFace, 64> faces_;
  };
  /// A candidate for the place where the proxy comes to rest.
  struct Rest {
    Vec3 place;
    Vec3 off;  ///< Unit direction in which the surface ends there; zero where it continues on all sides.
    std::uint32_t material = 0;
    std::uint32_t triangle = 0;  ///< Its place in the clusters.
  };

  /// As ContactSurface's.
  ContactTriangles(const ContactMesh& mesh, std::vector<ContactMaterial> materials, std::vector<HeightField> heights,
                   double probe_radius_m, std::vector<ChannelField> channels = {});

  std::optional<SweepHit> sweep(Vec3 from, Vec3 to) const noexcept;

  /// Collects the blocks of triangles that a probe can touch within `radius_m` of `centre`.
  /// @returns false, with an empty neighbourhood, when they don't fit.
  bool gather(Vec3 centre, double radius_m, Neighbourhood& near) const noexcept;

  /// How far a probe at `from` may go in any direction inside the gathered ball; negative when it is outside.
  double margin(Vec3 from, const Neighbourhood& near) const noexcept { return near.margin(from - origin_); }

  /// The same hit, found in the neighbourhood, and in the tree where the segment leaves the gathered ball. The same
  /// bits on plain triangles; within the tolerance on relief, whose steps depend on where the segment ends and on what
  /// is known.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to, Neighbourhood& near, KnownFaces& known) const noexcept;

  /// The same, searched only from t = `seen`, before which there is no contact, to the end of the gathered ball.
  /// Without a hit `seen` becomes the end of the search, 1 at the end of the segment; it stays when from + seen·way is
  /// outside the ball.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to, Neighbourhood& near, KnownFaces& known,
                                double& seen) const noexcept;

  /// Where a probe drawn to `goal` from the side of `normal` would rest if the closest of the gathered triangles were
  /// the only one. Nothing with relief, and when no triangle allows a place within `radius_m` of the goal.
  std::optional<Rest> rest_candidate(Vec3 goal, double radius_m, Vec3 normal, Neighbourhood& near) const noexcept;

  Vec3 shaded_normal(Vec3 proxy, Vec3 normal) const noexcept;

  const ContactMaterial& material(std::uint32_t index) const noexcept { return materials_[index]; }
  ContactMaterial& material(std::uint32_t index) noexcept { return materials_[index]; }
  std::size_t material_count() const noexcept { return materials_.size(); }
  const ChannelField& channels(std::uint32_t index) const noexcept { return channels_[index]; }
  /// What the material, or its maps, say at the point of the triangle that is closest to x.
  LocalConstants constants_at(std::uint32_t place, Vec3 x) const noexcept;
  const HeightField& height(std::uint32_t index) const noexcept { return heights_[index]; }
  const TriangleClusters& clusters() const noexcept { return clusters_; }
  std::size_t skipped() const noexcept { return skipped_; }
  double probe_radius_m() const noexcept { return radius_; }
  double skin_m() const noexcept { return skin_; }
  double contact_radius_m() const noexcept { return radius_ + skin_; }
  double tolerance_m() const noexcept { return skin_ / 16; }
  double tallest_relief_m() const noexcept { return tallest_; }
  Vec3 origin() const noexcept { return origin_; }
  Vec3 low() const noexcept { return low_; }
  Vec3 high() const noexcept { return high_; }
  std::size_t bytes() const noexcept;

  bool has_relief(std::uint32_t place) const noexcept { return (packed_material(place) & k_relief_bit) != 0; }
  std::uint32_t material_of(std::uint32_t place) const noexcept {
    return packed_material(place) & ~unsigned{k_relief_bit};
  }
  std::uint32_t source_of(std::uint32_t place) const noexcept { return source_[clusters_.slot(place)]; }
  const TriangleClusters::Relief& relief(std::uint32_t place, std::size_t corner) const noexcept {
    return clusters_.relief(place, corner);
  }
  Vec3 corner(std::uint32_t place, std::size_t k) const noexcept;
  Corners corners(std::uint32_t place) const noexcept;
  /// Zero for a triangle whose corners lie on a line.
  Vec3 face_normal(std::uint32_t place) const noexcept {
    const Corners t = corners(place);
    return normalized(cross(t.b - t.a, t.c - t.a));
  }
  Face face(std::uint32_t place) const noexcept;
  static Foot foot(const Corners& t, Vec3 x) noexcept;
  Clearance clearance_of(const Face& face, Vec3 x) const noexcept;
  Room room(std::uint32_t place, const Face& face) const noexcept;
  /// The face of a place and its room, without a clearance.
  KnownFace known_face(std::uint32_t place) const noexcept;
  /// Whether x is left to the triangles around this one: one of them in which the relief goes on is nearer.
  bool is_beyond(const KnownFace& known, Vec3 x) const noexcept;
  /// @param weights of b and c.
  static ReliefSample relief_at(const Face& face, Vec2 weights) noexcept;
  /// Box around everything within `reach` of the segment from a to b, rounded outwards.
  static Box3f box_around(Vec3 a, Vec3 b, double reach) noexcept;

 private:
  using Corner = TriangleClusters::Corner;
  /// A unit vector on the octahedron |x| + |y| + |z| = 1, unfolded to a square; 0.003 degrees.
  using PackedNormal = std::array<std::int16_t, 2>;
  static constexpr std::uint16_t k_relief_bit = 0x8000, k_no_arch = 0xffff;
  static constexpr double k_tilts = 65534;
  /// Places of the triangles across each edge in which the relief goes on; k_no_place where it does not.
  using Continued = std::array<std::uint32_t, 3>;
  struct WaySample;
  struct Sweep;
  struct NearestSoFar;

  std::uint16_t packed_material(std::uint32_t place) const noexcept { return material_[clusters_.slot(place)]; }
  const Continued& continued(std::uint32_t place) const noexcept { return continued_[clusters_.slot(place)]; }
  /// The edge of a triangle behind which another one lies. @pre There is one.
  std::uint32_t edge_towards(std::uint32_t place, std::uint32_t other) const noexcept {
    const Continued& across = continued(place);
    return across[0] == other ? 0 : across[1] == other ? 1 : 2;
  }
  void find_arches();
  Vec3 opposite(std::uint32_t place, std::uint32_t other) const noexcept;
  void continue_relief(const ContactMesh& mesh);
  bool goes_on(std::uint32_t place, std::uint32_t edge, std::uint32_t other, std::uint32_t other_edge) const noexcept;
  template <class Visit>
  bool around(std::uint32_t place, std::uint32_t k, const Visit& visit) const noexcept;
  static PackedNormal packed(Vec3 normal) noexcept;
  static Vec3 unpacked(PackedNormal normal) noexcept;
  static std::array<PackedNormal, 3> packed_corner_normals(const ContactMesh& mesh, std::size_t t);
  double relief_top(std::uint32_t place) const noexcept;
  ReliefSample skinned_relief_at(const Face& face, Vec2 weights) const noexcept;
  Clearance clearance_above(const Face& face, Vec2 weights, double height) const noexcept;
  Clearance clearance_beside(const Face& face, Vec3 x) const noexcept;
  static void move_approach(const Corners& t, Vec3 from, Vec3 way, double to, Approach& state) noexcept;
  bool advance(const Corners& t, Vec3 from, Vec3 way, double radius, double least, double t_max,
               Approach& state) const noexcept;
  bool comes_within(const Corners& t, Vec3 from, Vec3 way, double least, Approach state) const noexcept;
  bool is_outside(std::uint32_t place, const Box3f& box) const noexcept;
  Sweep make_sweep(Vec3 from, Vec3 to) const noexcept;
  void sweep_cluster(std::uint32_t cluster, Sweep& sweep) const noexcept;
  void sweep_prisms(Neighbourhood& near, double since, Sweep& sweep) const noexcept;
  void sweep_triangle(std::uint32_t place, Sweep& sweep) const noexcept;
  void sweep_plain(std::uint32_t place, Sweep& sweep) const noexcept;
  void sweep_relief(std::uint32_t place, Sweep& sweep) const noexcept;
  bool stays_clear(const KnownFace& known, Vec3 a, Vec3 b) const noexcept;
  std::optional<double> foretold(const KnownFace& known, Vec3 x) const noexcept;
  WaySample sample(KnownFace& known, Vec3 from, Vec3 way, double t) const noexcept;
  bool limit_to_room(const KnownFace& known, Vec3 from, Vec3 way, double& t_min, double& t_max) const noexcept;
  double border(const KnownFace& known, Vec3 from, Vec3 way, double inside, double beyond) const noexcept;
  WaySample find_level(KnownFace& known, Vec3 from, Vec3 way, double level, WaySample outside,
                       const WaySample& inside) const noexcept;
  void update_nearest(std::uint32_t i, Vec3 x, const Neighbourhood& near, NearestSoFar& nearest) const noexcept;
  void make_prisms(std::uint32_t i, Neighbourhood& near) const noexcept;

  std::vector<ContactMaterial> materials_;
  std::vector<HeightField> heights_;
  std::vector<ChannelField> channels_;
  TriangleClusters clusters_;           // Vertices relative to origin_. The arrays below are indexed by its slots.
  LargeArray<std::uint16_t> material_;  // With k_relief_bit where there is relief.
  LargeArray<std::uint32_t> source_;    // Index in the ContactMesh.
  LargeArray<Continued> continued_;     // This and the next are empty without relief.
  LargeArray<std::uint16_t> arch_;      // Tilts times k_tilts; k_no_arch where the triangles around form no arch.
  LargeArray<std::array<PackedNormal, 3>> normals_;  // Of the corners; empty when nothing is shaded.
  Vec3 origin_, low_, high_;
  double radius_ = 0, skin_ = 0, tallest_ = 0;
  std::size_t skipped_ = 0;
};

inline Vec3 ContactTriangles::corner(std::uint32_t place, std::size_t k) const noexcept {
  const Corner& v = clusters_.corner(place, k);
  return Vec3{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

inline ContactTriangles::Corners ContactTriangles::corners(std::uint32_t place) const noexcept {
  return {corner(place, 0), corner(place, 1), corner(place, 2)};
}

inline Box3f ContactTriangles::box_around(Vec3 a, Vec3 b, double reach) noexcept {
  const double size =
      std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z), std::abs(b.x), std::abs(b.y), std::abs(b.z)});
  const double grow = reach + 2 * static_cast<double>(std::numeric_limits<float>::epsilon()) * (size + reach);
  const auto low = [grow](double x, double y) { return static_cast<float>(std::min(x, y) - grow); };
  const auto high = [grow](double x, double y) { return static_cast<float>(std::max(x, y) + grow); };
  Box3f box;
  box.low = {low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)};
  box.high = {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)};
  return box;
}

/// Ericson, Real-Time Collision Detection (2005), 5.1.5: by the Voronoi region that x lies in. An edge whose square
/// vanishes beside the other numbers counts as its first corner.
[[gnu::always_inline]] inline ContactTriangles::Foot ContactTriangles::foot(const Corners& t, Vec3 x) noexcept {
  const auto share = [](double part, double whole) {
    return part / std::max(whole, std::numeric_limits<double>::min());
  };
  const Vec3 ab = t.b - t.a, ac = t.c - t.a, ap = x - t.a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {t.a, 0, 0, Foot::On::corner, {}};
  const Vec3 bp = x - t.b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {t.b, 1, 0, Foot::On::corner, {}};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = share(d1, d1 - d3);
    return {t.a + v * ab, v, 0, Foot::On::edge, ab};
  }
  const Vec3 cp = x - t.c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {t.c, 0, 1, Foot::On::corner, {}};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = share(d2, d2 - d6);
    return {t.a + w * ac, 0, w, Foot::On::edge, ac};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = share(d4 - d3, (d4 - d3) + (d5 - d6));
    return {t.b + w * (t.c - t.b), 1 - w, w, Foot::On::edge, t.c - t.b};
  }
  const double scale = share(1, va + vb + vc), v = vb * scale, w = vc * scale;
  return {t.a + v * ab + w * ac, v, w, Foot::On::face, {}};
}

[[gnu::always_inline]] inline ContactTriangles::ReliefSample ContactTriangles::relief_at(const Face& face,
                                                                                         Vec2 weights) noexcept {
  HeightSample sample;
  if (face.height != nullptr)
    sample = face.height->sample_texels(face.texel + weights.x * face.texel_v + weights.y * face.texel_w);
  const double height = sample.height_m - (face.shift + weights.x * face.shift_v + weights.y * face.shift_w);
  if (height <= 0) return {};
  const Vec2 by{dot(sample.gradient_m, face.texel_v) - face.shift_v,
                dot(sample.gradient_m, face.texel_w) - face.shift_w};
  const Vec2 slope = face.weights_by(by);
  return {height, slope, dot(slope, by)};
}

}  // namespace papilla
