// SPDX-License-Identifier: MIT
#include "papilla/texture/photograph_model.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "checks.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/core/units.hpp"
#include "random.hpp"
#include "shaped_noise.hpp"
#include "slopes.hpp"

namespace papilla {
namespace {

using namespace texture_detail;
using Field = std::vector<double>;

void require_within(double value, double least, double most, const char* what) {
  if (value >= least && value <= most) return;
  throw InvalidInput("photograph: " + std::string(what) + " " + std::to_string(value) + " is not within " +
                     std::to_string(least) + " to " + std::to_string(most));
}

void require_options(const HeightMap& relief, const PhotographOptions& options) {
  require_height_map(relief, "photograph", true);
  constexpr double k_same_pitch = 1e-6;
  if (std::abs(relief.pitch_mm_x - relief.pitch_mm_y) > k_same_pitch * relief.pitch_mm_x)
    throw InvalidInput("photograph: the pitch " + std::to_string(relief.pitch_mm_x) + " x " +
                       std::to_string(relief.pitch_mm_y) + " mm is not that of square pixels");
  constexpr double k_most = 0.99, k_most_spots = 0.5, k_most_px = 100, k_most_shininess = 1e4;
  require_within(options.ambient, 0, k_most, "ambient");
  require_within(options.specular.strength, 0, 1 / (1 - k_most), "strength of the highlights");
  require_within(options.specular.shininess, 1, k_most_shininess, "shininess");
  require_within(options.albedo_noise, 0, k_most_spots, "albedo noise");
  require_within(options.albedo_spot_px, 0, k_most_px, "radius of the spots");
  require_within(options.valley_darkening, 0, k_most, "valley darkening");
  require_within(options.vignette, 0, k_most, "vignette");
  require_within(options.uneven_light, 0, k_most, "uneven light");
  require_within(options.blur_px, 0, k_most_px, "blur");
  require_within(options.noise, 0, 1, "noise");
  require_within(options.mean_grey, 1e-3, 1, "mean grey");
  require_within(options.clipped, 0, 1, "clipped share");
  if (options.bits != 8 && options.bits != 32)
    throw InvalidInput("photograph: " + std::to_string(options.bits) + " bits are neither 8 nor 32");
}

/// Radius of a surface's spots, 1 to 8 pixels.
double spot_px(std::uint64_t surface_seed) {
  constexpr double k_largest_px = 8;
  Random random(surface_seed);
  random.uniform(), random.uniform();  // Where seed and surface_seed are the same, these are the light's.
  return std::pow(k_largest_px, random.uniform());
}

/// Keep the random choices of one seed apart.
constexpr std::uint64_t k_noise_stream = 0x9e3779b97f4a7c15, k_uneven_stream = 0xbf58476d1ce4e5b9;

/// The heights between the samples, in units of the pitch.
class Ground {
 public:
  explicit Ground(const HeightMap& relief) : relief_(relief) {
    const auto [low, high] = std::minmax_element(relief.mm.begin(), relief.mm.end());
    top_ = static_cast<double>(*high) / relief.pitch_mm_x;
  }
  double top() const { return top_; }
  double at(int x, int y) const { return static_cast<double>(relief_.at(x, y)) / relief_.pitch_mm_x; }
  bool covers(double x, double y) const {
    return relief_.periodic || (x >= 0 && y >= 0 && x <= relief_.width - 1 && y <= relief_.height - 1);
  }
  double between(double x, double y) const {
    const double left = std::floor(x), above = std::floor(y), fx = x - left, fy = y - above;
    const int x0 = column(static_cast<int>(left)), x1 = column(static_cast<int>(left) + 1);
    const int y0 = row(static_cast<int>(above)), y1 = row(static_cast<int>(above) + 1);
    return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x1, y0)) + fy * ((1 - fx) * at(x0, y1) + fx * at(x1, y1));
  }

 private:
  int column(int x) const { return relief_.periodic ? wrapped(x, relief_.width) : std::clamp(x, 0, relief_.width - 1); }
  int row(int y) const { return relief_.periodic ? wrapped(y, relief_.height) : std::clamp(y, 0, relief_.height - 1); }
  const HeightMap& relief_;
  double top_ = 0;
};

/// Whether the line from a sample to the light meets no higher ground.
bool sees_light(const Ground& ground, int x, int y, Vec3 light) {
  const double across = std::hypot(light.x, light.y);
  if (!(across > 0)) return true;
  const double rise = light.z / across, start = ground.at(x, y);
  constexpr double k_rounding = 1e-9;  // Of the heights: a plane does not shade itself.
  for (int step = 1;; ++step) {
    const double line = start + rise * step;
    const double at_x = x + light.x / across * step, at_y = y + light.y / across * step;
    if (line >= ground.top() || !ground.covers(at_x, at_y)) return true;
    if (ground.between(at_x, at_y) > line + k_rounding * ground.top()) return false;
  }
}

/// Relative albedo of every sample.
Field albedo_of(const HeightMap& relief, const PhotographOptions& options) {
  Field albedo(relief.mm.size(), 1.0);
  if (options.albedo_noise > 0) {
    const double radius = options.albedo_spot_px;
    const Field spots = shaped_noise(relief.width, relief.height, options.surface_seed, [=](double u, double v) {
      const double wave = 2 * std::numbers::pi * radius * std::hypot(u, v);
      return u == 0 && v == 0 ? 0 : std::exp(-wave * wave / 2);
    });
    constexpr double k_darkest = 0.05;
    for (std::size_t i = 0; i < albedo.size(); ++i)
      albedo[i] = std::max(k_darkest, 1 + options.albedo_noise * spots[i]);
  }
  const auto [low, high] = std::minmax_element(relief.mm.begin(), relief.mm.end());
  const double lowest = static_cast<double>(*low), range = static_cast<double>(*high) - lowest;
  for (std::size_t i = 0; i < albedo.size() && range > 0; ++i)
    albedo[i] *= 1 - options.valley_darkening * (1 - (static_cast<double>(relief.mm[i]) - lowest) / range);
  return albedo;
}

struct Radiance {
  Field values;
  double shadows_fraction = 0;
};

Radiance radiance_of(const HeightMap& relief, const PhotographOptions& options, Vec3 light) {
  const Ground ground(relief);
  const Vec3 halfway = normalized(light + Vec3{0, 0, 1});
  Radiance radiance{albedo_of(relief, options), 0};
  std::vector<int> shadows(static_cast<std::size_t>(relief.height), 0);
  oneapi::tbb::parallel_for(0, relief.height, [&](int y) {
    for (int x = 0; x < relief.width; ++x) {
      const Vec2 g = slope(relief, x, y);
      const Vec3 normal = normalized(Vec3{-g.x, -g.y, 1});
      const double cosine = dot(normal, light);
      const bool lit = cosine > 0 && (!options.cast_shadows || sees_light(ground, x, y, light));
      if (!lit) ++shadows[static_cast<std::size_t>(y)];
      double& value = radiance.values[relief.index(x, y)];
      const double gloss =
          lit && options.specular.strength > 0
              ? options.specular.strength * std::pow(std::max(0.0, dot(normal, halfway)), options.specular.shininess)
              : 0;
      value = value * (options.ambient + (1 - options.ambient) * (lit ? cosine : 0)) + (1 - options.ambient) * gloss;
    }
  });
  radiance.shadows_fraction =
      std::accumulate(shadows.begin(), shadows.end(), 0.0) / static_cast<double>(relief.mm.size());
  return radiance;
}

void make_uneven(Field& radiance, const HeightMap& relief, const PhotographOptions& options) {
  const double direction = 2 * std::numbers::pi * Random(options.seed ^ k_uneven_stream).uniform();
  const Vec2 along{std::cos(direction), std::sin(direction)};
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const Vec2 place{2 * (x + 0.5) / relief.width - 1, 2 * (y + 0.5) / relief.height - 1};
      radiance[relief.index(x, y)] *= (1 + options.uneven_light * std::clamp(dot(place, along), -1.0, 1.0)) *
                                      (1 - options.vignette * dot(place, place) / 2);
    }
}

void expose(Field& radiance, const PhotographOptions& options) {
  const double mean = std::accumulate(radiance.begin(), radiance.end(), 0.0) / static_cast<double>(radiance.size());
  if (!(mean > 0)) return;
  Field sorted = radiance;
  const auto rank = static_cast<std::size_t>((1 - options.clipped) * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank), sorted.end());
  const double bright = sorted[rank];
  const double scale = std::min(options.mean_grey / mean, bright > 0 ? 1 / bright : options.mean_grey / mean);
  for (double& value : radiance) value *= scale;
}

}  // namespace

Photograph photograph(const HeightMap& relief, const PhotographOptions& options) {
  require_options(relief, options);
  const Vec3 light = require_light(options.light, "photograph");
  Radiance radiance = radiance_of(relief, options, light);
  Field& values = radiance.values;
  make_uneven(values, relief, options);
  if (options.blur_px > 0)
    filter(values, relief.width, relief.height, relief.periodic, [&](double u, double v) {
      const double wave = 2 * std::numbers::pi * options.blur_px * std::hypot(u, v);
      return std::exp(-wave * wave / 2);
    });
  expose(values, options);
  Photograph result;
  result.shadows_fraction = radiance.shadows_fraction;
  result.picture = {relief.width, relief.height, {}, relief.pitch_mm_x, options.bits};
  result.picture.pixels.reserve(values.size());
  Random random(options.seed ^ k_noise_stream);
  constexpr double k_white = 255;
  for (const double value : values) {
    const double linear = std::clamp(value + options.noise * random.normal(), 0.0, 1.0);
    const double encoded = options.srgb ? srgb_from_linear(linear) : linear;
    if (linear >= 1) result.clipped_fraction += 1;
    result.picture.pixels.push_back(
        static_cast<float>(options.bits == 8 ? std::round(k_white * encoded) / k_white : encoded));
  }
  result.clipped_fraction /= static_cast<double>(values.size());
  return result;
}

PhotographOptions photograph_options(PhotographCondition condition, std::uint64_t seed) {
  return photograph_options(condition, seed, seed);
}

PhotographOptions photograph_options(PhotographCondition condition, std::uint64_t seed, std::uint64_t surface_seed) {
  Random random(seed);
  const double azimuth = 2 * std::numbers::pi * random.uniform();
  constexpr double k_lowest_deg = 25, k_highest_deg = 55;
  const double elevation = (k_lowest_deg + (k_highest_deg - k_lowest_deg) * random.uniform()) * k_radians_per_degree;
  PhotographOptions options;
  options.light = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                   std::sin(elevation)};
  options.vignette = 0.1;
  options.blur_px = 0.7;
  options.noise = 0.01;
  options.surface_seed = surface_seed, options.seed = seed;
  if (condition == PhotographCondition::spotted) {
    options.albedo_noise = 0.08;
    options.albedo_spot_px = spot_px(surface_seed);
    options.uneven_light = 0.15;
  }
  if (condition == PhotographCondition::glossy) {
    options.valley_darkening = 0.15;
    options.specular.strength = 0.25;
  }
  return options;
}

}  // namespace papilla
