// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "papilla/haptic/bvh.hpp"
#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

/// First contact of a moving probe.
struct SweepHit {
  double t = 0;                ///< Place on the way in [0, 1] where the probe touches.
  Vec3 normal;                 ///< Unit, out of the obstacle: the gradient of the clearance there.
  double penetration_m = 0;    ///< Minus the clearance at t: positive when the probe was too deep at the start already.
  std::uint32_t triangle = 0;  ///< Number in the ContactMesh.
  std::uint32_t material = 0;
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

/// What one probe can touch in a scene: triangles with relief, ready for the tick.
///
/// A ball of radius r at x touches triangle T when its clearance
///     f_T(x) = |x − c| − (r + s) − h(c)·max(0, cos∠(n_T, x − c)),   c = nearest point of T to x,
/// is 0. h is the height of the relief above the base of T, dilated by r; s is the skin, a few micrometres that close
/// the gaps of CAD meshes and keep the arithmetic away from 0; forces are computed without it. Free space is where
/// every f_T ≥ 0: no adjacency, no watertightness, and no edge rules are needed, so slivers, duplicated vertices, gaps
/// up to 2s and open sheets are ordinary input. Both sides of a triangle are solid walls; the relief is on its front,
/// the back feels the smooth base.
///
/// The base of a relief that reaches below the triangles (offset < 0) is the mesh moved inwards to the lowest height
/// along the interpolated vertex normals, so that h ≥ 0. Where that would turn a triangle over (a fillet tighter than
/// the relief is deep) the move is shortened and the valleys of the relief end at the base. Heights at a uv seam meet
/// in a fillet of the size of their difference: no hole.
///
/// Build: O(n log n); about 1 µs a triangle. Memory: 44 bytes a triangle, 36 more with relief, and the tree.
/// Vertices are rounded to single precision around the centre of the scene (0.5 µm at 10 m). Queries are noexcept and
/// allocate nothing; the same input gives the same bits.
class ContactSurface {
 public:
  /// @param mesh triangles with zero area or non-finite vertices are left out (see skipped_triangles()).
  /// @param probe_radius_m r ≥ 0.
  /// @throws InvalidInput when indices are out of range, array sizes disagree, a material's numbers are not finite or
  ///         negative, or nothing is left.
  ContactSurface(const ContactMesh& mesh, std::vector<ContactMaterial> materials, std::vector<HeightField> heights,
                 double probe_radius_m);

  /// Where a probe that starts at `from` and heads for `to` first loses clearance. A probe that is in touch (up to
  /// tolerance_m() deep) at `from` is stopped only by what it would go deeper into.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to) const noexcept;

  /// Nearest point of the base within `radius_m`, by brute nearest-first search.
  std::optional<SurfacePoint> closest_point(Vec3 p, double radius_m) const noexcept;

  /// The same, among the triangles of one material.
  std::optional<SurfacePoint> closest_point(Vec3 p, double radius_m, std::uint32_t material) const noexcept;

  /// How often the straight way from `from` up to, but without, `to` goes through the base triangles (Möller and
  /// Trumbore 1997). Triangles met at the same place, as duplicates and at edges, count once; at most 16.
  int crossings(Vec3 from, Vec3 to) const noexcept;

  /// min over T of f_T(x), looked for within `radius_m` of x; radius_m − contact_radius_m() when nothing is near.
  double clearance(Vec3 x, double radius_m) const noexcept;

  const ContactMaterial& material(std::uint32_t index) const noexcept { return materials_[index]; }
  ContactMaterial& material(std::uint32_t index) noexcept { return materials_[index]; }
  std::size_t material_count() const noexcept { return materials_.size(); }
  std::size_t triangles() const noexcept { return triangles_.size(); }
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
  static constexpr std::uint32_t k_no_relief = 0xffffffffU;
  struct Corners {
    Vec3 a, b, c;
  };
  struct Packed {
    float v[3][3];
    std::uint32_t material;
    std::uint32_t relief;  ///< Index into reliefs_, or k_no_relief.
  };
  struct Relief {
    float uv[3][2];
    float shift[3];  ///< How far the base was moved at each corner, ≤ 0.
  };
  struct Foot;
  struct Clearance;

  Corners corners(std::uint32_t place) const noexcept;
  Foot foot(const Corners& t, Vec3 x) const noexcept;
  Clearance clearance_of(std::uint32_t place, const Corners& t, Vec3 x) const noexcept;
  double relief_at(std::uint32_t place, const Corners& t, const Foot& foot, Vec3* gradient) const noexcept;
  double texels_on(std::uint32_t place, const Corners& t, Vec3 way) const noexcept;
  std::optional<double> approach(const Corners& t, Vec3 from, Vec3 way, double at, double radius,
                                 double t_max) const noexcept;
  static bool comes_before(const SweepHit& a, const SweepHit& b) noexcept;
  void sweep_plain(std::uint32_t place, Vec3 from, Vec3 way, std::optional<SweepHit>& best) const noexcept;
  void sweep_relief(std::uint32_t place, Vec3 from, Vec3 way, std::optional<SweepHit>& best) const noexcept;
  template <class Accept>
  std::optional<SurfacePoint> nearest(Vec3 p, double radius, Accept&& accept) const noexcept;

  std::vector<ContactMaterial> materials_;
  std::vector<HeightField> heights_;
  std::vector<Packed> triangles_;  // In the order of the tree's leaves, around origin_.
  std::vector<Relief> reliefs_;
  std::vector<std::uint32_t> source_;  // Number in the ContactMesh.
  Bvh bvh_;
  Vec3 origin_, low_, high_;
  double radius_ = 0, skin_ = 0, tallest_ = 0;
  std::size_t skipped_ = 0;
};

}  // namespace papilla
