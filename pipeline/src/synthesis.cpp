// SPDX-License-Identifier: MIT
#include "papilla/pipeline/synthesis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/midpoint_surface.hpp"
#include "papilla/texture/spectral_surface.hpp"
#include "papilla/texture/stein_surface.hpp"

namespace papilla {
namespace {

constexpr std::array<std::string_view, 5> k_methods = {"exact", "spectral", "brownian-surface", "cho",
                                                       "brownian-graph"};

/// Memory that surface_like() takes for a pixel of its picture, itself included, at most: measured, 11 on 1024 x 1024.
constexpr std::size_t k_like_bytes_per_pixel = 16;

Synthesis grain(GrainKind kind, const SynthesisOptions& options) {
  GrainResult result = synthesize_grain(kind, {.size_px = options.size_px.value_or(GrainOptions{}.size_px),
                                               .size_mm = options.size_mm,
                                               .height_mm = options.height_mm,
                                               .light = options.light,
                                               .seed = options.seed});
  return {std::string(to_string(kind)), std::move(result.picture), std::move(result.relief), {}, {}};
}

/// Halvings of the side that give at least `size` samples by midpoint displacement.
int midpoint_levels(int size) {
  int levels = 1;
  while ((1 << levels) + 1 < size && levels < 13) ++levels;
  return levels;
}

HeightGrid fractal_surface(const SynthesisOptions& options, FractalSynthesis method, double hurst) {
  const int size = options.size_px.value_or(method == FractalSynthesis::spectral ? 256 : 257);
  if (method == FractalSynthesis::exact) return brownian_surface_exact({size, hurst, options.seed, options.progress});
  if (method == FractalSynthesis::spectral)
    return spectral_surface({.size = size, .hurst = hurst, .seed = options.seed, .progress = options.progress});
  return midpoint_surface({.levels = midpoint_levels(size),
                           .hurst = hurst,
                           .periodic = options.tile,
                           .rule = method == FractalSynthesis::cho ? MidpointRule::cho : MidpointRule::corrected,
                           .seed = options.seed,
                           .progress = options.progress});
}

/// The surface as picture, and as relief of the size and height asked for.
Synthesis from_surface(const SynthesisOptions& options, std::string_view method, const HeightGrid& surface) {
  Synthesis result{std::string(method), to_grey_image(surface), {}, {}, {}};
  const double pitch = options.size_mm / surface.size;
  result.picture.pitch_mm = pitch;
  result.relief = {surface.size, surface.size, result.picture.pixels, pitch, pitch, surface.periodic};
  for (float& height : result.relief.mm) height *= static_cast<float>(options.height_mm);
  return result;
}

/// The graph as a picture of one row.
Synthesis graph(const SynthesisOptions& options, double hurst) {
  const std::vector<double> heights =
      brownian_graph({.levels = midpoint_levels(options.size_px.value_or(1025)), .hurst = hurst, .seed = options.seed});
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const int count = static_cast<int>(heights.size());
  const double pitch = options.size_mm / count, range = *high - *low;
  Synthesis result{std::string(to_string(FractalSynthesis::brownian_graph)),
                   {count, 1, {}, pitch, 32},
                   {count, 1, {}, pitch, pitch, false},
                   {},
                   {}};
  for (const double height : heights) {
    const double grey = range > 0 ? (height - *low) / range : 0;
    result.picture.pixels.push_back(static_cast<float>(grey));
    result.relief.mm.push_back(static_cast<float>(options.height_mm * grey));
  }
  return result;
}

Synthesis like_picture(const SynthesisOptions& options) {
  SurfaceLike like =
      surface_like(read_fitting_picture(options.like, k_like_bytes_per_pixel).grey,
                   {.size = options.size_px.value_or(256), .seed = options.seed, .progress = options.progress});
  Synthesis result = from_surface(options, "like", std::exchange(like.surface, {}));
  result.like = std::move(like);
  return result;
}

}  // namespace

std::string_view to_string(FractalSynthesis method) noexcept { return k_methods[static_cast<std::size_t>(method)]; }

FractalSynthesis fractal_synthesis(std::string_view name) {
  const auto found = std::find(k_methods.begin(), k_methods.end(), name);
  if (found == k_methods.end())
    throw InvalidInput("fractal_synthesis: '" + std::string(name) +
                       "' is none of exact, spectral, brownian-surface, cho, brownian-graph");
  return static_cast<FractalSynthesis>(found - k_methods.begin());
}

Synthesis synthesize_texture(const SynthesisOptions& options) {
  if (!options.like.empty()) return like_picture(options);
  if (options.grain) return grain(*options.grain, options);
  const bool is_graph = options.method == FractalSynthesis::brownian_graph;
  const double hurst = options.dimension ? (is_graph ? 2 : 3) - *options.dimension : options.hurst;
  const FractalSynthesis method =
      options.tile && options.method == FractalSynthesis::exact ? FractalSynthesis::spectral : options.method;
  Synthesis result = is_graph ? graph(options, hurst)
                              : from_surface(options, to_string(method), fractal_surface(options, method, hurst));
  result.hurst = hurst;
  return result;
}

}  // namespace papilla
