// SPDX-License-Identifier: MIT
#include "papilla/texture/grain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "checks.hpp"
#include "leather.hpp"
#include "papilla/core/error.hpp"
#include "papilla/texture/shading.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

constexpr std::array<std::pair<GrainKind, std::string_view>, 10> k_names = {{{GrainKind::spheres6, "spheres6"},
                                                                             {GrainKind::spheres8, "spheres8"},
                                                                             {GrainKind::quads6, "quads6"},
                                                                             {GrainKind::quads8, "quads8"},
                                                                             {GrainKind::ovals6, "ovals6"},
                                                                             {GrainKind::ovals8, "ovals8"},
                                                                             {GrainKind::sine, "sine"},
                                                                             {GrainKind::gaussian, "gaussian"},
                                                                             {GrainKind::fourier, "fourier"},
                                                                             {GrainKind::leather, "leather"}}};

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
      return texture_detail::shaped_noise(options.size_px, options.size_px, options.seed, [=](double x, double y) {
        const double wave = std::numbers::pi * length * std::hypot(x, y);
        return x == 0 && y == 0 ? 0 : std::exp(-wave * wave / 2);
      });
    }
    case GrainKind::fourier: {
      constexpr int k_most_waves = 12;
      return texture_detail::shaped_noise(options.size_px, options.size_px, options.seed, [&](double x, double y) {
        const double waves = options.size_px * std::hypot(x, y);
        return waves > 0 && waves <= k_most_waves ? 1 / waves : 0;
      });
    }
    case GrainKind::leather: return texture_detail::leather_relief(options.size_px, options.size_mm, options.seed);
  }
  throw InvalidInput("synthesize_grain: unknown kind");
}

void require_options(const GrainOptions& options) {
  if (options.size_px < 16 || options.size_px > 8192)
    throw InvalidInput("synthesize_grain: size " + std::to_string(options.size_px) +
                       " pixels is not within 16 to 8192");
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(options.size_mm) || !positive(options.height_mm))
    throw InvalidInput("synthesize_grain: size " + std::to_string(options.size_mm) + " mm and height " +
                       std::to_string(options.height_mm) + " mm must be positive");
  texture_detail::require_light(options.light, "synthesize_grain");
}

}  // namespace

std::string_view to_string(GrainKind kind) noexcept {
  for (const auto& [value, name] : k_names)
    if (value == kind) return name;
  return "unknown";
}

std::vector<std::string_view> grain_names() {
  std::vector<std::string_view> names;
  for (const auto& entry : k_names) names.push_back(entry.second);
  return names;
}

GrainKind grain_kind(std::string_view name) {
  std::string known;
  for (const auto& [value, text] : k_names) {
    if (text == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw InvalidInput("grain_kind: '" + std::string(name) + "' is not one of " + known);
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
