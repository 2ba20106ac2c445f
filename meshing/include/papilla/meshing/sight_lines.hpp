// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>

#include "papilla/meshing/placed_mesh.hpp"

namespace papilla {

namespace detail {
class TriangleBvh;
}

/// Tells whether two points see each other. Both sides of a triangle hide; parts that are not opaque hide nothing.
/// Cost: O(n log n) to build, about 1 us a line. Deterministic. Safe to call from several threads.
class SightLines {
 public:
  /// @throws InvalidInput naming the part when a mesh is missing or has a bad index or coordinate.
  explicit SightLines(std::span<const PlacedMesh> parts);

  /// True when no triangle cuts the way from `point`, which may lie on one, to `eye`: it starts 1e-5 of the scene's
  /// diagonal before the point. In mm, finite.
  bool sees(const Vec3& eye, const Vec3& point) const noexcept;

 private:
  std::shared_ptr<const detail::TriangleBvh> bvh_;
  double start_mm_;
};

}  // namespace papilla
