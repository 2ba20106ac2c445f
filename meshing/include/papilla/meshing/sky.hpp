// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "papilla/meshing/placed_mesh.hpp"

namespace papilla {

namespace detail {
class TriangleBvh;
}

struct SkyOptions {
  std::uint32_t rays = 64;  ///< A point; >= 1.
  Vec3 up{0, 1, 0};         ///< Any length above 0.
};

/// How much of the sky a point of a surface sees: what falls from above (snow, dust, rain) reaches it in that share.
///
///   sky = 1/pi * integral over the directions d of the upper half space with d . n > 0 and nothing in their way,
///         weighted by d . up
///
/// so the zenith counts most and the horizon nothing. A free plane tilted by b has (1 + cos b) / 2: 1 when it looks
/// up, 1/2 for a wall, 0 when it looks down; below a disc of radius R at the height h it is 1 - R^2 / (R^2 + h^2).
/// The same directions are used for every point (sunflower points on the unit disc, raised to the half sphere), so
/// neighbours differ by no noise; the error is about 1/rays at smooth outlines and steps of 1/rays show.
/// Both sides of a triangle hide. Rays start 1e-5 of the scene's diagonal off the surface, on the side of the normal.
/// Cost: O(n log n) to build; rays sight lines a point. Deterministic. Safe to call from several threads.
class SkyView {
 public:
  /// @param parts  those that are not opaque hide nothing.
  /// @throws InvalidInput naming the part when a mesh is missing or has a bad index or coordinate; or when an option is
  ///         out of its range.
  explicit SkyView(std::span<const PlacedMesh> parts, const SkyOptions& options = {});

  /// @param point   in mm, finite. @param normal  of unit length.
  double operator()(const Vec3& point, const Vec3& normal) const noexcept;

 private:
  std::shared_ptr<const detail::TriangleBvh> bvh_;
  std::vector<Vec3> rays_;
  double start_mm_, reach_mm_;
};

}  // namespace papilla
