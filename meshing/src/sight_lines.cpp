// SPDX-License-Identifier: MIT
#include "papilla/meshing/sight_lines.hpp"

#include "world_scene.hpp"

namespace papilla {

SightLines::SightLines(std::span<const PlacedMesh> parts) {
  const detail::Occluders occluders = detail::occluders(parts, "SightLines");
  bvh_ = occluders.bvh;
  start_mm_ = occluders.start_mm;
}

bool SightLines::sees(const Vec3& eye, const Vec3& point) const noexcept {
  const Vec3 way = eye - point;
  return norm(way) <= start_mm_ || !bvh_->blocks(point + start_mm_ * normalized(way), eye);
}

}  // namespace papilla
