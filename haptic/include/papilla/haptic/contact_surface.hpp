// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"
#include "papilla/haptic/neighbourhood.hpp"
#include "papilla/haptic/triangle_clusters.hpp"

namespace papilla {

/// First contact of a moving probe.
struct SweepHit {
  double t = 0;                ///< Place on the way in [0, 1] where the probe touches.
  Vec3 normal;                 ///< Unit, out of the obstacle: the gradient of the clearance there.
  double penetration_m = 0;    ///< Minus the clearance at t: positive when the probe was too deep at the start already.
  std::uint32_t triangle = 0;  ///< Number in the ContactMesh.
  std::uint32_t material = 0;
  /// A triangle without relief that is touched above its face, in another direction, at the same place or within a
  /// quarter of the tolerance on: in a crease two hold the probe. Of several the first.
  struct Beside {
    double t = 0;
    Vec3 normal;
    double penetration_m = 0;
    std::uint32_t triangle = 0;
    std::uint32_t material = 0;
  };
  std::optional<Beside> beside;
};

/// Nearest point of the base triangles.
struct SurfacePoint {
  Vec3 point;
  Vec3 face_normal;  ///< Unit normal of the triangle, on its front.
  double distance_m = 0;
  double height_m = 0;     ///< Relief above `point` as the front side feels it (dilated by the probe), ≥ 0.
  bool on_border = false;  ///< On an edge or corner of its triangle, where the face normal alone tells no side.
  std::uint32_t triangle = 0;
  std::uint32_t material = 0;
};

/// What a stimulus reads of a relief that displaces nothing.
struct StimulusSample {
  double grey = 0;  ///< Grey levels above that of height 0.
  Vec3 slope;       ///< Its gradient along the surface, grey levels per metre.
  Vec3 along_u;     ///< Unit tangent along which u grows.
  Vec3 point, normal;
  double height_m = 0;
  double pixel_m = 0;  ///< Length of a pixel on the surface.
  std::uint32_t material = 0;
};

/// What one probe can touch in a scene: triangles with relief, ready for the tick.
///
/// A ball of radius r at x touches triangle T when its clearance
///     f_T(x) = |x − c| − (r + s) − h(c)·max(0, cos∠(n_T, x − c)),   c = nearest point of T to x,
/// is 0. h is the height of the relief above the base of T, dilated by r, with the skin lying on it along its normal; s
/// is the skin, a few micrometres that close the gaps of CAD meshes and keep the arithmetic away from 0; forces are
/// computed without it. Free space is where every f_T ≥ 0: no adjacency, no watertightness, and no edge rules are
/// needed, so slivers, duplicated vertices, gaps up to 2s and open sheets are ordinary input. Both sides of a triangle
/// are solid walls; the relief is on its front, the back feels the smooth base.
///
/// The base of a relief that reaches below the triangles (offset < 0) is the mesh moved inwards to the lowest height
/// along the interpolated vertex normals, so that h ≥ 0. Where that would turn a triangle over (a fillet tighter than
/// the relief is deep) the move is shortened and the valleys of the relief end at the base. Heights at a uv seam meet
/// in a fillet of the size of their difference: no hole.
///
/// Build: O(n log n); about 1 µs a triangle. Memory: 6 bytes a triangle and what TriangleClusters says; 12 bytes a
/// triangle more in a scene with shaded materials. Vertices are rounded
/// to single precision around the centre of the scene (0.5 µm at 10 m). Queries are noexcept and allocate nothing; the
/// same input gives the same bits.
class ContactSurface {
 public:
  /// Farther from the origin than this nothing can be felt: doubles would no longer tell how deep a probe is.
  static constexpr double k_farthest_m = 1e6;
  /// Whether a device can be there: finite, and no farther than that.
  static bool is_place(Vec3 p) noexcept {
    const double size = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
    return size <= k_farthest_m;
  }

  /// @param mesh triangles with zero area or non-finite vertices are left out (see skipped_triangles()).
  /// @param probe_radius_m r ≥ 0.
  /// @throws InvalidInput when indices are out of range, array sizes disagree, a material's numbers are not finite or
  ///         negative, there are more than 32767 materials, or nothing is left.
  ContactSurface(const ContactMesh& mesh, std::vector<ContactMaterial> materials, std::vector<HeightField> heights,
                 double probe_radius_m);

  /// Where a probe that starts at `from` and heads for `to` first loses clearance. A probe that is in touch (up to
  /// tolerance_m() deep) at `from` is stopped only by what it would go deeper into.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to) const noexcept;

  /// Collects what a probe can touch within `radius_m` of `centre`.
  /// @returns false, with an empty neighbourhood, when that is more than fits.
  bool gather(Vec3 centre, double radius_m, Neighbourhood& near) const noexcept;

  /// How far a probe at `from` may go in any direction before it leaves what was gathered; negative: it is outside.
  double margin(Vec3 from, const Neighbourhood& near) const noexcept { return near.margin(from - origin_); }

  /// The same hit, from what was gathered; from the tree as soon as the way leaves that. On plain triangles the same
  /// bits, on relief within the tolerance.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to, Neighbourhood& near) const noexcept;

  /// The same, looked for only as far as what was gathered reaches, and only from t = `seen` on: it is known that
  /// nothing is met before. Without a hit `seen` grows to where it was looked, 1 at the end; it stays when nothing is
  /// known there.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to, Neighbourhood& near, double& seen) const noexcept;

  /// A place to try.
  struct Rest {
    Vec3 place;
    Vec3 off;  ///< Unit direction in which the surface seems to end there; zero where it goes on all around.
    std::uint32_t material = 0;
  };

  /// Where a probe would rest that is drawn to `goal` and comes from the side of `normal`, if nothing but the nearest
  /// of the triangles gathered were there. Nothing with relief, and when there is no such place within `radius_m` of
  /// the goal.
  std::optional<Rest> likely_rest(Vec3 goal, double radius_m, Vec3 normal, Neighbourhood& near) const noexcept;

  /// Shaded normals at a resting probe: with f_i the face normals of the triangles that it touches at `proxy` and s_i
  /// their corner normals, interpolated at the nearest points, writes the normal as Σ λ_i f_i with λ_i ≥ 0 and returns
  /// Σ λ_i s_i, of unit length. So a force that jumps by the angle between two facets turns steadily over both instead
  /// [Morgenbesser and Srinivasan 1996; Ruspini, Kolarov and Khatib 1997]; across edges whose corner normals differ it
  /// stays as it is, as it does where a touched triangle has relief or its material no shading. Off the mesh's real
  /// normal forces are not conservative: the error is that of the shading, at most half the angle between facets. Cost:
  /// one search of the tree.
  Vec3 shaded_normal(Vec3 proxy, Vec3 normal) const noexcept;

  /// Nearest point of the base within `radius_m`, by brute nearest-first search.
  std::optional<SurfacePoint> closest_point(Vec3 p, double radius_m) const noexcept;

  /// The same, among the triangles of one material.
  std::optional<SurfacePoint> closest_point(Vec3 p, double radius_m, std::uint32_t material) const noexcept;

  /// The stimulus of the nearest triangle within `radius_m` that has one.
  std::optional<StimulusSample> stimulus(Vec3 p, double radius_m) const noexcept;

  /// How often the straight way from `from` up to, but without, `to` goes through the base triangles (Möller and
  /// Trumbore 1997). Triangles met at the same place, as duplicates and at edges, count once; at most 16.
  int crossings(Vec3 from, Vec3 to) const noexcept;

  /// min over T of f_T(x), looked for within `radius_m` of x; radius_m − contact_radius_m() when nothing is near.
  double clearance(Vec3 x, double radius_m) const noexcept;

  const ContactMaterial& material(std::uint32_t index) const noexcept { return materials_[index]; }
  ContactMaterial& material(std::uint32_t index) noexcept { return materials_[index]; }
  std::size_t material_count() const noexcept { return materials_.size(); }
  std::size_t triangles() const noexcept { return clusters_.triangles(); }
  std::size_t skipped_triangles() const noexcept { return skipped_; }
  double probe_radius_m() const noexcept { return radius_; }
  double skin_m() const noexcept { return skin_; }
  double contact_radius_m() const noexcept { return radius_ + skin_; }  ///< r + s.
  double tolerance_m() const noexcept { return skin_ / 16; }            ///< How far a resting probe may be off.
  double tallest_relief_m() const noexcept { return tallest_; }
  Vec3 low() const noexcept { return low_; }  ///< Box of the base, scene frame.
  Vec3 high() const noexcept { return high_; }
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::uint32_t k_nothing = 0xffffffffU;
  struct Corners {
    Vec3 a, b, c;
  };
  using Corner = TriangleClusters::Corner;
  using Relief = TriangleClusters::Relief;
  /// A unit vector on the octahedron |x| + |y| + |z| = 1, unfolded to a square; 0.003 degrees.
  using PackedNormal = std::array<std::int16_t, 2>;
  static constexpr std::uint16_t k_relief_bit = 0x8000;
  struct Foot;
  struct Face;
  struct Approach;
  struct Clearance;
  struct Sunk;
  struct Sweep;
  struct WayOver;
  struct Nearest;

  std::uint16_t packed_material(std::uint32_t place) const noexcept { return material_[clusters_.slot(place)]; }
  bool has_relief(std::uint32_t place) const noexcept { return (packed_material(place) & k_relief_bit) != 0; }
  std::uint32_t material_of(std::uint32_t place) const noexcept {
    return packed_material(place) & ~unsigned{k_relief_bit};
  }
  std::uint32_t source_of(std::uint32_t place) const noexcept { return source_[clusters_.slot(place)]; }
  const Relief& relief(std::uint32_t place, std::size_t corner) const noexcept {
    return clusters_.relief(place, corner);
  }
  static PackedNormal packed(Vec3 normal) noexcept;
  static std::array<PackedNormal, 3> corner_normals(const ContactMesh& mesh, std::size_t t);
  static Vec3 unpacked(PackedNormal normal) noexcept;
  double top_of(std::uint32_t place) const noexcept;
  Corners corners(std::uint32_t place) const noexcept;
  static Foot foot(const Corners& t, Vec3 x) noexcept;
  Face face(std::uint32_t place) const noexcept;
  Clearance clearance_of(const Face& face, Vec3 x) const noexcept;
  static double relief_at(const Face& face, const Foot& foot, Vec3* gradient) noexcept;
  double lift_at(const Face& face, const Foot& foot, Vec3* slope) const noexcept;
  static void look(const Corners& t, Vec3 from, Vec3 way, double at, Approach& state) noexcept;
  bool approach(const Corners& t, Vec3 from, Vec3 way, double radius, double least, double t_max,
                Approach& state) const noexcept;
  bool goes_deep(const Corners& t, Vec3 from, Vec3 way, double least, Approach state) const noexcept;
  static Box3f box_around(Vec3 a, Vec3 b, double reach) noexcept;
  bool beside(std::uint32_t place, const Box3f& box) const noexcept;
  Sweep sweep_between(Vec3 from, Vec3 to) const noexcept;
  void sweep_cluster(std::uint32_t cluster, Sweep& sweep) const noexcept;
  void sweep_prisms(Neighbourhood& near, double since, Sweep& sweep) const noexcept;
  struct NearestSoFar;
  void nearest_in(std::uint32_t i, Vec3 x, const Neighbourhood& near, NearestSoFar& nearest) const noexcept;
  void make_prisms(std::uint32_t i, Neighbourhood& near) const noexcept;
  void sweep_one(std::uint32_t place, Sweep& sweep) const noexcept;
  void sweep_plain(std::uint32_t place, Sweep& sweep) const noexcept;
  bool stays_clear(const WayOver& over, const Clearance& now, double share) const noexcept;
  void sweep_relief(std::uint32_t place, Sweep& sweep) const noexcept;
  Sunk sink(const Face& face, Vec3 from, Vec3 way, double level, Sunk outside, const Sunk& inside) const noexcept;
  template <class Accept>
  std::optional<Nearest> nearest(Vec3 x, double radius, Accept&& accept) const noexcept;
  std::optional<SurfacePoint> surface_point(const std::optional<Nearest>& near) const noexcept;

  std::vector<ContactMaterial> materials_;
  std::vector<HeightField> heights_;
  TriangleClusters clusters_;           // Vertices around origin_. Arrays below have an entry for each of its slots.
  LargeArray<std::uint16_t> material_;  // With k_relief_bit where there is relief.
  LargeArray<std::uint32_t> source_;    // Number in the ContactMesh.
  LargeArray<std::array<PackedNormal, 3>> normals_;  // Of the corners; empty when nothing is shaded.
  Vec3 origin_, low_, high_;
  double radius_ = 0, skin_ = 0, tallest_ = 0;
  std::size_t skipped_ = 0;
};

}  // namespace papilla
