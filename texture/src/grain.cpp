// SPDX-License-Identifier: MIT
#include "papilla/texture/grain.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "random.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

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
/// lead from the cell's corners to its centre rounded off. Continuous: the rounding tends to 0 towards the border.
double rounded_border_distance(const PebblePoints& points, Vec2 p, int own_column, int own_row) {
  constexpr double k_rounding = 0.2;
  constexpr double k_least_flank = 0.42;  // Close pairs of points would make vertical creases.
  const Vec2 own = points.point(own_column, own_row);
  std::array<double, 24> distances{};
  std::size_t count = 0;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      if (i == 0 && j == 0) continue;
      const Vec2 other = points.point(own_column + i, own_row + j), across = other - own;
      const double length = std::sqrt(dot(across, across));
      const double distance = dot(0.5 * (own + other) - p, across) / length;
      distances[count++] = std::max(0.0, distance / std::max(0.5 * length, k_least_flank));
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
      const Vec2 way = points.point(column + i, row + j) - p;
      const double square = dot(way, way);
      if (square < nearest) {
        nearest = square;
        own_column = column + i;
        own_row = row + j;
      }
    }
  const double inside = std::min(1.0, rounded_border_distance(points, p, own_column, own_row));
  const double flank = std::pow(1 - inside, shape.dome);
  return shape.height_spread * points.height(points.id(own_column, own_row)) * (1 - flank) - crease * flank;
}

int cells(double size_mm, double pebble_mm) { return std::max(3, static_cast<int>(std::lround(size_mm / pebble_mm))); }

/// Periodic leather-like relief of size_px² samples over size_mm, in arbitrary units.
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
  const Values<double> warp_x = waves(2.5, 8, 0.6, 1), warp_y = waves(2.5, 8, 0.6, 2);
  const Values<double> roughness = waves(0, 1, 0.6, 3), undulation = waves(6, 25, 0.5, 4);
  const Values<double> crease_depth = waves(1.5, 8, 0.3, 5);  // Some creases are deep folds, some hardly there.

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

constexpr std::array<std::string_view, 10> k_names = {"spheres6", "spheres8", "quads6",   "quads8",  "ovals6",
                                                      "ovals8",   "sine",     "gaussian", "fourier", "leather"};

/// Elements on a torus: `columns` × `rows`, each row moved on by `shift` of the distance of two elements.
struct Layout {
  int columns, rows;
  double shift;
};

/// Height of the element, 0 to 1, at an offset from its centre in millimetres.
using Element = std::function<double(Vec2)>;

constexpr double k_fill = 0.42;  // Half-axis of an element, of the distance of two.

/// Segment of a sphere of base radius 1: how high it is over ρ when its height is `height` of its base radius.
double sphere_segment(double rho, double height) {
  if (rho >= 1) return 0;
  const double radius = (1 + height * height) / (2 * height);
  return (std::sqrt(radius * radius - rho * rho) - (radius - height)) / height;
}

Element segment(double half_x, double half_y, double height_mm) {
  // Heights beyond the base radius give half an ellipsoid.
  const double height = std::min(1.0, height_mm / std::sqrt(half_x * half_y));
  return [=](Vec2 offset) { return sphere_segment(std::hypot(offset.x / half_x, offset.y / half_y), height); };
}

/// Square block with rounded corners and edges.
Element block(double half) {
  const double corner = 0.3 * half, edge = 0.35 * half;
  return [=](Vec2 offset) {
    const double x = std::abs(offset.x) - (half - corner), y = std::abs(offset.y) - (half - corner);
    const double inside = corner - (std::hypot(std::max(x, 0.0), std::max(y, 0.0)) + std::min(std::max(x, y), 0.0));
    const double t = std::clamp(inside / edge, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
}

/// Height, 0 to 1, at a point of the tile; elements do not overlap.
double element_height(const Layout& layout, const Element& element, Vec2 p, double size_mm) {
  const double dx = size_mm / layout.columns, dy = size_mm / layout.rows;
  const double row = std::floor(p.y / dy);
  const double start = layout.shift * row * dx;
  const double x = p.x - start - dx * std::floor((p.x - start) / dx);
  return element({x - dx / 2, p.y - row * dy - dy / 2});
}

/// Mean over each sample's square, so that rims are smooth at any resolution.
std::vector<double> sampled(const GrainOptions& options, const std::function<double(Vec2)>& height) {
  constexpr int k_subsamples = 4;
  const double pitch = options.size_mm / options.size_px;
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(options.size_px) * static_cast<std::size_t>(options.size_px));
  for (int y = 0; y < options.size_px; ++y)
    for (int x = 0; x < options.size_px; ++x) {
      double sum = 0;
      for (int j = 0; j < k_subsamples; ++j)
        for (int i = 0; i < k_subsamples; ++i)
          sum += height({(x + (i + 0.5) / k_subsamples) * pitch, (y + (j + 0.5) / k_subsamples) * pitch});
      values.push_back(sum / (k_subsamples * k_subsamples));
    }
  return values;
}

std::vector<double> elements(const GrainOptions& options, const Layout& layout, const Element& element) {
  return sampled(options, [&](Vec2 p) { return element_height(layout, element, p, options.size_mm); });
}

std::vector<double> grain_heights(GrainKind kind, const GrainOptions& options) {
  const auto square = [&](int count, bool spheres) {
    const double half = k_fill * options.size_mm / count;
    return elements(options, {count, count, 0}, spheres ? segment(half, half, options.height_mm) : block(half));
  };
  const auto staggered = [&](int rows) {
    constexpr int k_columns = 5;
    const Layout layout{k_columns, rows, static_cast<double>(rows / 2) / rows};
    return elements(options, layout,
                    segment(k_fill * options.size_mm / k_columns, k_fill * options.size_mm / rows, options.height_mm));
  };
  switch (kind) {
    case GrainKind::spheres6: return square(6, true);
    case GrainKind::spheres8: return square(8, true);
    case GrainKind::quads6: return square(6, false);
    case GrainKind::quads8: return square(8, false);
    case GrainKind::ovals6: return staggered(11);
    case GrainKind::ovals8: return staggered(17);
    case GrainKind::sine: {
      const double wave = 2 * std::numbers::pi * 8 / options.size_mm;
      return sampled(options, [=](Vec2 p) { return std::sin(wave * p.x) * std::sin(wave * p.y); });
    }
    case GrainKind::gaussian: {
      constexpr double k_correlation_mm = 0.5;  // Half of what separates roughness from relief.
      const double length = k_correlation_mm * options.size_px / options.size_mm;
      return shaped_noise(options.size_px, options.size_px, options.seed, [=](double x, double y) {
        const double wave = std::numbers::pi * length * std::hypot(x, y);
        return x == 0 && y == 0 ? 0 : std::exp(-wave * wave / 2);
      });
    }
    case GrainKind::fourier: {
      constexpr int k_most_waves = 12;
      return shaped_noise(options.size_px, options.size_px, options.seed, [&](double x, double y) {
        const double waves = options.size_px * std::hypot(x, y);
        return waves > 0 && waves <= k_most_waves ? 1 / waves : 0;
      });
    }
    case GrainKind::leather: return leather_relief(options.size_px, options.size_mm, options.seed);
  }
  throw InvalidInput("synthesize_grain: unknown kind");
}

void require_options(const GrainOptions& options) {
  if (options.size_px < 16 || options.size_px > 8192)
    throw InvalidInput("synthesize_grain: size " + std::to_string(options.size_px) +
                       " pixels is not within 16 to 8192");
  if (!is_positive(options.size_mm) || !is_positive(options.height_mm))
    throw InvalidInput("synthesize_grain: size " + std::to_string(options.size_mm) + " mm and height " +
                       std::to_string(options.height_mm) + " mm must be positive");
  require_light(options.light, "synthesize_grain");
}

}  // namespace

std::string_view to_string(GrainKind kind) noexcept { return k_names[static_cast<std::size_t>(kind)]; }

std::vector<std::string_view> grain_names() { return {k_names.begin(), k_names.end()}; }

GrainKind grain_kind(std::string_view name) {
  return static_cast<GrainKind>(index_of_name(name, k_names, "grain_kind"));
}

GrainResult synthesize_grain(GrainKind kind, const GrainOptions& options) {
  require_options(options);
  const std::vector<double> heights = grain_heights(kind, options);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double offset = *low, range = *high - *low;
  const double pitch = options.size_mm / options.size_px;
  GrainResult result{{options.size_px, options.size_px, {}, pitch, pitch, true}, {}};
  result.relief.mm.reserve(heights.size());
  for (const double height : heights)
    result.relief.mm.push_back(static_cast<float>(range > 0 ? options.height_mm * (height - offset) / range : 0));
  result.picture = render_lambert(result.relief, options.light);
  return result;
}

}  // namespace papilla
