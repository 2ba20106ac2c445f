// SPDX-License-Identifier: MIT
#include "leather.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "checks.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "random.hpp"

namespace papilla::texture_detail {
namespace {

/// Random points, one in each cell of a periodic grid of `side` × `side`, in units of the grid's cells.
class PebblePoints {
 public:
  PebblePoints(int side, double jitter, Random& random) : side_(side) {
    for (int i = 0; i < side * side; ++i) {
      const double x = random.uniform(), y = random.uniform();
      offsets_.push_back({0.5 + jitter * (x - 0.5), 0.5 + jitter * (y - 0.5)});
      heights_.push_back(random.uniform());
    }
  }
  int id(int column, int row) const { return wrapped(row, side_) * side_ + wrapped(column, side_); }
  Vec2 point(int column, int row) const {
    return Vec2{static_cast<double>(column), static_cast<double>(row)} +
           offsets_[static_cast<std::size_t>(id(column, row))];
  }
  double height(int id) const { return heights_[static_cast<std::size_t>(id)]; }

 private:
  int side_;
  std::vector<Vec2> offsets_;
  std::vector<double> heights_;
};

struct PebbleShape {
  double dome;           ///< Exponent of the flank: higher is flatter on top and steeper at the crease.
  double height_spread;  ///< Range of the tops' heights, in crease depths.
};

/// Distance from p to the border of its Voronoi cell, 0 at the border and about 1 at the centre, with the edges that
/// lead from the cell's corners to its centre rounded off. Continuous: the rounding fades towards the border.
double rounded_border_distance(const PebblePoints& points, Vec2 p, int own_column, int own_row) {
  constexpr double k_rounding = 0.2;
  constexpr double k_least_flank = 0.42;  // Close pairs of points would make creases as steep as walls.
  const Vec2 own = points.point(own_column, own_row);
  std::array<double, 24> distances{};
  std::size_t count = 0;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      if (i == 0 && j == 0) continue;
      const Vec2 other = points.point(own_column + i, own_row + j), across = other - own;
      const double half = norm(across) / 2;
      const double distance = dot(0.5 * (own + other) - p, across) / norm(across);
      distances[count++] = std::max(0.0, distance / std::max(half, k_least_flank));
    }
  const double least = *std::min_element(distances.begin(), distances.end());
  const double softness = k_rounding * least;
  if (!(softness > 0)) return 0;
  double sum = 0;
  for (const double distance : distances)
    if (distance < least + 8 * softness) sum += std::exp((least - distance) / softness);
  return std::max(0.0, least - softness * std::log(sum));
}

/// Height at p: the dome of its Voronoi cell, which falls to −`crease` on every border.
double pebble_height(const PebblePoints& points, Vec2 p, const PebbleShape& shape, double crease) {
  const int column = static_cast<int>(std::floor(p.x)), row = static_cast<int>(std::floor(p.y));
  int own_column = column, own_row = row;
  double nearest = 1e300;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      const double distance = norm(points.point(column + i, row + j) - p);
      if (distance < nearest) {
        nearest = distance;
        own_column = column + i;
        own_row = row + j;
      }
    }
  const double inside = std::min(1.0, rounded_border_distance(points, p, own_column, own_row));
  const double flank = std::pow(1 - inside, shape.dome);
  return shape.height_spread * points.height(points.id(own_column, own_row)) * (1 - flank) - crease * flank;
}

int cells(double size_mm, double pebble_mm) { return std::max(3, static_cast<int>(std::lround(size_mm / pebble_mm))); }

}  // namespace

std::vector<double> leather_relief(int size_px, double size_mm, std::uint64_t seed) {
  constexpr double k_pebble_mm = 1.7, k_wrinkle_mm = 0.6;
  constexpr double k_wrinkle_height = 0.16, k_roughness_height = 0.025, k_undulation_height = 0.1;
  constexpr double k_warp_cells = 0.13;  // Bends the straight Voronoi borders; little enough not to fold the plane.
  const double pitch = size_mm / size_px;
  const auto waves = [&](double shortest_mm, double longest_mm, double hurst, std::uint64_t stream) {
    // At least one wave of the tile and nothing that the samples can't hold.
    const double longest = std::min(static_cast<double>(size_px), std::max(longest_mm / pitch, 4.0));
    const double shortest = std::clamp(shortest_mm / pitch, 2.0, 0.75 * longest);
    return spectral_surface({size_px, hurst, shortest, longest, seed * 16 + stream}).heights;
  };
  const std::vector<double> warp_x = waves(2.5, 8, 0.6, 1), warp_y = waves(2.5, 8, 0.6, 2);
  const std::vector<double> roughness = waves(0, 1, 0.6, 3), undulation = waves(6, 25, 0.5, 4);
  const std::vector<double> crease_depth = waves(1.5, 8, 0.3, 5);  // Some creases are deep folds, some hardly there.

  Random random(seed);
  const int pebbles = cells(size_mm, k_pebble_mm), wrinkles = cells(size_mm, k_wrinkle_mm);
  const PebblePoints coarse(pebbles, 0.8, random), fine(wrinkles, 0.8, random);
  std::vector<double> relief(static_cast<std::size_t>(size_px) * static_cast<std::size_t>(size_px));
  oneapi::tbb::parallel_for(0, size_px, [&](int y) {
    for (int x = 0; x < size_px; ++x) {
      const std::size_t i = pixel_index(x, y, size_px);
      const Vec2 warp{k_warp_cells * warp_x[i], k_warp_cells * warp_y[i]};
      const Vec2 p{(x + 0.5) / size_px, (y + 0.5) / size_px};
      const double crease = std::clamp(0.7 + 0.25 * crease_depth[i], 0.2, 1.2);
      const double pebble = pebble_height(coarse, static_cast<double>(pebbles) * p + warp, {2.5, 0.3}, crease);
      const double wrinkle = pebble_height(fine, static_cast<double>(wrinkles) * p + 1.5 * warp, {1.5, 0.2}, 0.6);
      relief[i] =
          pebble + k_wrinkle_height * wrinkle + k_roughness_height * roughness[i] + k_undulation_height * undulation[i];
    }
  });
  return relief;
}

}  // namespace papilla::texture_detail
