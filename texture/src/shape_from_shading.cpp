// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/shape_from_shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "curvature_memory.hpp"
#include "fft.hpp"
#include "inverse_bilaplacian.hpp"
#include "pieces.hpp"
#include "pyramid.hpp"
#include "reflectance.hpp"
#include "shading_energy.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

using Field = std::vector<double>;

constexpr std::string_view k_stage = "shape from shading";

/// Slight relief with bright as high: breaks the tie at frontal light, where the flat surface is stationary.
Field start_height(const Field& image, InverseBilaplacian& inverse) {
  Field start(image.size()), centred = image;
  remove_mean(centred);
  inverse.set(1, 1);
  inverse.apply(centred, start);
  const auto [low, high] = std::minmax_element(start.begin(), start.end());
  constexpr double k_start_range_px = 0.1;
  const double range = *high - *low;
  for (double& value : start) value *= range > 0 ? k_start_range_px / range : 0;
  return start;
}

struct Descent {
  ShadingEnergy& energy;
  InverseBilaplacian& inverse;
  const ShadingOptions& options;
  const Stopwatch& clock;
  ShadingResult& result;
  double begin, end;  ///< Of the progress, share of the whole.
  Field z, gradient;

  void progress(int done, int of) const {
    report_progress(options.progress, k_stage, begin + (end - begin) * done / of);
  }
};

/// z + step · direction.
void move_along(const Field& direction, double step, const Field& z, Field& moved) {
  for (std::size_t i = 0; i < z.size(); ++i) moved[i] = z[i] + step * direction[i];
}

/// Steps until converged, stalled, or `steps` are done.
StopReason descend(Descent& state, double lambda, int steps) {
  const Vec3 light = state.energy.light();
  const double alpha = (light.x * light.x + light.y * light.y) / 2 + 0.05;  // Mean of (s·k)²/|k|², kept above zero.
  state.inverse.set(alpha, lambda);
  CurvatureMemory memory;
  double value = state.energy.value_and_gradient(state.z, lambda, state.gradient), step = 0;
  std::deque<double> history{value};
  const std::size_t pixels = state.z.size();
  Field direction(pixels), trial(pixels), trial_gradient(pixels), preconditioned(pixels), last_preconditioned(pixels);
  for (int done = 0; done < steps; ++done) {
    const CurvatureMemory::Slope now{state.gradient, preconditioned};
    state.inverse.apply(state.gradient, preconditioned);
    if (done > 0) memory.add(step, direction, {trial_gradient, last_preconditioned}, now);
    const double slope = memory.direction(now, direction);
    if (!(slope < 0)) return StopReason::converged;  // The gradient is zero to rounding.
    double trial_value = 0;
    constexpr int k_most_halvings = 20;
    constexpr double k_armijo = 1e-4;
    int halvings = 0;
    for (step = 1; halvings < k_most_halvings; ++halvings, step /= 2) {
      move_along(direction, step, state.z, trial);
      trial_value = state.energy.value_and_gradient(trial, lambda, trial_gradient);
      if (trial_value <= value + k_armijo * step * slope) break;
    }
    if (halvings == k_most_halvings) return StopReason::line_search_stalled;
    std::swap(state.z, trial);
    std::swap(state.gradient, trial_gradient);
    std::swap(preconditioned, last_preconditioned);
    value = trial_value;
    state.result.trace.push_back({state.clock.seconds(), state.energy.residual()});
    state.progress(done + 1, steps);
    history.push_back(value);
    constexpr std::size_t k_window = 5;
    if (history.size() > k_window) {
      if (history.front() - value < state.options.relative_tolerance * history.front()) return StopReason::converged;
      history.pop_front();
    }
  }
  return StopReason::iteration_limit;
}

constexpr int k_coarsest_side = 96;  ///< Pictures from twice this on are solved at half their size first.
constexpr int k_stages = 4;
constexpr double k_stage_factor = 8;

/// All four stages from a nearly flat start.
Field solve_coarsest(const GreyImage& image, const ShadingOptions& options, double begin, double end,
                     const Stopwatch& clock, ShadingResult& result) {
  ShadingEnergy energy(image, options);
  const auto inverse = make_inverse_bilaplacian(image.width, image.height, options.periodic);
  Descent state{energy,
                *inverse,
                options,
                clock,
                result,
                begin,
                end,
                start_height(energy.image(), *inverse),
                Field(image.pixels.size())};
  int spent = 0;
  for (int stage = 1; stage <= k_stages; ++stage) {
    const double lambda = options.smoothness * std::pow(k_stage_factor, k_stages - stage);
    const std::size_t before = result.trace.size();
    state.begin = begin + (end - begin) * (stage - 1) / k_stages;
    state.end = begin + (end - begin) * stage / k_stages;
    // What a stage does not use is left to the next ones.
    result.stop = descend(state, lambda, std::max(1, options.iterations * stage / k_stages - spent));
    spent += static_cast<int>(result.trace.size() - before);
  }
  return std::move(state.z);
}

constexpr int k_share = 10;  ///< A finer level takes this part of the coarsest level's steps.

/// The options at half the size: the heights halve with the pixels and the pixels are a quarter, so that this keeps the
/// energies' ratio.
ShadingOptions coarser(ShadingOptions options) {
  options.smoothness /= 4;
  return options;
}

StopReason refine(const GreyImage& image, const ShadingOptions& options, double begin, double end,
                  const Stopwatch& clock, Field& z, ShadingResult& result) {
  ShadingEnergy energy(image, options);
  const auto inverse = make_inverse_bilaplacian(image.width, image.height, options.periodic);
  Descent state{energy, *inverse, options, clock, result, begin, end, std::move(z), Field(image.pixels.size())};
  const StopReason stop = descend(state, options.smoothness, std::max(1, options.iterations / k_share));
  z = std::move(state.z);
  return stop;
}

/// From coarse to fine: large waves converge where they are cheap, the finest level adds the smallest ones.
Field solve(const GreyImage& image, const ShadingOptions& options, double end, const Stopwatch& clock,
            ShadingResult& result) {
  if (std::min(image.width, image.height) < 2 * k_coarsest_side)
    return solve_coarsest(image, options, 0, end, clock, result);
  const GreyImage half = halved(image);
  const Field coarse = solve(half, coarser(options), end / 4, clock, result);
  Field z = enlarged({coarse, half.width, half.height, image.width, image.height, options.periodic});
  result.stop = refine(image, options, end / 4, end, clock, z, result);
  return z;
}

/// The common coarse heights at the samples of a piece.
Field start_of(const Piece& piece, const CoarseHeights& coarse) {
  const auto axis = [](const PieceSpan& span, int count) {
    return FineAxis{static_cast<double>(span.begin), static_cast<double>(span.length()) / count, count};
  };
  return enlarged(coarse, axis(piece.across, piece.image.width), axis(piece.down, piece.image.height));
}

/// The heights of one piece: from the common coarse start through the levels in between.
Field refine_piece(const Piece& piece, const CoarseHeights& coarse, int level, const ShadingOptions& options,
                   const Stopwatch& clock, ShadingResult& steps) {
  Field z;
  if (level > 0) {
    const GreyImage half = halved(piece.image);
    const Field heights =
        refine_piece({piece.across, piece.down, half}, coarse, level - 1, coarser(options), clock, steps);
    z = enlarged({heights, half.width, half.height, piece.image.width, piece.image.height, false});
  } else {
    z = start_of(piece, coarse);
  }
  steps.stop = refine(piece.image, options, 0, 1, clock, z, steps);
  return z;
}

/// Takes from what a piece changed the waves that its free borders leave open: those longer than a piece overlaps, or
/// than six pixels of the common start. Those stay what they are in the start.
void keep_short_waves(Field& heights, const Field& start, int width, int height, double longest_px) {
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] -= start[i];
  filter(heights, width, height, false, [=](double x, double y) {
    const double waves = longest_px * std::hypot(x, y);
    return -std::expm1(-waves * waves);
  });
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] += start[i];
}

/// Pictures too large for one piece: the long waves from the picture at a size that is one, the others in overlapping
/// pieces with free borders that start from those, mixed by ramps.
void solve_large(const SampleRows& image, const ShadingOptions& options, const Stopwatch& clock, const RowWriter& write,
                 ShadingResult& result) {
  const auto [small, levels] = shrunk(image, options.largest_piece_px / 2);
  ShadingOptions coarse_options = options;
  for (int level = 0; level < levels; ++level) coarse_options = coarser(coarse_options);
  constexpr double k_coarse_share = 0.02;
  const Field coarse = solve(small, coarse_options, k_coarse_share, clock, result);
  ShadingOptions local = options;
  local.periodic = false;
  local.progress = {};
  PieceLayout layout;
  layout.core = options.largest_piece_px / 2;
  layout.overlap = piece_overlap(options.largest_piece_px);
  layout.suitable = good_fft_size;
  layout.periodic = options.periodic;
  constexpr double k_resolved_px = 6;
  const double longest_px = std::max<double>(layout.overlap, k_resolved_px * std::ldexp(1, levels));
  const CoarseHeights common{coarse, small.width, small.height, image.width(), image.height(), options.periodic};
  std::mutex mutex;
  std::vector<double> squares;
  StopReason stop = StopReason::converged;
  solve_by_pieces(
      image, layout,
      [&](const Piece& piece) {
        ShadingResult steps;
        Field heights = refine_piece(piece, common, levels - 1, local, clock, steps);
        keep_short_waves(heights, start_of(piece, common), piece.image.width, piece.image.height, longest_px);
        const std::scoped_lock lock(mutex);
        squares.push_back(steps.trace.empty() ? 0 : steps.trace.back().error * steps.trace.back().error);
        if (steps.stop != StopReason::converged) stop = StopReason::iteration_limit;
        return heights;
      },
      write, part_of(options.progress, k_coarse_share, 1), k_stage);
  const auto pieces = static_cast<double>(squares.size());
  result.trace.push_back({clock.seconds(), std::sqrt(ordered_sum(std::move(squares)) / pieces)});
  result.stop = stop;
}

constexpr const char* k_name = "shape_from_shading_variational";

}  // namespace

ShadingResult shape_from_shading_variational(const GreyImage& image, const ShadingOptions& options) {
  require_shading(image, options, k_name);
  if (std::max(image.width, image.height) > options.largest_piece_px)
    return in_memory(shape_from_shading_variational_by_rows, image, options);
  const Stopwatch clock;
  ShadingResult result;
  result.height_px = solve(image, options, 1, clock, result);
  remove_mean(result.height_px);
  return result;
}

ShadingResult shape_from_shading_variational_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                     const HeightWriter& write) {
  require_shading_options(options, k_name);
  const Stopwatch clock;
  ShadingResult result;
  solve_large(picture, options, clock, write, result);
  return result;
}

}  // namespace papilla
