// SPDX-License-Identifier: MIT
#include "papilla/meshing/visibility.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "convex_piece.hpp"
#include "papilla/core/error.hpp"
#include "placed_bvh.hpp"
#include "sample_points.hpp"

namespace papilla {
namespace {

/// Wilson's score interval for `hits` of `count` at 95 %.
void set_interval(PartVisibility& part) noexcept {
  constexpr double z = 1.959964;
  const auto n = static_cast<double>(part.samples);
  if (part.samples == 0) {
    part.high = 1;
    return;
  }
  const double p = static_cast<double>(part.visible_samples) / n, z2 = z * z / n;
  const double middle = (p + z2 / 2) / (1 + z2), half = z / (1 + z2) * std::sqrt(p * (1 - p) / n + z2 / (4 * n));
  part.visible_fraction = p;
  part.low = part.visible_samples == 0 ? 0 : std::max(0.0, middle - half);
  part.high = part.visible_samples == part.samples ? 1 : std::min(1.0, middle + half);
}

/// What of the piece lies behind a plane or on it.
detail::ConvexPiece not_ahead(const detail::ConvexPiece& piece, const Vec3& origin, const Vec3& normal) noexcept {
  const auto halves = piece.cut(origin, normal, 0);
  if (halves.behind.size() > 0) return halves.behind;
  detail::ConvexPiece touching;
  for (const Vec3& p : piece.corners())
    if (dot(p - origin, normal) <= 0) touching.add(p);
  return touching;
}

bool touches(detail::ConvexPiece piece, const BoxVolume& box) noexcept {
  for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    for (const auto& [corner, outwards] : {std::pair{box.low, -n}, std::pair{box.high, n}}) {
      piece = not_ahead(piece, corner, outwards);
      if (piece.size() == 0) return false;
    }
  return true;
}

bool touches(const detail::PlacedTriangles& part, std::size_t t, const Volume& volume) noexcept {
  if (const auto* box = std::get_if<BoxVolume>(&volume))
    return touches(detail::ConvexPiece(part.corner(t, 0), part.corner(t, 1), part.corner(t, 2)), *box);
  const auto& sphere = std::get<SphereVolume>(volume);
  const detail::TriangleFrame frame(part.corner(t, 0), part.corner(t, 1), part.corner(t, 2));
  return detail::squared_distance(sphere.centre, frame) <= sphere.radius_mm * sphere.radius_mm;
}

}  // namespace

std::vector<PartVisibility> measure_visibility(std::span<const PlacedMesh> parts, const Volume& eyes,
                                               const VisibilityOptions& options) {
  detail::check_volume(eyes, "measure_visibility");
  if (options.samples_per_part == 0 || options.eyes_per_sample == 0)
    throw InvalidInput("measure_visibility: samples_per_part and eyes_per_sample must be positive");
  const detail::WorldScene scene = detail::place(parts, "measure_visibility");
  const detail::PlacedBvh bvh(scene);
  const double start = 1e-6 * scene.bounds.diagonal();

  std::vector<PartVisibility> result(parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const detail::AreaSampler sampler(scene.parts[i]);
    if (sampler.empty()) return;
    const std::uint64_t count = options.samples_per_part;
    std::vector<std::uint8_t> seen(count, 0);
    oneapi::tbb::parallel_for(std::uint64_t{0}, count, [&](std::uint64_t s) {
      const auto sample = sampler(s, count);
      const Index own = bvh.number(i, sample.triangle);
      for (std::uint64_t e = 0; e < options.eyes_per_sample && !seen[s]; ++e) {
        const Vec3 to = detail::point_in(eyes, s * options.eyes_per_sample + e), way = to - sample.point;
        const double length = norm(way);
        seen[s] = length <= start || !bvh.blocks(sample.point + (start / length) * way, to, own);
      }
    });
    result[i].samples = count;
    result[i].visible_samples = static_cast<std::uint64_t>(std::count(seen.begin(), seen.end(), 1));
  });
  for (PartVisibility& part : result) set_interval(part);
  return result;
}

std::vector<PartReach> measure_reach(std::span<const PlacedMesh> parts, const Volume& reach) {
  detail::check_volume(reach, "measure_reach");
  const detail::WorldScene scene = detail::place(parts, "measure_reach");
  std::vector<PartReach> result(parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const detail::PlacedTriangles& part = scene.parts[i];
    result[i].triangles = part.size();
    for (std::size_t t = 0; t < part.size(); ++t) result[i].triangles_inside += touches(part, t, reach);
  });
  return result;
}

}  // namespace papilla
