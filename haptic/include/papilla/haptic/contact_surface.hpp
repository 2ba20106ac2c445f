// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "papilla/haptic/channel_field.hpp"
#include "papilla/haptic/contact_mesh.hpp"
#include "papilla/haptic/height_field.hpp"

namespace papilla {

class ContactTriangles;

/// First contact of a probe that moves along a segment.
struct SweepHit {
  double t = 0;                ///< Parameter of the contact on the segment, in [0, 1].
  Vec3 normal;                 ///< Unit gradient of the clearance there; points out of the obstacle.
  double penetration_m = 0;    ///< Minus the clearance at t: positive when the probe overlapped at the start already.
  std::uint32_t triangle = 0;  ///< Index in the ContactMesh.
  std::uint32_t material = 0;
  std::uint32_t place = 0;  ///< The triangle's number within the surface; see ContactTriangles.
  /// The other face of a crease: a second triangle without relief, touched above its face, with another normal, at the
  /// same parameter or within a quarter of the tolerance behind it. The first one, if there are several.
  struct Crease {
    double t = 0;
    Vec3 normal;
    double penetration_m = 0;
    std::uint32_t triangle = 0;
    std::uint32_t material = 0;
    std::uint32_t place = 0;
  };
  std::optional<Crease> crease;
};

/// Closest point of the base triangles.
struct SurfacePoint {
  Vec3 point;
  Vec3 face_normal;  ///< Unit normal of the triangle, on its front.
  double distance_m = 0;
  double height_m = 0;     ///< Relief above `point` on the front side, dilated by the probe, ≥ 0.
  Vec3 slope;              ///< Its gradient in the triangle's plane, metres per metre.
  double base_m = 0;       ///< Of `point` over the triangles that were given, ≤ 0; see ContactSurface.
  bool on_border = false;  ///< On an edge or corner of its triangle, where the face normal does not tell the side.
  std::uint32_t triangle = 0;
  std::uint32_t material = 0;
};

/// A sample of a relief that drives a stimulus and displaces nothing.
struct StimulusSample {
  double grey = 0;  ///< Grey levels above that of height 0.
  Vec3 slope;       ///< Gradient of `grey` along the surface, grey levels per metre.
  Vec3 along_u;     ///< Unit tangent along which u grows.
  Vec3 normal;
  double column = 0;   ///< Place along the rows of the picture in pixels, growing through its repeats.
  double pixel_m = 0;  ///< Length of a pixel on the surface.
  std::uint32_t material = 0;
};

/// The obstacle of a haptic scene: triangles with relief, indexed for queries at 1 kHz.
///
/// A ball of radius r at x touches triangle T when its clearance
///     f_T(x) = |x − c| − (r + s) − h(c)·max(0, cos∠(n_T, x − c)),   c = closest point of T to x,
/// is 0. h is the height of the relief above the base of T, dilated by r, with the skin on it along its normal. s is
/// the skin, 20 µm (less in scenes below 20 mm, more above 10 m): it closes the gaps of CAD meshes and keeps distances
/// away from 0; forces are computed without it. Free space is where every f_T that counts is ≥ 0. That needs no
/// watertight mesh and no edge rules, so slivers, duplicated vertices, gaps up to 2s and open sheets are ordinary
/// input. Both sides of a triangle are solid; the relief is on the front, the back is the smooth base.
///
/// Every triangle counts, with one exception: one with relief whose neighbours go on with the same relief, all around
/// its three corners, in a plane or bent away from the front, does not count where one of them is nearer to x. On such
/// ground a place is felt once, at its closest point, and what a probe feels does not depend on the edges: at the
/// border both triangles have the same closest point. In hollows, at seams of the uv, at rims and at ridges every
/// triangle counts, so that nothing has steps or holes.
///
/// The base of a relief that reaches below the triangles (offset < 0) is the mesh moved inwards to the lowest height
/// along the interpolated vertex normals, so that h ≥ 0. Where that would invert a triangle (a fillet tighter than the
/// relief is deep) the offset is shortened and the valleys of the relief end at the base. Different heights on both
/// sides of a uv seam meet in a fillet of the size of their difference, without a hole.
///
/// Build: O(n log n), about 1 µs a triangle. Memory: 22 bytes a triangle, 30 with maps, 45 with relief, 12 more with
/// shaded materials. Vertices are rounded to single precision around the centre of the scene (0.5 µm at 10 m). Queries
/// are const, noexcept and allocate nothing; the same input gives the same bits.
class ContactSurface {
 public:
  /// Largest |x| + |y| + |z| of a probe: beyond it doubles do not resolve its depth.
  static constexpr double k_farthest_m = 1e6;
  /// Whether p is finite and no farther than that.
  static bool is_valid_position(Vec3 p) noexcept {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z) <= k_farthest_m;
  }

  /// @param mesh triangles with zero area or non-finite vertices are left out (see skipped_triangles()).
  /// @param probe_radius_m r ≥ 0.
  /// @param channels maps of materials, over the same corner_uv as the heights.
  /// @throws InvalidInput when indices are out of range, array sizes disagree, a material's numbers are not finite or
  ///         negative, there are more than 32767 materials, or no triangle is left.
  ContactSurface(const ContactMesh& mesh, std::vector<ContactMaterial> materials, std::vector<HeightField> heights,
                 double probe_radius_m, std::vector<ChannelField> channels = {});
  ContactSurface(ContactSurface&&) noexcept;
  ContactSurface& operator=(ContactSurface&&) noexcept;
  ~ContactSurface();

  /// Where a probe on the segment from `from` to `to` first loses clearance. A probe that overlaps at `from` by up to
  /// tolerance_m() is stopped only by triangles that it would enter deeper.
  std::optional<SweepHit> sweep(Vec3 from, Vec3 to) const noexcept;

  /// Shaded normal at a resting probe: with f_i the face normals of the triangles that it touches at `proxy` and s_i
  /// their corner normals, interpolated at the closest points, writes the normal as Σ λ_i f_i with λ_i ≥ 0 and returns
  /// Σ λ_i s_i, of unit length. The force then turns steadily where it would jump by the angle between two facets
  /// [Morgenbesser and Srinivasan 1996; Ruspini, Kolarov and Khatib 1997]. The normal is returned unchanged across
  /// edges whose corner normals differ, and where a touched triangle has relief or its material no shading. Shaded
  /// forces are not conservative; their direction is off by at most half the angle between facets. Cost: one search of
  /// the tree.
  Vec3 shaded_normal(Vec3 proxy, Vec3 normal) const noexcept;

  /// Closest point of the base within `radius_m`.
  std::optional<SurfacePoint> closest_point(Vec3 p, double radius_m) const noexcept;

  /// The same among the triangles of one material.
  std::optional<SurfacePoint> closest_point(Vec3 p, double radius_m, std::uint32_t material) const noexcept;

  /// The stimulus of the closest triangle within `radius_m` that has one.
  std::optional<StimulusSample> stimulus(Vec3 p, double radius_m) const noexcept;

  /// Number of crossings of the segment [from, to) with the base triangles (Möller and Trumbore 1997). Crossings at the
  /// same parameter, as of duplicates and at shared edges, count once; at most 16.
  int crossings(Vec3 from, Vec3 to) const noexcept;

  /// min over the T that count of f_T(x) within `radius_m` of x; radius_m − contact_radius_m() when no triangle is that
  /// near.
  double clearance(Vec3 x, double radius_m) const noexcept;

  /// The largest value that a material has of a quantity: of its map, else its constant.
  double most(std::uint32_t material, Quantity quantity) const noexcept;

  const ContactMaterial& material(std::uint32_t index) const noexcept;
  ContactMaterial& material(std::uint32_t index) noexcept;
  std::size_t material_count() const noexcept;
  std::size_t triangles() const noexcept;  ///< Number of triangles that are kept.
  std::size_t skipped_triangles() const noexcept;
  double probe_radius_m() const noexcept;
  double skin_m() const noexcept;
  double contact_radius_m() const noexcept { return probe_radius_m() + skin_m(); }  ///< r + s.
  double tolerance_m() const noexcept { return skin_m() / 16; }  ///< Largest error of a resting probe.
  double tallest_relief_m() const noexcept;
  Vec3 low() const noexcept;  ///< Box of the base, in the frame of the scene.
  Vec3 high() const noexcept;
  std::size_t bytes() const noexcept;  ///< Memory of the index and the triangles.

 private:
  friend class Proxy;
  std::unique_ptr<ContactTriangles> triangles_;
};

}  // namespace papilla
