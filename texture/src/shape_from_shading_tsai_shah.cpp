// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <string_view>
#include <utility>

#include "checks.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "pieces.hpp"
#include "reflectance.hpp"

namespace papilla {
namespace {

using texture_detail::pixel_index;
using texture_detail::Reflectance;
using texture_detail::reflectance;
using Field = std::vector<double>;

constexpr const char* k_name = "shape_from_shading_tsai_shah";
constexpr std::string_view k_stage = "shape from shading";

/// Whether the picture repeats across its left and its upper border.
struct Wraps {
  bool across, down;
};

/// Calls after_step(squared error of every pixel, number of the step) after each step.
template <class AfterStep>
Field iterate(const GreyImage& image, const ShadingOptions& options, Wraps wraps, const AfterStep& after_step) {
  const Vec3 s = texture_detail::oblique(texture_detail::require_light(options.light, k_name));
  constexpr double k_noise = 1e-8, k_first_gain = 0.01;  // W and S of the paper.
  const Field target = texture_detail::brightness(image, options.albedo);
  Field z(target.size(), 0.0), next(target.size()), gain(target.size(), k_first_gain), squares(target.size());
  const auto width = static_cast<std::size_t>(image.width);
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    for (int y = 0; y < image.height; ++y) {
      const int row_above = y > 0 ? y - 1 : wraps.down ? image.height - 1 : 0;
      const std::size_t row = pixel_index(0, y, image.width), up = pixel_index(0, row_above, image.width);
      // A border pixel that is its own neighbour has no slope in that direction to change.
      const double turns_q = row == up ? 0 : 1;
      // Without branches and calls, so that the compiler takes several pixels at a time.
      const auto step = [&](std::size_t i, std::size_t left, std::size_t above, double turns_p) {
        const Reflectance r = reflectance(s, z[i] - z[left], z[i] - z[above]);
        const double error = target[i] - r.value;
        const double slope = -(turns_p * r.dp + turns_q * r.dq);
        const double damped = gain[i] * slope / (k_noise + gain[i] * slope * slope);
        next[i] = z[i] - damped * error;
        gain[i] *= 1 - damped * slope;
        squares[i] = error * error;
      };
      const std::size_t first_left = wraps.across ? row + width - 1 : row;
      step(row, first_left, up, first_left == row ? 0 : 1);
      for (std::size_t x = 1; x < width; ++x) step(row + x, row + x - 1, up + x, 1);
    }
    std::swap(z, next);
    after_step(squares, iteration);
  }
  return z;
}

/// A piece that includes as many pixels to its left and above as there are steps gives the same heights as the whole
/// picture.
void iterate_by_pieces(const SampleRows& image, const ShadingOptions& options, const texture_detail::RowWriter& write,
                       ShadingResult& result) {
  const Stopwatch clock;
  texture_detail::PieceLayout layout;
  layout.core = options.largest_piece_px / 2;
  layout.before = std::min(options.iterations, layout.core);
  layout.periodic = options.periodic;
  std::mutex mutex;
  std::vector<std::vector<double>> errors(static_cast<std::size_t>(options.iterations));
  texture_detail::solve_by_pieces(
      image, layout,
      [&](const texture_detail::Piece& piece) {
        const Wraps wraps{options.periodic && piece.across.length() == image.width(),
                          options.periodic && piece.down.length() == image.height()};
        return iterate(piece.image, options, wraps, [&](const Field& squares, int iteration) {
          double sum = 0;
          for (int y = 0; y < piece.down.length(); ++y)
            for (int x = 0; x < piece.across.length(); ++x)
              if (piece.weight(x, y) > 0) sum += squares[pixel_index(x, y, piece.across.length())];
          const std::scoped_lock lock(mutex);
          errors[static_cast<std::size_t>(iteration)].push_back(sum);
        });
      },
      write, options.progress, k_stage);
  // The clock ran over the pieces, not over the steps: each step took its share.
  const double seconds = clock.seconds() / options.iterations;
  for (std::vector<double>& step : errors) {
    const double time = seconds * static_cast<double>(result.trace.size() + 1);
    result.trace.push_back({time, std::sqrt(texture_detail::ordered_sum(std::move(step)) / image.count())});
  }
}

}  // namespace

ShadingResult shape_from_shading_tsai_shah(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, k_name);
  if (std::max(image.width, image.height) > options.largest_piece_px)
    return texture_detail::in_memory(shape_from_shading_tsai_shah_by_rows, image, options);
  ShadingResult result;
  const Stopwatch clock;
  result.height_px =
      iterate(image, options, {options.periodic, options.periodic}, [&](const Field& squares, int iteration) {
        const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
        result.trace.push_back({clock.seconds(), std::sqrt(sum / static_cast<double>(squares.size()))});
        report_progress(options.progress, k_stage, (iteration + 1.0) / options.iterations);
      });
  texture_detail::remove_mean(result.height_px);
  return result;
}

ShadingResult shape_from_shading_tsai_shah_by_rows(const SampleRows& picture, const ShadingOptions& options,
                                                   const HeightWriter& write) {
  texture_detail::require_shading_options(options, k_name);
  ShadingResult result;
  iterate_by_pieces(picture, options, write, result);
  return result;
}

}  // namespace papilla
