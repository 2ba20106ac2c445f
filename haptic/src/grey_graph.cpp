// SPDX-License-Identifier: MIT
#include "papilla/haptic/grey_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>

namespace papilla {
namespace {

constexpr double k_least_hurst = 0.02;
constexpr std::uint64_t k_seed = 0x9E3779B97F4A7C15U;

/// Normal random numbers [xorshift, Marsaglia 2003; Box and Muller 1958].
class Normal {
 public:
  double operator()() noexcept {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  /// In (0, 1].
  double uniform() noexcept {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>((state_ >> 11) + 1) * 0x1p-53;
  }

  std::uint64_t state_ = k_seed;
};

}  // namespace

GreyGraph::GreyGraph(double hurst, int level) noexcept {
  const double power = 2 * (std::isfinite(hurst) ? std::clamp(hurst, k_least_hurst, 1 - k_least_hurst) : 0.5);
  constexpr std::size_t steps = k_samples - 1;
  std::array<double, steps> covariance{}, increment{}, weight{}, before{};
  // Of increments that are k samples apart.
  for (std::size_t i = 0; i < steps; ++i) {
    const auto k = static_cast<double>(i);
    covariance[i] = 0.5 * (std::pow(k + 1, power) + std::pow(std::abs(k - 1), power)) - std::pow(k, power);
  }
  Normal normal;
  double variance = 1;
  increment[0] = normal();
  for (std::size_t n = 1; n < steps; ++n) {
    double partial = covariance[n];
    for (std::size_t j = 1; j < n; ++j) partial -= before[j - 1] * covariance[n - j];
    partial /= variance;
    for (std::size_t j = 1; j < n; ++j) weight[j - 1] = before[j - 1] - partial * before[n - j - 1];
    weight[n - 1] = partial;
    variance *= 1 - partial * partial;
    double mean = 0;
    for (std::size_t j = 1; j <= n; ++j) mean += weight[j - 1] * increment[n - j];
    increment[n] = mean + std::sqrt(std::max(0.0, variance)) * normal();
    std::copy_n(weight.begin(), n, before.begin());
  }
  for (std::size_t i = 0; i < steps; ++i) grey_[i + 1] = grey_[i] + increment[i];

  const std::size_t stride = std::size_t{1} << (k_finest_level - std::clamp(level, 1, k_finest_level));
  for (std::size_t i = 0; i < steps; ++i) {
    const std::size_t from = i - i % stride;
    const double f = static_cast<double>(i % stride) / static_cast<double>(stride);
    grey_[i] = (1 - f) * grey_[from] + f * grey_[from + stride];
  }
  const auto [low, high] = std::minmax_element(grey_.begin(), grey_.end());
  const double least = *low, scale = *high > least ? 256 / (*high - least) : 0;
  for (double& value : grey_) value = scale * (value - least);
}

}  // namespace papilla
