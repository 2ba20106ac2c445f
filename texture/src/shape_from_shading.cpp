// SPDX-License-Identifier: MIT
#include "papilla/texture/shape_from_shading.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

#include "checks.hpp"
#include "pyramid.hpp"
#include "reflectance.hpp"
#include "relief_solver.hpp"

namespace papilla {
namespace {

using texture_detail::brightness;
using texture_detail::InverseBilaplacian;
using texture_detail::pixel_index;
using texture_detail::Reflectance;
using texture_detail::reflectance;
using texture_detail::remove_mean;
using Field = std::vector<double>;

double dot_product(const Field& a, const Field& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

void add_scaled(Field& target, double factor, const Field& field) {
  for (std::size_t i = 0; i < target.size(); ++i) target[i] += factor * field[i];
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
        light_(texture_detail::require_light(options.light, "shape_from_shading_variational")),
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

  int beyond(int i, int count) const {
    return periodic_ ? texture_detail::wrapped(i, count) : std::clamp(i, 0, count - 1);
  }

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

/// Curvature pairs of L-BFGS with a preconditioner in place of the usual scaled identity.
class CurvatureMemory {
 public:
  void add(Field step, Field change) {
    const double curvature = dot_product(step, change);
    if (!(curvature > 1e-12 * std::sqrt(dot_product(step, step) * dot_product(change, change)))) return;
    pairs_.push_back({std::move(step), std::move(change), 1 / curvature, 0});
    if (pairs_.size() > k_most_pairs) pairs_.pop_front();
  }
  void clear() { pairs_.clear(); }

  /// −H·gradient by the two-loop recursion [Nocedal and Wright, algorithm 7.4].
  Field direction(const Field& gradient, InverseBilaplacian& inverse, double alpha, double lambda) {
    Field work = gradient;
    for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {
      pair->projection = pair->inverse_curvature * dot_product(pair->step, work);
      add_scaled(work, -pair->projection, pair->change);
    }
    Field result(work.size());
    inverse.apply(work, alpha, lambda, result);
    for (const Pair& pair : pairs_)
      add_scaled(result, pair.projection - pair.inverse_curvature * dot_product(pair.change, result), pair.step);
    for (double& value : result) value = -value;
    return result;
  }

 private:
  static constexpr std::size_t k_most_pairs = 8;
  struct Pair {
    Field step, change;
    double inverse_curvature, projection;
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
    if (options.progress) options.progress("shape from shading", begin + (end - begin) * done / of);
  }
};

/// Steps until converged, stalled, or `steps` are done.
StopReason descend(Descent& state, double lambda, int steps) {
  const Vec3 light = state.energy.light();
  const double alpha = (light.x * light.x + light.y * light.y) / 2 + 0.05;  // Mean of (s·k)²/|k|², kept above zero.
  CurvatureMemory memory;
  double value = state.energy.value_and_gradient(state.z, lambda, state.gradient);
  std::deque<double> history{value};
  for (int done = 0; done < steps; ++done) {
    Field direction = memory.direction(state.gradient, state.inverse, alpha, lambda);
    double slope = dot_product(direction, state.gradient);
    if (!(slope < 0)) return StopReason::converged;  // The gradient is zero to rounding.
    Field trial, trial_gradient(state.z.size());
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
    Field change = trial_gradient;
    add_scaled(change, -1, state.gradient);
    memory.add(std::move(direction), std::move(change));
    state.z = std::move(trial);
    state.gradient = std::move(trial_gradient);
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
  InverseBilaplacian inverse(image.width, image.height, options.periodic);
  Descent state{energy,
                inverse,
                options,
                clock,
                result,
                begin,
                end,
                start_height(energy.image(), inverse),
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

constexpr int k_share = 10;         ///< A finer level takes this part of the coarsest level's steps.
constexpr int k_tile_side = 1024;   ///< Levels of more than twice this are refined tile by tile.
constexpr int k_tile_overlap = 64;  ///< Mixed over between tiles: longer than what a few steps still change.

StopReason refine(const GreyImage& image, const ShadingOptions& options, double begin, double end,
                  const Stopwatch& clock, Field& z, ShadingResult& result) {
  ShadingEnergy energy(image, options);
  InverseBilaplacian inverse(image.width, image.height, options.periodic);
  Descent state{energy, inverse, options, clock, result, begin, end, std::move(z), Field(image.pixels.size())};
  const StopReason stop = descend(state, options.smoothness, std::max(1, options.iterations / k_share));
  z = std::move(state.z);
  return stop;
}

/// Where tiles begin along one side, and their common length.
struct Tiles {
  int count, length, stride;
  explicit Tiles(int side) : count(std::max(1, side / k_tile_side)) {
    stride = (side + count - 1) / count;
    length = count == 1 ? side : std::min(side, stride + k_tile_overlap);
  }
};

/// Weight of sample i of a tile: a ramp over the overlap at ends that another tile covers too.
double ramp(int i, int length, bool open_before, bool open_after) {
  double weight = 1;
  if (open_before) weight = std::min(weight, (i + 1.0) / (k_tile_overlap + 1));
  if (open_after) weight = std::min(weight, static_cast<double>(length - i) / (k_tile_overlap + 1));
  return weight;
}

/// Refines a level too large for one piece: overlapping tiles with free borders from the common start, mixed by ramps.
/// What is left to do at this level is local.
StopReason refine_by_tiles(const GreyImage& image, const ShadingOptions& options, double begin, double end,
                           const Stopwatch& clock, Field& z, ShadingResult& result) {
  const Tiles across(image.width), down(image.height);
  ShadingOptions local = options;
  local.periodic = false;
  std::vector<float> sum(z.size(), 0), weight(z.size(), 0);
  double squares = 0;
  StopReason stop = StopReason::converged;
  for (int t = 0; t < across.count * down.count; ++t) {
    const int left = t % across.count * across.stride, top = t / across.count * down.stride;
    const auto column = [&](int x) { return texture_detail::wrapped(left + x, image.width); };
    const auto row = [&](int y) { return texture_detail::wrapped(top + y, image.height); };
    // Only a picture that tiles goes on beyond its last column.
    const int width = options.periodic ? across.length : std::min(across.length, image.width - left);
    const int height = options.periodic ? down.length : std::min(down.length, image.height - top);
    GreyImage part{width, height, {}, 0, image.bits};
    Field heights;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t i = pixel_index(column(x), row(y), image.width);
        part.pixels.push_back(image.pixels[i]);
        heights.push_back(z[i]);
      }
    const double share = (end - begin) / (across.count * down.count);
    ShadingResult steps;
    if (refine(part, local, begin + share * t, begin + share * (t + 1), clock, heights, steps) != StopReason::converged)
      stop = StopReason::iteration_limit;
    if (!steps.trace.empty()) squares += steps.trace.back().error * steps.trace.back().error;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool before = options.periodic || left > 0, after = options.periodic || left + width < image.width;
        const bool above = options.periodic || top > 0, below = options.periodic || top + height < image.height;
        const double w = ramp(x, width, before && across.count > 1, after && across.count > 1) *
                         ramp(y, height, above && down.count > 1, below && down.count > 1);
        const std::size_t i = pixel_index(column(x), row(y), image.width);
        sum[i] += static_cast<float>(w * (heights[pixel_index(x, y, width)] - z[i]));
        weight[i] += static_cast<float>(w);
      }
  }
  for (std::size_t i = 0; i < z.size(); ++i) z[i] += static_cast<double>(sum[i] / weight[i]);
  result.trace.push_back({clock.seconds(), std::sqrt(squares / (across.count * down.count))});
  return stop;
}

/// From coarse to fine: large waves converge where they are cheap, the finest level adds the smallest ones.
Field solve(const GreyImage& image, const ShadingOptions& options, double end, const Stopwatch& clock,
            ShadingResult& result) {
  if (std::min(image.width, image.height) < 2 * k_coarsest_side &&
      std::max(image.width, image.height) <= 2 * k_tile_side)
    return solve_coarsest(image, options, 0, end, clock, result);
  ShadingOptions coarse = options;
  coarse.smoothness /= 4;  // The heights halve with the pixels and the pixels are a quarter: keeps the energies' ratio.
  Field z;
  {
    const GreyImage half = texture_detail::halved(image);
    z = texture_detail::doubled(solve(half, coarse, end / 4, clock, result), half.width, half.height, image.width,
                                image.height, options.periodic);
  }
  const bool large = std::max(image.width, image.height) > 2 * k_tile_side;
  result.stop = large ? refine_by_tiles(image, options, end / 4, end, clock, z, result)
                      : refine(image, options, end / 4, end, clock, z, result);
  return z;
}

}  // namespace

ShadingResult shape_from_shading_variational(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, "shape_from_shading_variational");
  const Stopwatch clock;
  ShadingResult result;
  result.height_px = solve(image, options, 1, clock, result);
  remove_mean(result.height_px);
  return result;
}

ShadingResult shape_from_shading_tsai_shah(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, "shape_from_shading_tsai_shah");
  const Vec3 s = texture_detail::oblique(texture_detail::require_light(options.light, "shape_from_shading_tsai_shah"));
  const Stopwatch clock;
  constexpr double k_noise = 1e-8, k_first_gain = 0.01;  // W and S of the paper.
  const Field target = brightness(image, options.albedo);
  Field z(target.size(), 0.0), next(target.size()), gain(target.size(), k_first_gain);
  const auto before = [&](int i, int count) { return i > 0 ? i - 1 : options.periodic ? count - 1 : 0; };
  ShadingResult result;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    double squares = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::size_t i = pixel_index(x, y, image.width);
        const std::size_t left = pixel_index(before(x, image.width), y, image.width);
        const std::size_t up = pixel_index(x, before(y, image.height), image.width);
        const Reflectance r = reflectance(s, z[i] - z[left], z[i] - z[up]);
        const double error = target[i] - r.value;
        // A border pixel that is its own neighbour has no slope in that direction to change.
        const double slope = -((left == i ? 0 : r.dp) + (up == i ? 0 : r.dq));
        const double damped = gain[i] * slope / (k_noise + gain[i] * slope * slope);
        next[i] = z[i] - damped * error;
        gain[i] *= 1 - damped * slope;
        squares += error * error;
      }
    std::swap(z, next);
    result.trace.push_back({clock.seconds(), std::sqrt(squares / static_cast<double>(z.size()))});
    if (options.progress) options.progress("shape from shading", (iteration + 1.0) / options.iterations);
  }
  remove_mean(z);
  result.height_px = std::move(z);
  return result;
}

}  // namespace papilla
