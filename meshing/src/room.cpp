// SPDX-License-Identifier: MIT
#include "room.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sample_points.hpp"

namespace papilla::detail {
namespace {

constexpr std::uint64_t k_places = 512;
constexpr std::size_t k_rays = 64;
/// Below it half of the directions or more are free, as outside of everything.
constexpr double k_least_enclosure = 0.5;

Place look_around(const PlacedBvh& bvh, std::span<const Facing> facing, const Vec3& point,
                  const std::vector<Vec3>& directions, double reach_mm) {
  Place place{point, 0, std::sqrt(bvh.closest(point).squared_distance), 0};
  std::size_t hits = 0, fronts = 0;
  for (const Vec3& direction : directions) {
    const Index hit = bvh.first_cut(point, point + reach_mm * direction);
    if (hit == k_no_value) continue;
    const TriangleFrame frame = bvh.frame(hit);
    ++hits;
    const Facing side = facing.empty() ? Facing::as_is : facing[hit];
    fronts += side == Facing::unknown || (dot(cross(frame.ab, frame.ac), direction) < 0) == (side == Facing::as_is);
  }
  place.enclosure = static_cast<double>(hits) / static_cast<double>(directions.size());
  if (place.enclosure > k_least_enclosure && 2 * fronts > hits) place.score = place.enclosure * place.clearance_mm;
  return place;
}

}  // namespace

std::vector<Vec3> directions_around(std::size_t count) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (std::size_t i = 0; i < count / 2; ++i) {  // Sunflower points on the half sphere.
    const double z = (static_cast<double>(i) + 0.5) / static_cast<double>(count / 2);
    const double flat = std::sqrt(1 - z * z), angle = golden_angle * static_cast<double>(i);
    directions.push_back({flat * std::cos(angle), flat * std::sin(angle), z});
    directions.push_back(-directions.back());
  }
  return directions;
}

std::vector<Place> look_for_places(const PlacedBvh& bvh, const Bounds3& bounds, std::span<const Facing> facing) {
  const std::vector<Vec3> directions = directions_around(k_rays);
  const Volume box = BoxVolume{bounds.low, bounds.high};
  std::vector<Place> places(k_places);
  oneapi::tbb::parallel_for(std::uint64_t{0}, k_places, [&](std::uint64_t i) {
    places[i] = look_around(bvh, facing, point_in(box, i), directions, bounds.diagonal());
  });
  return places;
}

std::optional<Place> best_place(const std::vector<Place>& places) {
  const auto best =
      std::max_element(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.score < b.score; });
  if (best == places.end() || !(best->score > 0)) return std::nullopt;
  return *best;
}

std::vector<Vec3> places_around(const PlacedBvh& bvh, const std::vector<Place>& places, const Vec3& point,
                                std::size_t most) {
  std::vector<Place> seen;
  for (const Place& place : places)
    if (place.score > 0 && (place.point == point || !bvh.blocks(point, place.point))) seen.push_back(place);
  const std::optional<Place> best = best_place(seen);
  std::vector<Vec3> around;
  for (const Place& place : seen)
    if (around.size() < most && !(place.point == point) && place.score >= 0.5 * best->score)
      around.push_back(place.point);
  return around;
}

}  // namespace papilla::detail
