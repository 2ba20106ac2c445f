// SPDX-License-Identifier: MIT
#include "curvature_memory.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wide.hpp"

namespace papilla::texture_detail {
namespace {

constexpr std::size_t k_block = 1024;  ///< Pixels that stay in the first cache while all pairs are gone through.
constexpr std::size_t k_lanes = 8;     ///< Sums side by side: one alone waits for every addition.

double sum_of(const std::array<double, k_lanes>& lanes) {
  double sum = 0;
  for (const double lane : lanes) sum += lane;
  return sum;
}

PAPILLA_TEXTURE_WIDE double dot(const float* a, const double* b, std::size_t count) {
  std::array<double, k_lanes> sums{};
  std::size_t i = 0;
  for (; i + k_lanes <= count; i += k_lanes)
    for (std::size_t k = 0; k < k_lanes; ++k) sums[k] += static_cast<double>(a[i + k]) * b[i + k];
  for (; i < count; ++i) sums[0] += static_cast<double>(a[i]) * b[i];
  return sum_of(sums);
}

PAPILLA_TEXTURE_WIDE double dot(const double* a, const double* b, std::size_t count) {
  std::array<double, k_lanes> sums{};
  std::size_t i = 0;
  for (; i + k_lanes <= count; i += k_lanes)
    for (std::size_t k = 0; k < k_lanes; ++k) sums[k] += a[i + k] * b[i + k];
  for (; i < count; ++i) sums[0] += a[i] * b[i];
  return sum_of(sums);
}

PAPILLA_TEXTURE_WIDE void subtract(double* __restrict target, double a, const float* __restrict x, double b,
                                   const float* __restrict y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) target[i] -= a * static_cast<double>(x[i]) + b * static_cast<double>(y[i]);
}

/// What a new pair is of, over one block.
struct PairSums {
  double step_square = 0, change_square = 0;
};

PAPILLA_TEXTURE_WIDE PairSums make_pair(double scale, const double* __restrict direction,
                                        const double* __restrict before, const double* __restrict now,
                                        const double* __restrict h_before, const double* __restrict h_now,
                                        float* __restrict step, float* __restrict change, std::size_t count) {
  std::array<double, k_lanes> steps{}, changes{};
  const auto take = [&](std::size_t i, std::size_t lane) {
    const double s = scale * direction[i], y = now[i] - before[i];
    step[i] = static_cast<float>(s);
    change[i] = static_cast<float>(h_now[i] - h_before[i]);
    steps[lane] += s * s;
    changes[lane] += y * y;
  };
  std::size_t i = 0;
  for (; i + k_lanes <= count; i += k_lanes)
    for (std::size_t k = 0; k < k_lanes; ++k) take(i + k, k);
  for (; i < count; ++i) take(i, 0);
  return {sum_of(steps), sum_of(changes)};
}

}  // namespace

void CurvatureMemory::drop_oldest() {
  std::rotate(pairs_.begin(), pairs_.begin() + 1, pairs_.end());
  for (std::size_t i = 0; i + 1 < count_; ++i) {
    sg_[i] = sg_[i + 1];
    yhg_[i] = yhg_[i + 1];
    for (std::size_t j = 0; j + 1 < count_; ++j) {
      sy_[i][j] = sy_[i + 1][j + 1];
      yhy_[i][j] = yhy_[i + 1][j + 1];
    }
  }
  --count_;
}

void CurvatureMemory::add(double scale, const Field& direction, const Slope& before, const Slope& now) {
  if (count_ == k_most_pairs) drop_oldest();
  const std::size_t pixels = direction.size(), newest = count_;
  pairs_[newest].step.resize(pixels);
  pairs_[newest].change.resize(pixels);
  Row sg{}, yhg{};
  PairSums squares;
  double step_before = 0, change_before = 0;
  for (std::size_t at = 0; at < pixels; at += k_block) {
    const std::size_t count = std::min(k_block, pixels - at);
    const double* const gradient = now.gradient.data() + at;
    Pair& pair = pairs_[newest];
    const PairSums block = make_pair(scale, direction.data() + at, before.gradient.data() + at, gradient,
                                     before.preconditioned.data() + at, now.preconditioned.data() + at,
                                     pair.step.data() + at, pair.change.data() + at, count);
    squares.step_square += block.step_square;
    squares.change_square += block.change_square;
    for (std::size_t i = 0; i <= newest; ++i) {
      sg[i] += dot(pairs_[i].step.data() + at, gradient, count);
      yhg[i] += dot(pairs_[i].change.data() + at, gradient, count);
    }
    step_before += dot(pair.step.data() + at, before.gradient.data() + at, count);
    change_before += dot(pair.change.data() + at, before.gradient.data() + at, count);
  }
  sg_[newest] = step_before;
  yhg_[newest] = change_before;
  for (std::size_t i = 0; i <= newest; ++i) {
    sy_[i][newest] = sg[i] - sg_[i];
    yhy_[i][newest] = yhy_[newest][i] = yhg[i] - yhg_[i];
  }
  sg_ = sg;
  yhg_ = yhg;
  if (sy_[newest][newest] > 1e-12 * std::sqrt(squares.step_square * squares.change_square)) ++count_;
}

double CurvatureMemory::direction(const Slope& now, Field& result) const {
  Row w{}, a{};
  for (std::size_t i = count_; i-- > 0;) {
    w[i] = sg_[i];
    for (std::size_t j = i + 1; j < count_; ++j) w[i] -= sy_[i][j] * w[j];
    w[i] /= sy_[i][i];
  }
  for (std::size_t i = 0; i < count_; ++i) {
    a[i] = sy_[i][i] * w[i] - yhg_[i];
    for (std::size_t j = 0; j < count_; ++j) a[i] += yhy_[i][j] * w[j];
    for (std::size_t j = 0; j < i; ++j) a[i] -= sy_[j][i] * a[j];
    a[i] /= sy_[i][i];
  }
  double slope = 0;
  for (std::size_t at = 0; at < result.size(); at += k_block) {
    const std::size_t count = std::min(k_block, result.size() - at);
    for (std::size_t i = at; i < at + count; ++i) result[i] = -now.preconditioned[i];
    for (std::size_t i = 0; i < count_; ++i)
      subtract(result.data() + at, a[i], pairs_[i].step.data() + at, -w[i], pairs_[i].change.data() + at, count);
    slope += dot(result.data() + at, now.gradient.data() + at, count);
  }
  return slope;
}

}  // namespace papilla::texture_detail
