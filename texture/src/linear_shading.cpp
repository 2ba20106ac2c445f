// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear_shading.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <mutex>
#include <numbers>
#include <utility>
#include <vector>

#include "checks.hpp"
#include "fft.hpp"
#include "papilla/core/trace.hpp"
#include "pieces.hpp"
#include "pyramid.hpp"
#include "reflectance.hpp"
#include "slopes.hpp"

namespace papilla::texture_detail {
namespace {

using Field = std::vector<double>;

/// Angular frequency of row or column k of a transform of n; 0 for the highest one, whose derivative is not real.
double frequency(int k, int n) {
  if (2 * k == n) return 0;
  return 2 * std::numbers::pi * (2 * k < n ? k : k - n) / n;
}

/// Turns the spectrum of the brightness into that of the heights. @param step of the pixels, in those of the picture.
void integrate(RealFft2d& fft, int width, int height, Vec3 light, const WaveDamping& damping, Vec2 step) {
  const double oblique = light.x * light.x + light.y * light.y;
  const double norm = 1 / (static_cast<double>(width) * height);
  std::complex<double>* value = fft.spectrum();
  for (int v = 0; v < height; ++v)
    for (int u = 0; u <= width / 2; ++u, ++value) {
      const double wx = frequency(u, width), wy = frequency(v, height);
      const double along = light.x * wx + light.y * wy;
      const double power = along * along + damping(wx / step.x, wy / step.y) * oblique * (wx * wx + wy * wy);
      *value *= power > 0 ? std::complex(0.0, norm * along / power) : std::complex<double>();
    }
}

/// Root mean square of the brightness − R over the slopes of the heights.
double residual(const Field& height, const GreyImage& image, double albedo, Vec3 light, bool periodic) {
  double squares = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Stencil across = stencil(x, image.width, periodic);
      const Stencil down = stencil(y, image.height, periodic);
      const auto at = [&](int column, int row) { return height[pixel_index(column, row, image.width)]; };
      const double p = (at(across.after, y) - at(across.before, y)) / across.span;
      const double q = (at(x, down.after) - at(x, down.before)) / down.span;
      const double error = brightness(image.at(x, y), albedo) - reflectance(light, p, q).value;
      squares += error * error;
    }
  return std::sqrt(squares / static_cast<double>(height.size()));
}

/// Heights of the brightness after its mean.
Field linear_heights(Field brightness, int columns, int rows, bool periodic, Vec3 light, const WaveDamping& damping,
                     Vec2 step = {1, 1}) {
  remove_mean(brightness);
  const auto padded = [&](int side) { return periodic ? side : good_fft_size(side + side / 4); };
  const int width = padded(columns), height = padded(rows);
  RealFft2d fft(width, height);
  std::fill_n(fft.real(), fft.stride() * static_cast<std::size_t>(height), 0.0);
  for (int y = 0; y < rows; ++y) std::copy_n(brightness.data() + pixel_index(0, y, columns), columns, &fft.real(0, y));
  fft.forward();
  integrate(fft, width, height, light, damping, step);
  fft.backward();
  for (int y = 0; y < rows; ++y) std::copy_n(&fft.real(0, y), columns, brightness.data() + pixel_index(0, y, columns));
  return brightness;
}

}  // namespace

ShadingResult linear_shading(const GreyImage& image, const ShadingOptions& options, Vec3 light,
                             const WaveDamping& damping) {
  const Stopwatch clock;
  ShadingResult result;
  result.height_px =
      linear_heights(brightness(image, options.albedo), image.width, image.height, options.periodic, light, damping);
  remove_mean(result.height_px);
  result.stop = StopReason::direct;
  result.trace.push_back({clock.seconds(), residual(result.height_px, image, options.albedo, light, options.periodic)});
  report_progress(options.progress, "shape from shading", 1);
  return result;
}

ShadingResult linear_shading_by_rows(const SampleRows& image, const ShadingOptions& options, Vec3 light,
                                     const WaveDamping& damping, const RowWriter& write) {
  const Stopwatch clock;
  ShadingResult result;
  result.stop = StopReason::direct;
  const GreyImage small = shrunk(image, options.largest_piece_px / 2).image;
  const auto enlarged = [&](const Field& field, const Piece& piece) {
    return texture_detail::enlarged({field, small.width, small.height, image.width(), image.height(), options.periodic},
                                    {static_cast<double>(piece.across.begin), 1, piece.across.length()},
                                    {static_cast<double>(piece.down.begin), 1, piece.down.length()});
  };
  const Field coarse = brightness(small, options.albedo);
  const Vec2 step{static_cast<double>(image.width()) / small.width, static_cast<double>(image.height()) / small.height};
  const Field heights = linear_heights(coarse, small.width, small.height, options.periodic, light, damping, step);
  const double scale = enlargement({coarse, small.width, small.height, image.width(), image.height(), options.periodic},
                                   {0, 1, 0}, {0, 1, 0});
  PieceLayout layout;
  layout.core = options.largest_piece_px / 2;
  layout.overlap = piece_overlap(options.largest_piece_px);
  layout.suitable = good_fft_size;
  layout.periodic = options.periodic;
  std::mutex mutex;
  std::vector<double> squares;
  result.pieces = solve_by_pieces(
      image, layout,
      [&](const Piece& piece) {
        Field fine = brightness(piece.image, options.albedo);
        const Field low = enlarged(coarse, piece);  // As heights, hence times the scale.
        for (std::size_t i = 0; i < fine.size(); ++i) fine[i] -= low[i] / scale;
        fine = linear_heights(std::move(fine), piece.image.width, piece.image.height, false, light, damping);
        const Field common = enlarged(heights, piece);
        for (std::size_t i = 0; i < fine.size(); ++i) fine[i] += common[i];
        const double error = residual(fine, piece.image, options.albedo, light, false);
        const std::scoped_lock lock(mutex);
        squares.push_back(error * error);
        return fine;
      },
      write, options.progress, "shape from shading");
  const auto pieces = static_cast<double>(squares.size());
  result.trace.push_back({clock.seconds(), std::sqrt(ordered_sum(std::move(squares)) / pieces)});
  return result;
}

}  // namespace papilla::texture_detail
