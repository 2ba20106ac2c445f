// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string_view>
#include <utility>

#include "checks.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "pieces.hpp"
#include "reflectance.hpp"
#include "wide.hpp"

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

/// The heights, and the sum of squared errors at each step over the counted pixels.
struct Iterated {
  Field z, squares;
};

/// From this column and row on pixels are counted.
struct Counted {
  int column = 0, row = 0;
};

/// One step of the pixels [begin, end) of a row: next = z − K f, above = z, gain ← (1 − K f′) S, squares = f².
/// With h = 1 + p² + q², a = s_z − s_x p − s_y q and b = (s_x + s_y) h + a (p + q), where a > 0,
///   f = I − a/√h,  f′ = b/√h³,  K f = S b h (I √h − a) / (W h³ + S b²),  1 − K f′ = W h³ / (W h³ + S b²).
/// Without branches and calls, so that the compiler takes several pixels at a time.
PAPILLA_TEXTURE_WIDE void take_step(Vec3 s, const double* __restrict target, double* __restrict above,
                                    const double* __restrict z, const double* __restrict left, double turns_p,
                                    double turns_q, double* __restrict next, double* __restrict gain,
                                    double* __restrict squares, std::size_t count) {
  constexpr double k_noise = 1e-8;  // W of the paper.
  const double turned_x = turns_p * s.x + turns_q * s.y;
  for (std::size_t x = 0; x < count; ++x) {
    const double p = z[x] - left[x], q = z[x] - above[x];
    const double h = 1 + p * p + q * q, root = std::sqrt(h), lit = s.z - s.x * p - s.y * q;
    const double a = lit > 0 ? lit : 0, b = lit > 0 ? turned_x * h + lit * (turns_p * p + turns_q * q) : 0;
    const double noise = k_noise * h * h * h, sum = noise + gain[x] * b * b, error = target[x] * root - a;
    const double inverse = 1 / (sum * h);  // Of both divisors: one division.
    above[x] = z[x];
    next[x] = z[x] - gain[x] * b * h * h * error * inverse;
    gain[x] *= noise * h * inverse;
    squares[x] = error * error * sum * inverse;
  }
}

/// The heights of one row before each step, and what the row below needs of the row above it.
class RowSteps {
 public:
  RowSteps(const ShadingOptions& options, std::size_t width, bool wraps)
      : light_(texture_detail::oblique(texture_detail::require_light(options.light, k_name))),
        steps_(static_cast<std::size_t>(options.iterations)),
        width_(width),
        wraps_(wraps),
        z_(width),
        next_(width),
        gain_(width),
        squares_(width),
        above_(steps_ * width, 0.0) {}

  /// All steps of the row below the one before, or of the first row, which has no slope down. Adds the squared errors
  /// of the columns from `counted` on to squares[step], unless squares is null.
  const Field& advance(const double* target, bool first, std::size_t counted, double* squares) {
    constexpr double k_first_gain = 0.01;  // S of the paper.
    std::fill(z_.begin(), z_.end(), 0.0);
    std::fill(gain_.begin(), gain_.end(), k_first_gain);
    for (std::size_t step = 0; step < steps_; ++step) {
      double* above = above_.data() + step * width_;
      // A border pixel that is its own neighbour has no slope in that direction to change.
      if (first) std::copy(z_.begin(), z_.end(), above);
      const double turns_q = first ? 0 : 1;
      const double left = wraps_ ? z_.back() : z_.front();
      take_step(light_, target, above, z_.data(), &left, wraps_ && width_ > 1 ? 1 : 0, turns_q, next_.data(),
                gain_.data(), squares_.data(), 1);
      take_step(light_, target + 1, above + 1, z_.data() + 1, z_.data(), 1, turns_q, next_.data() + 1, gain_.data() + 1,
                squares_.data() + 1, width_ - 1);
      std::swap(z_, next_);
      if (squares != nullptr) squares[step] += sum_of_squares(counted);
    }
    return z_;
  }

 private:
  /// Four sums side by side: one alone waits for every addition.
  double sum_of_squares(std::size_t begin) const {
    std::array<double, 4> sums{};
    std::size_t x = begin;
    for (; x + sums.size() <= width_; x += sums.size())
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += squares_[x + k];
    for (; x < width_; ++x) sums[0] += squares_[x];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }

  Vec3 light_;
  std::size_t steps_, width_;
  bool wraps_;
  Field z_, next_, gain_, squares_;
  Field above_;  ///< The row above before each step.
};

/// A step changes a pixel by what its left and its upper neighbour were before it. So each row can take all its steps
/// before the next row begins, in the cache; a picture that repeats downwards begins as many rows earlier.
Iterated iterate(const GreyImage& image, const ShadingOptions& options, Wraps wraps, Counted counted,
                 const ProgressCallback& progress) {
  const auto width = static_cast<std::size_t>(image.width);
  RowSteps steps(options, width, wraps.across);
  Iterated result{Field(image.pixels.size()), Field(static_cast<std::size_t>(options.iterations), 0.0)};
  Field target(width);
  for (int y = wraps.down ? 1 - options.iterations : 0; y < image.height; ++y) {
    const std::size_t row = pixel_index(0, texture_detail::wrapped(y, image.height), image.width);
    for (std::size_t x = 0; x < width; ++x) target[x] = static_cast<double>(image.pixels[row + x]) / options.albedo;
    const Field& z = steps.advance(target.data(), y == 0 && !wraps.down, static_cast<std::size_t>(counted.column),
                                   y >= counted.row ? result.squares.data() : nullptr);
    if (y >= 0) std::copy(z.begin(), z.end(), result.z.begin() + static_cast<std::ptrdiff_t>(row));
    report_progress(progress, k_stage, (std::max(0, y) + 1.0) / image.height);
  }
  return result;
}

/// The clock ran over the rows, not over the steps: each step took its share.
Trace trace_of(const Field& squares, double pixels, double seconds) {
  Trace trace;
  const double share = seconds / static_cast<double>(squares.size());
  for (const double sum : squares)
    trace.push_back({share * static_cast<double>(trace.size() + 1), std::sqrt(sum / pixels)});
  return trace;
}

/// A piece that includes as many pixels to its left and above as there are steps gives the same heights as the whole
/// picture.
void iterate_by_pieces(const SampleRows& image, const ShadingOptions& options, const texture_detail::RowWriter& write,
                       ShadingResult& result) {
  const Stopwatch clock;
  texture_detail::PieceLayout layout;
  layout.core = options.largest_piece_px;
  layout.before = std::min(options.iterations, layout.core);
  layout.periodic = options.periodic;
  std::mutex mutex;
  std::vector<std::vector<double>> errors(static_cast<std::size_t>(options.iterations));
  texture_detail::solve_by_pieces(
      image, layout,
      [&](const texture_detail::Piece& piece) {
        const Wraps wraps{options.periodic && piece.across.length() == image.width(),
                          options.periodic && piece.down.length() == image.height()};
        Iterated piece_result = iterate(piece.image, options, wraps, {piece.across.before(), piece.down.before()}, {});
        const std::scoped_lock lock(mutex);
        for (std::size_t step = 0; step < errors.size(); ++step) errors[step].push_back(piece_result.squares[step]);
        return std::move(piece_result.z);
      },
      write, options.progress, k_stage);
  Field squares;
  for (std::vector<double>& step : errors) squares.push_back(texture_detail::ordered_sum(std::move(step)));
  result.trace = trace_of(squares, static_cast<double>(image.count()), clock.seconds());
}

}  // namespace

ShadingResult shape_from_shading_tsai_shah(const GreyImage& image, const ShadingOptions& options) {
  texture_detail::require_shading(image, options, k_name);
  if (std::max(image.width, image.height) > options.largest_piece_px)
    return texture_detail::in_memory(shape_from_shading_tsai_shah_by_rows, image, options);
  ShadingResult result;
  const Stopwatch clock;
  Iterated iterated = iterate(image, options, {options.periodic, options.periodic}, {}, options.progress);
  result.height_px = std::move(iterated.z);
  result.trace = trace_of(iterated.squares, static_cast<double>(image.pixels.size()), clock.seconds());
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
