// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "papilla/core/progress.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/surface_like.hpp"

namespace papilla {

/// How a fractal surface is made: brownian_surface_exact(), spectral_surface(), midpoint_surface() by either rule, or
/// brownian_graph(), a single row.
enum class FractalSynthesis { exact, spectral, brownian_surface, cho, brownian_graph };

/// The name on the command line: exact, spectral, brownian-surface, cho, brownian-graph.
std::string_view to_string(FractalSynthesis method) noexcept;
/// The method of that name. @throws InvalidInput for any other name.
FractalSynthesis fractal_synthesis(std::string_view name);

/// Options of synthesize_texture().
struct SynthesisOptions {
  std::optional<GrainKind> grain = {};  ///< A test grain; without one, a fractal surface.
  std::filesystem::path like = {};      ///< A picture: surface_like() instead of both.
  Vec3 light = GrainOptions{}.light;    ///< Of a grain's picture.
  FractalSynthesis method = FractalSynthesis::exact;
  double hurst = 0.5;                    ///< H of a fractal surface, in (0, 1).
  std::optional<double> dimension = {};  ///< Instead of H: 3 − H of a surface, 2 − H of a graph.
  bool tile = false;                     ///< A fractal surface that tiles; `exact` then becomes `spectral`.
  std::optional<int> size_px = {};       ///< 512 for a grain, 256 for spectral and like, 1025 for a graph, else 257.
  double size_mm = GrainOptions{}.size_mm, height_mm = GrainOptions{}.height_mm;
  std::uint64_t seed = 1;
  ProgressCallback progress = {};
};

/// What synthesize_texture() returns.
struct Synthesis {
  std::string method;               ///< Of the fractal surface, the grain's kind, or "like".
  GreyImage picture;                ///< The lit grain, or heights as grey values.
  HeightMap relief;                 ///< 0 to height_mm.
  std::optional<double> hurst;      ///< Of a fractal surface that is not like a picture.
  std::optional<SurfaceLike> like;  ///< Without its surface.
};

/// A test grain, a fractal surface, or a fractal surface with the signature of a picture, as picture and as relief.
/// Midpoint displacement rounds the size up to a power of two, and one more where it does not tile. Deterministic for
/// given options.
/// @throws InvalidInput, IoError, SolverFailure as the functions named above.
Synthesis synthesize_texture(const SynthesisOptions& options);

}  // namespace papilla
