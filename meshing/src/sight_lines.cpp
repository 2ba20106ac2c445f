// SPDX-License-Identifier: MIT
#include "papilla/meshing/sight_lines.hpp"

#include "triangle_bvh.hpp"
#include "world_scene.hpp"

namespace papilla {

SightLines::SightLines(std::span<const PlacedMesh> parts) {
  const detail::WorldScene scene = detail::place(parts, "SightLines");
  std::vector<Index> first;
  const TriangleMesh opaque = detail::opaque_triangles(scene, parts, first);
  bvh_ = std::make_shared<detail::TriangleBvh>(opaque.positions, opaque.triangles);
  start_mm_ = 1e-5 * scene.bounds.diagonal();
}

bool SightLines::sees(const Vec3& eye, const Vec3& point) const noexcept {
  const Vec3 way = eye - point;
  return norm(way) <= start_mm_ || !bvh_->blocks(point + start_mm_ * normalized(way), eye);
}

}  // namespace papilla
