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
#include "fft.hpp"
#include "pieces.hpp"
#include "pyramid.hpp"
#include "reflectance.hpp"
#include "shaped_noise.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

using Field = std::vector<double>;

/// Eigenvalues 2 − 2 cos(k·step) of the one-dimensional −Δ for k = 0…count−1.
Field eigenvalues(int count, double step) {
  Field values(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) values[static_cast<std::size_t>(k)] = 2 - 2 * std::cos(k * step);
  return values;
}

/// 1 / (norm · 2(α K + λ K²)), 0 for the mean.
double inverse_eigenvalue(double k, double alpha, double lambda, double norm) {
  return k > 0 ? 1 / (norm * 2 * (alpha * k + lambda * k * k)) : 0;
}

/// Applies the inverse of 2(α K + λ K²) to a field, K the 5-point −Δ with periodic or reflecting borders.
/// The mean of the result is 0.
class InverseBilaplacian {
 public:
  virtual ~InverseBilaplacian() = default;
  virtual void apply(const Field& field, double alpha, double lambda, Field& result) = 0;
};

class PeriodicInverse final : public InverseBilaplacian {
 public:
  PeriodicInverse(int width, int height)
      : fft_(width, height),
        across_(eigenvalues(width / 2 + 1, 2 * std::numbers::pi / width)),
        down_(eigenvalues(height, 2 * std::numbers::pi / height)) {}

  void apply(const Field& field, double alpha, double lambda, Field& result) override {
    fft_.load(field.data());
    fft_.forward();
    const auto norm = static_cast<double>(field.size());
    std::complex<double>* spectrum = fft_.spectrum();
    for (const double down : down_)
      for (const double across : across_) *spectrum++ *= inverse_eigenvalue(across + down, alpha, lambda, norm);
    fft_.backward();
    fft_.store(result.data());
  }

 private:
  RealFft2d fft_;
  Field across_, down_;
};

class ReflectingInverse final : public InverseBilaplacian {
 public:
  ReflectingInverse(int width, int height)
      : transform_(width, height),
        across_(eigenvalues(width, std::numbers::pi / width)),
        down_(eigenvalues(height, std::numbers::pi / height)) {}

  void apply(const Field& field, double alpha, double lambda, Field& result) override {
    std::copy(field.begin(), field.end(), transform_.data());
    transform_.forward();
    const double norm = 4 * static_cast<double>(field.size());
    double* value = transform_.data();
    for (const double down : down_)
      for (const double across : across_) *value++ *= inverse_eigenvalue(across + down, alpha, lambda, norm);
    transform_.backward();
    std::copy_n(transform_.data(), field.size(), result.begin());
  }

 private:
  CosineTransform2d transform_;
  Field across_, down_;
};

std::unique_ptr<InverseBilaplacian> make_inverse_bilaplacian(int width, int height, bool periodic) {
  if (periodic) return std::make_unique<PeriodicInverse>(width, height);
  return std::make_unique<ReflectingInverse>(width, height);
}

constexpr std::string_view k_stage = "shape from shading";

/// Four sums side by side: one alone waits for every addition.
template <class T>
double dot_product(const std::vector<T>& a, const Field& b) {
  std::array<double, 4> sums{};
  std::size_t i = 0;
  for (; i + sums.size() <= a.size(); i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += static_cast<double>(a[i + k]) * b[i + k];
  for (; i < a.size(); ++i) sums[0] += static_cast<double>(a[i]) * b[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

template <class T>
void add_scaled(Field& target, double factor, const std::vector<T>& field) {
  for (std::size_t i = 0; i < target.size(); ++i) target[i] += factor * static_cast<double>(field[i]);
}

/// The two neighbours along one axis and the reciprocal of their distance (0 on a single pixel).
struct Neighbours {
  int before, after;
  double inverse_distance;
};

Neighbours neighbours(int i, int count, bool periodic) {
  if (count == 1) return {0, 0, 0};
  if (periodic) return {i == 0 ? count - 1 : i - 1, i == count - 1 ? 0 : i + 1, 0.5};
  const int before = std::max(0, i - 1), after = std::min(count - 1, i + 1);
  return {before, after, 1.0 / (after - before)};
}

/// E(Z) of shape_from_shading_variational() and its gradient.
class ShadingEnergy {
 public:
  ShadingEnergy(const GreyImage& image, const ShadingOptions& options)
      : width_(image.width),
        height_(image.height),
        periodic_(options.periodic),
        light_(require_light(options.light, "shape_from_shading_variational")),
        brightness_(brightness(image, options.albedo)),
        laplacian_(brightness_.size()),
        bilaplacian_(brightness_.size()) {}

  double value_and_gradient(const Field& z, double lambda, Field& gradient) {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    const double shading = add_shading(z, gradient);
    residual_ = std::sqrt(shading / static_cast<double>(z.size()));
    return shading + add_smoothness(z, lambda, gradient);
  }

  double residual() const noexcept { return residual_; }  ///< Root mean square of the last evaluation's I − R.
  Vec3 light() const noexcept { return light_; }
  const Field& image() const noexcept { return brightness_; }

 private:
  double add_shading(const Field& z, Field& gradient) const {
    double energy = 0;
    for (int y = 0; y < height_; ++y) {
      const Neighbours rows = neighbours(y, height_, periodic_);
      for (int x = 0; x < width_; ++x) {
        const Neighbours columns = neighbours(x, width_, periodic_);
        const std::size_t left = pixel_index(columns.before, y, width_), right = pixel_index(columns.after, y, width_);
        const std::size_t up = pixel_index(x, rows.before, width_), down = pixel_index(x, rows.after, width_);
        const double p = (z[right] - z[left]) * columns.inverse_distance;
        const double q = (z[down] - z[up]) * rows.inverse_distance;
        const Reflectance r = reflectance(light_, p, q);
        const double error = r.value - brightness_[pixel_index(x, y, width_)];
        energy += error * error;
        const double gp = 2 * error * r.dp * columns.inverse_distance, gq = 2 * error * r.dq * rows.inverse_distance;
        gradient[right] += gp;
        gradient[left] -= gp;
        gradient[down] += gq;
        gradient[up] -= gq;
      }
    }
    return energy;
  }

  /// The 5-point Laplacian with periodic or reflecting borders; symmetric as a matrix.
  void laplacian(const Field& z, Field& result) const {
    for (int y = 0; y < height_; ++y) {
      const double* row = z.data() + pixel_index(0, y, width_);
      const double* up = z.data() + pixel_index(0, beyond(y - 1, height_), width_);
      const double* down = z.data() + pixel_index(0, beyond(y + 1, height_), width_);
      double* target = result.data() + pixel_index(0, y, width_);
      for (int x = 1; x + 1 < width_; ++x) target[x] = row[x - 1] + row[x + 1] + up[x] + down[x] - 4 * row[x];
      for (const int x : {0, width_ - 1})
        target[x] = row[beyond(x - 1, width_)] + row[beyond(x + 1, width_)] + up[x] + down[x] - 4 * row[x];
    }
  }

  int beyond(int i, int count) const { return periodic_ ? wrapped(i, count) : std::clamp(i, 0, count - 1); }

  double add_smoothness(const Field& z, double lambda, Field& gradient) {
    laplacian(z, laplacian_);
    laplacian(laplacian_, bilaplacian_);
    add_scaled(gradient, 2 * lambda, bilaplacian_);
    return lambda * dot_product(laplacian_, laplacian_);
  }

  int width_, height_;
  bool periodic_;
  Vec3 light_;
  Field brightness_, laplacian_, bilaplacian_;
  double residual_ = 0;
};

/// Curvature pairs of L-BFGS with a preconditioner in place of the usual scaled identity. They are most of a piece's
/// memory and of its traffic, and only shape the next direction: floats.
class CurvatureMemory {
 public:
  void add(const Field& step, const Field& change) {
    const double curvature = dot_product(step, change);
    if (!(curvature > 1e-12 * std::sqrt(dot_product(step, step) * dot_product(change, change)))) return;
    Pair pair;
    if (pairs_.size() == k_most_pairs) {
      pair = std::move(pairs_.front());
      pairs_.pop_front();
    }
    pair.step.assign(step.begin(), step.end());
    pair.change.assign(change.begin(), change.end());
    pair.inverse_curvature = 1 / curvature;
    pairs_.push_back(std::move(pair));
  }

  /// −H·gradient by the two-loop recursion [Nocedal and Wright, algorithm 7.4]; `work` is overwritten.
  void direction(const Field& gradient, InverseBilaplacian& inverse, double alpha, double lambda, Field& work,
                 Field& result) {
    work = gradient;
    for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {
      pair->projection = pair->inverse_curvature * dot_product(pair->step, work);
      add_scaled(work, -pair->projection, pair->change);
    }
    inverse.apply(work, alpha, lambda, result);
    for (const Pair& pair : pairs_)
      add_scaled(result, pair.projection - pair.inverse_curvature * dot_product(pair.change, result), pair.step);
    for (double& value : result) value = -value;
  }

 private:
  static constexpr std::size_t k_most_pairs = 8;
  struct Pair {
    std::vector<float> step, change;
    double inverse_curvature = 0, projection = 0;
  };
  std::deque<Pair> pairs_;
};

/// Slight relief with bright as high: breaks the tie at frontal light, where the flat surface is stationary.
Field start_height(const Field& image, InverseBilaplacian& inverse) {
  Field start(image.size()), centred = image;
  remove_mean(centred);
  inverse.apply(centred, 1, 1, start);
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

/// Steps until converged, stalled, or `steps` are done.
StopReason descend(Descent& state, double lambda, int steps) {
  const Vec3 light = state.energy.light();
  const double alpha = (light.x * light.x + light.y * light.y) / 2 + 0.05;  // Mean of (s·k)²/|k|², kept above zero.
  CurvatureMemory memory;
  double value = state.energy.value_and_gradient(state.z, lambda, state.gradient);
  std::deque<double> history{value};
  const std::size_t pixels = state.z.size();
  Field direction(pixels), work(pixels), trial(pixels), trial_gradient(pixels);
  for (int done = 0; done < steps; ++done) {
    memory.direction(state.gradient, state.inverse, alpha, lambda, work, direction);
    const double slope = dot_product(direction, state.gradient);
    if (!(slope < 0)) return StopReason::converged;  // The gradient is zero to rounding.
    double trial_value = 0, step = 1;
    constexpr int k_most_halvings = 20;
    constexpr double k_armijo = 1e-4;
    int halvings = 0;
    for (; halvings < k_most_halvings; ++halvings, step /= 2) {
      trial = state.z;
      add_scaled(trial, step, direction);
      trial_value = state.energy.value_and_gradient(trial, lambda, trial_gradient);
      if (trial_value <= value + k_armijo * step * slope) break;
    }
    if (halvings == k_most_halvings) return StopReason::line_search_stalled;
    for (double& component : direction) component *= step;
    work = trial_gradient;
    add_scaled(work, -1, state.gradient);
    memory.add(direction, work);
    std::swap(state.z, trial);
    std::swap(state.gradient, trial_gradient);
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
