// SPDX-License-Identifier: MIT
#include "papilla/haptic/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/cpu_clones.hpp"
#include "papilla/core/error.hpp"
#include "texels.hpp"

namespace papilla {
namespace {

// Four numbers side by side; the compiler splits them where the processor has fewer. Functions that pass them on are
// inlined, so that it doesn't matter how: the warning is of calls.
#pragma GCC diagnostic ignored "-Wpsabi"
typedef double Four __attribute__((vector_size(32)));
typedef float FourFloats __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

/// The weights of the samples at −1, 0, 1, 2 as polynomials of the place f between 0 and 1: Σ by[k]·f^k.
struct Basis {
  Four by[4];
};

/// In the order of Interpolation: linear; Catmull and Rom (1974); the uniform cubic B-spline.
constexpr Basis k_bases[] = {
    {{{0, 1, 0, 0}, {0, -1, 1, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}},
    {{{0, 1, 0, 0}, {-0.5, 0, 0.5, 0}, {1, -2.5, 2, -0.5}, {-0.5, 1.5, -1.5, 0.5}}},
    {{{1 / 6., 4 / 6., 1 / 6., 0}, {-0.5, 0, 0.5, 0}, {0.5, -1, 0.5, 0}, {-1 / 6., 0.5, -0.5, 1 / 6.}}},
};

/// Weights along an axis, of the value and its derivative.
struct Weights {
  Four value, slope;
};

[[gnu::always_inline]] inline Weights weights_at(const Basis& basis, double f) noexcept {
  const Four* const by = basis.by;
  return {by[0] + f * (by[1] + f * (by[2] + f * by[3])), by[1] + f * (2 * by[2] + (3 * f) * by[3])};
}

[[gnu::always_inline]] inline Four four_at(const std::uint16_t* first) noexcept {
  const FourInts samples = {first[0], first[1], first[2], first[3]};
  return __builtin_convertvector(__builtin_convertvector(samples, FourFloats), Four);  // As floats they are exact.
}

/// In pairs: half as many additions wait for one another.
[[gnu::always_inline]] inline double sum(const Four& v) noexcept { return (v[0] + v[1]) + (v[2] + v[3]); }
[[gnu::always_inline]] inline Four weighted(const Four& weight, const Four* rows) noexcept {
  return (weight[0] * rows[0] + weight[1] * rows[1]) + (weight[2] * rows[2] + weight[3] * rows[3]);
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

/// A texel coordinate of an axis, in the first copy of a map that repeats. The reciprocal waits for nothing.
[[gnu::always_inline]] inline double HeightField::in_first_copy(std::size_t axis, double at) const noexcept {
  const double size = axis == 0 ? width_ : height_, copies = at * (1 / size);
  return options_.wrap[axis] == Wrap::repeat ? at - std::floor(copies) * size : at;
}

Vec2 HeightField::texel_at(Vec2 uv) const noexcept {
  const auto along = [&](std::size_t axis) noexcept {
    return in_first_copy(axis, a_[axis][0] * uv.x + a_[axis][1] * uv.y + t_[axis]);
  };
  return {along(0), along(1)};
}

/// The samples around a place, and how far it lies beyond the second row and column.
struct HeightField::Patch {
  Four rows[4];
  double beyond_x, beyond_y;
};

/// @pre no sample is beyond an edge of the map.
[[gnu::always_inline]] inline HeightField::Patch HeightField::patch_inside(double x, double y, double x0,
                                                                           double y0) const noexcept {
  const std::uint16_t* const first = samples_.data() + (static_cast<long>(y0) - 1) * width_ + static_cast<long>(x0) - 1;
  return {{four_at(first), four_at(first + width_), four_at(first + 2L * width_), four_at(first + 3L * width_)},
          x - x0,
          y - y0};
}

HeightField::Patch HeightField::patch_across_edge(Vec2 at) const noexcept {
  const double x = texel_coordinate(at.x), y = texel_coordinate(at.y), x0 = std::floor(x), y0 = std::floor(y);
  Patch patch{{}, x - x0, y - y0};
  for (long j = 0; j < 4; ++j)
    for (long i = 0; i < 4; ++i) patch.rows[j][i] = texel(static_cast<long>(x0) - 1 + i, static_cast<long>(y0) - 1 + j);
  return patch;
}

PAPILLA_CPU_CLONES("avx2")
HeightSample HeightField::sample_texels(Vec2 at) const noexcept {
  const double x = in_first_copy(0, at.x), y = in_first_copy(1, at.y), x0 = std::floor(x), y0 = std::floor(y);
  const bool is_inside = x0 >= 1 && x0 < width_ - 2 && y0 >= 1 && y0 < height_ - 2;
  const Patch patch = is_inside ? patch_inside(x, y, x0, y0) : patch_across_edge(at);
  const Basis& basis = k_bases[static_cast<std::size_t>(options_.interpolation)];
  const Weights along_x = weights_at(basis, patch.beyond_x), along_y = weights_at(basis, patch.beyond_y);
  const Four column = weighted(along_y.value, patch.rows);
  const double h = base_m_ + metres_per_step_ * sum(along_x.value * column);
  if (h < min_m_) return {min_m_, {}};
  if (h > max_m_) return {max_m_, {}};
  return {h,
          {metres_per_step_ * sum(along_x.slope * column),
           metres_per_step_ * sum(along_x.value * weighted(along_y.slope, patch.rows))}};
}

std::array<Vec2, 2> HeightField::texels_per_uv() const noexcept {
  return {Vec2{a_[0][0], a_[1][0]}, Vec2{a_[0][1], a_[1][1]}};
}

}  // namespace papilla
