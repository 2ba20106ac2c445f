// SPDX-License-Identifier: MIT
#include "seam_weights.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "papilla/core/bounds.hpp"
#include "papilla/core/units.hpp"
#include "triangle_bvh.hpp"

namespace papilla::detail {
namespace {

constexpr double k_least_openness = 0.2;
/// Openness varies slowly: this many places are looked at, and every triangle takes the nearest one's over the surface.
constexpr std::size_t k_places = 2048;
constexpr int k_rays = 24;
/// Sight lines end at this fraction of the surface's diagonal.
constexpr double k_sight = 0.5;

Vec3 centroid(const SegmentedMesh& surface, Index t) {
  const Triangle& c = surface.triangles[t];
  return (1.0 / 3) * (surface.positions[c[0]] + surface.positions[c[1]] + surface.positions[c[2]]);
}

/// The share of a cosine-weighted hemisphere's directions that meet nothing.
double openness_at(const TriangleBvh& tree, const Vec3& p, const Vec3& normal, Index own, double sight) {
  const Vec3 helper = std::abs(normal.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 e = normalized(cross(normal, helper)), f = cross(normal, e);
  int open = 0;
  for (int i = 0; i < k_rays; ++i) {
    const double r = std::sqrt((i + 0.5) / k_rays), angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vec3 d = std::sqrt(1 - r * r) * normal + r * std::cos(angle) * e + r * std::sin(angle) * f;
    open += !tree.blocks(p + 1e-6 * sight * normal, p + sight * d, own);
  }
  return static_cast<double>(open) / k_rays;
}

std::vector<Index> choose_places(const SegmentedMesh& surface) {
  double total = 0;
  for (const double a : surface.area) total += a;
  std::vector<Index> places;
  double sum = 0;
  for (Index t = 0; t < surface.size(); ++t) {
    sum += surface.area[t];
    if (surface.area[t] > 0 && sum * k_places >= static_cast<double>(places.size()) * total) places.push_back(t);
  }
  return places;
}

}  // namespace

std::vector<float> triangle_openness(const SegmentedMesh& surface) {
  std::vector<float> open(surface.size(), -1);
  Bounds3 bounds;
  for (const Triangle& t : surface.triangles)
    for (const Index v : t) bounds.add(surface.positions[v]);
  const double sight = k_sight * bounds.diagonal();
  std::vector<Index> places = choose_places(surface);
  const TriangleBvh tree(surface.positions, surface.triangles);
  oneapi::tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    const Index t = places[i];
    open[t] = static_cast<float>(openness_at(tree, centroid(surface, t), surface.normal[t], t, sight));
  });
  for (std::size_t i = 0; i < places.size(); ++i)
    for (Index h = 3 * places[i]; h < 3 * places[i] + 3; ++h) {
      if (surface.opposite[h] == k_none) continue;
      const Index other = triangle_of(surface.opposite[h]);
      if (open[other] >= 0) continue;
      open[other] = open[places[i]];
      places.push_back(other);
    }
  for (float& o : open)
    if (o < 0) o = 1;
  return open;
}

std::vector<float> openness_to(const SegmentedMesh& surface, const Vec3& eye) {
  std::vector<float> open(surface.size());
  const TriangleBvh tree(surface.positions, surface.triangles);
  oneapi::tbb::parallel_for(Index{0}, static_cast<Index>(surface.size()), [&](Index t) {
    open[t] = tree.blocks(centroid(surface, t), eye, t) ? static_cast<float>(k_least_openness) : 1;
  });
  return open;
}

SeamWeights::SeamWeights(const SegmentedMesh& surface, const std::vector<float>& openness, double feature_angle_deg)
    : surface_(surface), weight_(surface.opposite.size(), 1) {
  const double sharp = feature_angle_deg * k_radians_per_degree;
  for (Index h = 0; h < weight_.size(); ++h) {
    const Index other = surface.opposite[h];
    if (other == k_none || other < h) continue;
    const Index a = triangle_of(h), b = triangle_of(other);
    const double angle =
        std::atan2(norm(cross(surface.normal[a], surface.normal[b])), dot(surface.normal[a], surface.normal[b]));
    const bool concave = dot(centroid(surface, b) - centroid(surface, a), surface.normal[a]) > 0;
    const double crease = std::min(1.0, angle / sharp) * (concave ? 0.75 : 0.5);
    const double seen = std::max(k_least_openness, 0.5 * (double{openness[a]} + double{openness[b]}));
    weight_[h] = weight_[other] = static_cast<float>(seen * (1 - crease));
  }
}

}  // namespace papilla::detail
