// SPDX-License-Identifier: MIT
#include "papilla/meshing/sky.hpp"

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "world_scene.hpp"

namespace papilla {

SkyView::SkyView(std::span<const PlacedMesh> parts, const SkyOptions& options) {
  const double length = norm(options.up);
  if (options.rays == 0 || !(length > 0) || !std::isfinite(length))
    throw InvalidInput("SkyView: rays must be positive and up a direction");
  const detail::Occluders occluders = detail::occluders(parts, "SkyView");
  bvh_ = occluders.bvh;
  start_mm_ = occluders.start_mm, reach_mm_ = 2 * occluders.diagonal_mm;
  const Vec3 up = (1 / length) * options.up;
  const Vec3 across = normalized(cross(up, std::abs(up.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 0, 1}));
  const Vec3 along = cross(up, across);
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::uint32_t i = 0; i < options.rays; ++i) {
    const double r2 = (i + 0.5) / options.rays, angle = golden_angle * i, r = std::sqrt(r2);
    rays_.push_back(r * std::cos(angle) * across + r * std::sin(angle) * along + std::sqrt(1 - r2) * up);
  }
}

double SkyView::operator()(const Vec3& point, const Vec3& normal) const noexcept {
  const Vec3 from = point + start_mm_ * normal;
  std::size_t free = 0;
  for (const Vec3& ray : rays_)
    if (dot(ray, normal) > 0 && !bvh_->blocks(from, from + reach_mm_ * ray)) ++free;
  return static_cast<double>(free) / static_cast<double>(rays_.size());
}

}  // namespace papilla
