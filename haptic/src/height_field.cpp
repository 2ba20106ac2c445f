// SPDX-License-Identifier: MIT
#include "papilla/haptic/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/cpu_clones.hpp"
#include "papilla/core/error.hpp"
#include "texels.hpp"

namespace papilla {
namespace {

/// Weights of Catmull and Rom (1974) for the samples at −1, 0, 1, 2, and their derivatives.
[[gnu::always_inline]] inline void cubic_weights(double f, double* w, double* d) noexcept {
  const double f2 = f * f, f3 = f2 * f;
  w[0] = 0.5 * (-f3 + 2 * f2 - f);
  w[1] = 0.5 * (3 * f3 - 5 * f2 + 2);
  w[2] = 0.5 * (-3 * f3 + 4 * f2 + f);
  w[3] = 0.5 * (f3 - f2);
  d[0] = 0.5 * (-3 * f2 + 4 * f - 1);
  d[1] = 0.5 * (9 * f2 - 10 * f);
  d[2] = 0.5 * (-9 * f2 + 8 * f + 1);
  d[3] = 0.5 * (3 * f2 - 2 * f);
}

/// The same of the uniform cubic B-spline.
[[gnu::always_inline]] inline void bspline_weights(double f, double* w, double* d) noexcept {
  constexpr double k_sixth = 1.0 / 6;
  const double g = 1 - f, f2 = f * f, f3 = f2 * f;
  w[0] = k_sixth * (g * g * g);
  w[1] = k_sixth * (3 * f3 - 6 * f2 + 4);
  w[2] = k_sixth * (-3 * f3 + 3 * f2 + 3 * f + 1);
  w[3] = k_sixth * f3;
  d[0] = -0.5 * g * g;
  d[1] = 0.5 * (3 * f2 - 4 * f);
  d[2] = 0.5 * (-3 * f2 + 2 * f + 1);
  d[3] = 0.5 * f2;
}

/// Σ weight[i] · value(i), in pairs: half as many additions wait for one another.
template <std::size_t k_taps, class Value>
[[gnu::always_inline]] inline double weighted_sum(const double* weight, const Value& value) noexcept {
  if constexpr (k_taps == 2) return weight[0] * value(0) + weight[1] * value(1);
  return (weight[0] * value(0) + weight[1] * value(1)) + (weight[2] * value(2) + weight[3] * value(3));
}

}  // namespace

HeightField::HeightField(int width, int height, std::vector<std::uint16_t> samples, const HeightFieldOptions& options)
    : width_(width), height_(height), samples_(std::move(samples)), options_(options) {
  if (width <= 0 || height <= 0 ||
      samples_.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw InvalidInput("HeightField: " + std::to_string(samples_.size()) + " samples are not " + std::to_string(width) +
                       " x " + std::to_string(height));
  const UvTransform& t = options.uv_transform;
  for (const double value :
       {options.scale_m, options.offset_m, t.offset.x, t.offset.y, t.rotation, t.scale.x, t.scale.y})
    if (!std::isfinite(value)) throw InvalidInput("HeightField: an option is not finite");

  metres_per_step_ = (options.white_is_outward ? 1 : -1) * options.scale_m / 65535;
  base_m_ = options.offset_m + (options.white_is_outward ? 0 : options.scale_m);
  const Extremes found = extremes();
  const double one = base_m_ + metres_per_step_ * found.least, other = base_m_ + metres_per_step_ * found.most;
  min_m_ = std::min(one, other);
  max_m_ = std::max(one, other);
  steepest_m_ = std::abs(metres_per_step_) * found.steepest;

  const std::array<Vec2, 2> rows = t.rows(width, height);
  a_[0][0] = rows[0].x, a_[0][1] = rows[0].y;
  a_[1][0] = rows[1].x, a_[1][1] = rows[1].y;
  t_[0] = width * t.offset.x - 0.5;
  t_[1] = height * t.offset.y - 0.5;
}

std::uint16_t HeightField::texel(long x, long y) const noexcept {
  const long column = wrapped(x, width_, options_.wrap[0]), row = wrapped(y, height_, options_.wrap[1]);
  return samples_[static_cast<std::size_t>(row * width_ + column)];
}

/// Weighted sums over k_taps × k_taps samples from (x, y) on, columns first, for SIMD.
template <std::size_t k_taps>
[[gnu::always_inline]] inline HeightField::Weighted HeightField::weighted(long x, long y, const Weights& along_x,
                                                                          const Weights& along_y) const noexcept {
  // On repeating maps most footprints lie inside one copy.
  const long left = options_.wrap[0] == Wrap::repeat ? wrapped(x, width_, Wrap::repeat) : x;
  const long top = options_.wrap[1] == Wrap::repeat ? wrapped(y, height_, Wrap::repeat) : y;
  const bool inside = left >= 0 && left + static_cast<long>(k_taps) <= width_;
  double v[k_taps][k_taps];
  for (std::size_t j = 0; j < k_taps; ++j) {
    const std::uint16_t* const row =
        &samples_[static_cast<std::size_t>(wrapped(top + static_cast<long>(j), height_, options_.wrap[1])) *
                  static_cast<std::size_t>(width_)];
    if (inside)
      for (std::size_t i = 0; i < k_taps; ++i)
        v[j][i] = static_cast<double>(static_cast<std::int32_t>(row[static_cast<std::size_t>(left) + i]));
    else
      for (std::size_t i = 0; i < k_taps; ++i)
        v[j][i] = row[wrapped(left + static_cast<long>(i), width_, options_.wrap[0])];
  }
  double column[k_taps], column_by_y[k_taps];
  for (std::size_t i = 0; i < k_taps; ++i) {
    const auto below = [&](std::size_t j) noexcept { return v[j][i]; };
    column[i] = weighted_sum<k_taps>(along_y.value, below);
    column_by_y[i] = weighted_sum<k_taps>(along_y.slope, below);
  }
  const auto of_column = [&](std::size_t i) noexcept { return column[i]; };
  return {weighted_sum<k_taps>(along_x.value, of_column), weighted_sum<k_taps>(along_x.slope, of_column),
          weighted_sum<k_taps>(along_x.value, [&](std::size_t i) noexcept { return column_by_y[i]; })};
}

Vec2 HeightField::texel_at(Vec2 uv) const noexcept {
  const auto along = [&](std::size_t axis, int size) noexcept {
    const double at = a_[axis][0] * uv.x + a_[axis][1] * uv.y + t_[axis];
    return options_.wrap[axis] == Wrap::repeat ? at - std::floor(at / size) * size : at;
  };
  return {along(0, width_), along(1, height_)};
}

PAPILLA_CPU_CLONES("avx2")
HeightSample HeightField::sample_texels(Vec2 texel) const noexcept {
  const double x = texel_coordinate(texel.x), y = texel_coordinate(texel.y);
  const double x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const long ix = static_cast<long>(x0), iy = static_cast<long>(y0);
  Weighted sum;
  if (options_.interpolation != Interpolation::bilinear) {
    Weights along_x, along_y;
    if (options_.interpolation == Interpolation::bicubic) {
      cubic_weights(fx, along_x.value, along_x.slope);
      cubic_weights(fy, along_y.value, along_y.slope);
    } else {
      bspline_weights(fx, along_x.value, along_x.slope);
      bspline_weights(fy, along_y.value, along_y.slope);
    }
    sum = weighted<4>(ix - 1, iy - 1, along_x, along_y);
  } else {
    sum = weighted<2>(ix, iy, {{1 - fx, fx}, {-1, 1}}, {{1 - fy, fy}, {-1, 1}});
  }
  const double h = base_m_ + metres_per_step_ * sum.value;
  if (h < min_m_) return {min_m_, {}};
  if (h > max_m_) return {max_m_, {}};
  return {h, {metres_per_step_ * sum.by_x, metres_per_step_ * sum.by_y}};
}

std::array<Vec2, 2> HeightField::texels_per_uv() const noexcept {
  return {Vec2{a_[0][0], a_[1][0]}, Vec2{a_[0][1], a_[1][1]}};
}

}  // namespace papilla
