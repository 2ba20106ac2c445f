// SPDX-License-Identifier: MIT
#include "papilla/texture/test_relief.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "random.hpp"
#include "slopes.hpp"

namespace papilla {
namespace {

using namespace texture_detail;
using Field = std::vector<double>;
constexpr double k_pi = std::numbers::pi;

/// The irregular ones are made on a square and cut.
template <class Square>
Field cut_from(const TestReliefOptions& options, const Square& square) {
  Field field;
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) field.push_back(square(x, y));
  return field;
}

Field grain(GrainKind kind, double pixels_per_tile, const TestReliefOptions& options) {
  const int longest = std::max(options.width, options.height);
  const double tiles = longest / pixels_per_tile;
  constexpr double k_tile_mm = 40, k_depth = 0.02;  // The depth matters to the shape of spheres only.
  const GrainResult made = synthesize_grain(
      kind, {.size_px = longest, .size_mm = k_tile_mm * tiles, .height_mm = k_depth * k_tile_mm, .seed = options.seed});
  return cut_from(options, [&](int x, int y) { return static_cast<double>(made.relief.at(x, y)); });
}

Field fractal(const TestReliefOptions& options) {
  constexpr double k_hurst = 0.7, k_shortest_px = 4;
  const int longest = std::max(options.width, options.height);
  const HeightGrid grid = spectral_surface({.size = longest,
                                            .hurst = k_hurst,
                                            .shortest_wavelength_px = k_shortest_px,
                                            .longest_wavelength_px = longest / 2.0,
                                            .seed = options.seed});
  return cut_from(options, [&](int x, int y) { return grid.at(x, y); });
}

/// Heights of a formula in a frame that is turned and moved.
Field by_formula(const TestReliefOptions& options, double degrees, const std::function<double(Vec2)>& height) {
  Random random(options.seed);
  const double angle = degrees * k_radians_per_degree;
  const Vec2 along{std::cos(angle), std::sin(angle)}, moved{100 * random.uniform(), 100 * random.uniform()};
  return cut_from(options, [&](int x, int y) {
    const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
    return height(moved + Vec2{dot(p, along), cross(along, p)});
  });
}

/// x − round(x), in [−½, ½].
double from_nearest(double x) { return x - std::round(x); }

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double weave(Vec2 p) {
  constexpr double k_across_px = 17, k_down_px = 13, k_roundness = 0.8;
  const double u = p.x / k_across_px, v = p.y / k_down_px;
  const auto thread = [](double offset) { return std::sqrt(std::max(0.0, 1 - std::pow(2 * offset * k_roundness, 2))); };
  const double phase = k_pi * (std::round(u) + std::round(v));
  const double warp = thread(from_nearest(u)) + 0.6 * std::cos(phase) * std::cos(k_pi * from_nearest(v));
  const double weft = thread(from_nearest(v)) - 0.6 * std::cos(phase) * std::cos(k_pi * from_nearest(u));
  return std::max(warp, weft);
}

double ribs(Vec2 p) {
  constexpr double k_distance_px = 19, k_wander_px = 6, k_wave_px = 140;
  const double x = p.x + k_wander_px * std::sin(2 * k_pi * p.y / k_wave_px) +
                   k_wander_px * std::sin(2 * k_pi * (p.x + 0.5 * p.y) / (2.3 * k_wave_px));
  return std::pow(std::abs(std::cos(k_pi * x / k_distance_px)), 0.8);
}

double scales(Vec2 p) {
  constexpr double k_length_px = 26, k_width_px = 22, k_steep_share = 0.2;
  const double row = std::floor(p.x / k_length_px);
  const double v = from_nearest(p.y / k_width_px + 0.5 * row);
  double u = p.x / k_length_px - row + 1.2 * v * v;  // Round fronts.
  u -= std::floor(u);
  return u < 1 - k_steep_share ? u / (1 - k_steep_share) : smooth_step((1 - u) / k_steep_share);
}

double knurl(Vec2 p) {
  constexpr double k_across_px = 24, k_down_px = 16, k_flat = 0.12;
  const double u = 2 * std::abs(from_nearest(p.x / k_across_px)), v = 2 * std::abs(from_nearest(p.y / k_down_px));
  return std::min(1 - k_flat, 1 - std::max(u, v));
}

double honeycomb(Vec2 p) {
  constexpr double k_distance_px = 28, k_wall = 0.3;
  const Vec2 q{p.x / k_distance_px, p.y / k_distance_px};
  const double row_height = std::sqrt(3.0);
  const auto nearest = [&](Vec2 r) { return Vec2{from_nearest(r.x), row_height * from_nearest(r.y / row_height)}; };
  const Vec2 a = nearest(q), b = nearest(q - Vec2{0.5, row_height / 2});
  const Vec2 c = dot(a, a) < dot(b, b) ? a : b;
  double border = 0;  // 1 on the border of the cell, 0 at its centre.
  for (const double degrees : {0.0, 60.0, 120.0}) {
    const double angle = degrees * k_radians_per_degree;
    border = std::max(border, 2 * std::abs(c.x * std::cos(angle) + c.y * std::sin(angle)));
  }
  return smooth_step((border - (1 - k_wall)) / k_wall * 1.2) - 0.25 * (1 - border);
}

struct Bump {
  Vec2 centre;
  double radius = 0, height = 0;
};

std::vector<Bump> random_bumps(const TestReliefOptions& options, double px_per_bump, double least_px, double most_px) {
  Random random(options.seed);
  const auto count = static_cast<std::size_t>(options.width * options.height / (px_per_bump * px_per_bump));
  std::vector<Bump> bumps(std::max<std::size_t>(count, 1));
  for (Bump& bump : bumps) {
    bump.centre = {options.width * random.uniform(), options.height * random.uniform()};
    const double size = random.uniform();
    bump.radius = least_px + (most_px - least_px) * size * size;
    bump.height = bump.radius * (0.7 + 0.6 * random.uniform());
  }
  return bumps;
}

Field dents(const TestReliefOptions& options) {
  const std::vector<Bump> pits = random_bumps(options, 26, 5, 16);
  return cut_from(options, [&](int x, int y) {
    double deepest = 0;
    for (const Bump& pit : pits) {
      const double rho = norm(Vec2{static_cast<double>(x), static_cast<double>(y)} - pit.centre) / pit.radius;
      if (rho < 1) deepest = std::min(deepest, -pit.height * (1 - rho * rho) * (1 - rho * rho));
    }
    return deepest;
  });
}

Field pebbles(const TestReliefOptions& options) {
  const std::vector<Bump> domes = random_bumps(options, 12, 8, 22);
  return cut_from(options, [&](int x, int y) {
    double top = 0;
    for (const Bump& dome : domes) {
      const double rho = norm(Vec2{static_cast<double>(x), static_cast<double>(y)} - dome.centre) / dome.radius;
      if (rho < 1) top = std::max(top, dome.height * std::sqrt(1 - rho * rho * (2 - rho * rho) * 0.999));
    }
    return top;
  });
}

Field emboss(const TestReliefOptions& options) {
  constexpr double k_px_per_stroke = 46, k_half_px = 5, k_flank_px = 5;
  Random random(options.seed);
  struct Stroke {
    Vec2 from, to;
  };
  std::vector<Stroke> strokes(
      static_cast<std::size_t>(options.width * options.height / (k_px_per_stroke * k_px_per_stroke)) + 1);
  for (Stroke& stroke : strokes) {
    stroke.from = {options.width * random.uniform(), options.height * random.uniform()};
    const double angle = 2 * k_pi * random.uniform(), length = 15 + 35 * random.uniform();
    stroke.to = stroke.from + length * Vec2{std::cos(angle), std::sin(angle)};
  }
  return cut_from(options, [&](int x, int y) {
    const Vec2 p{static_cast<double>(x), static_cast<double>(y)};
    double nearest = 1e300;
    for (const Stroke& stroke : strokes) {
      const Vec2 along = stroke.to - stroke.from;
      const double t = std::clamp(dot(p - stroke.from, along) / dot(along, along), 0.0, 1.0);
      nearest = std::min(nearest, norm(p - stroke.from - t * along));
    }
    return 1 - smooth_step((nearest - k_half_px) / k_flank_px);
  });
}

/// Scales the relief to the rms slope and puts its lowest point at 0.
HeightMap scaled(const Field& field, const TestReliefOptions& options) {
  HeightMap map{options.width, options.height, {}, options.pitch_mm, options.pitch_mm, false};
  for (const double height : field) map.mm.push_back(static_cast<float>(height * options.pitch_mm));
  double squares = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Vec2 g = slope(map, x, y);
      squares += dot(g, g);
    }
  const double scale = options.rms_slope / std::sqrt(squares / static_cast<double>(field.size()));
  const float low = *std::min_element(map.mm.begin(), map.mm.end());
  for (float& mm : map.mm) mm = static_cast<float>(scale * (static_cast<double>(mm) - static_cast<double>(low)));
  return map;
}

struct Recipe {
  std::string_view name;
  Field (*heights)(const TestReliefOptions&);
};

constexpr double k_grain_px = 256;  ///< Samples of a grain's tile.

constexpr std::array<Recipe, 16> k_recipes = {{
    {"spheres", [](const TestReliefOptions& o) { return grain(GrainKind::spheres8, k_grain_px, o); }},
    {"quads", [](const TestReliefOptions& o) { return grain(GrainKind::quads6, k_grain_px, o); }},
    {"ovals", [](const TestReliefOptions& o) { return grain(GrainKind::ovals6, k_grain_px, o); }},
    {"sine", [](const TestReliefOptions& o) { return grain(GrainKind::sine, k_grain_px, o); }},
    {"gaussian", [](const TestReliefOptions& o) { return grain(GrainKind::gaussian, 2 * k_grain_px, o); }},
    {"fourier", [](const TestReliefOptions& o) { return grain(GrainKind::fourier, k_grain_px, o); }},
    {"leather", [](const TestReliefOptions& o) { return grain(GrainKind::leather, 2 * k_grain_px, o); }},
    {"fractal", fractal},
    {"weave", [](const TestReliefOptions& o) { return by_formula(o, 17, weave); }},
    {"ribs", [](const TestReliefOptions& o) { return by_formula(o, 33, ribs); }},
    {"dents", dents},
    {"emboss", emboss},
    {"scales", [](const TestReliefOptions& o) { return by_formula(o, 62, scales); }},
    {"knurl", [](const TestReliefOptions& o) { return by_formula(o, 24, knurl); }},
    {"honeycomb", [](const TestReliefOptions& o) { return by_formula(o, 9, honeycomb); }},
    {"pebbles", pebbles},
}};

}  // namespace

std::vector<std::string_view> test_relief_names() {
  std::vector<std::string_view> names;
  for (const Recipe& recipe : k_recipes) names.push_back(recipe.name);
  return names;
}

HeightMap test_relief(std::string_view name, const TestReliefOptions& options) {
  constexpr int k_least = 64, k_most = 4096;
  if (std::min(options.width, options.height) < k_least || std::max(options.width, options.height) > k_most)
    throw InvalidInput("test_relief: " + std::to_string(options.width) + " x " + std::to_string(options.height) +
                       " samples are not within 64 to 4096 a side");
  if (!is_positive(options.pitch_mm) || !is_positive(options.rms_slope))
    throw InvalidInput("test_relief: pitch " + std::to_string(options.pitch_mm) + " mm and slope " +
                       std::to_string(options.rms_slope) + " must be positive");
  const std::vector<std::string_view> names = test_relief_names();
  return scaled(k_recipes[index_of_name(name, names, "test_relief")].heights(options), options);
}

}  // namespace papilla
