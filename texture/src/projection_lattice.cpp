// SPDX-License-Identifier: MIT
#include "projection_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace papilla::texture_detail {
namespace {

constexpr double k_decay = 0.5;      // λ, per pixel.
constexpr double k_spread_px = 1.5;  // Standard deviation of a distance.
constexpr double k_least_length_px = 4;
constexpr int k_steps_a_degree = 2, k_directions = 180 * k_steps_a_degree;
constexpr int k_least_turn = 10 * k_steps_a_degree;

Vec2 direction(int step) {
  const double angle = step * std::numbers::pi / k_directions;
  return {std::cos(angle), std::sin(angle)};
}

/// Σ_ij exp(−λ |a_i − a_j|) in one pass over the sorted values: each sum to the left decays from value to value.
double concentration(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double left = 0, sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) left = (left + 1) * std::exp(-k_decay * (values[i] - values[i - 1]));
    sum += 1 + 2 * left;
  }
  return sum;
}

/// The most frequent distance of the values; 0 when none is long enough.
double frequent_distance(const std::vector<double>& values) {
  constexpr double k_step_px = 0.1;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto size = static_cast<std::size_t>((*high - *low) / k_step_px) + 1;
  const auto first = static_cast<std::size_t>(k_least_length_px / k_step_px);
  constexpr std::size_t k_most = 100000;
  if (size <= first || size > k_most) return 0;
  std::vector<double> counts(size, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      counts[std::min(size - 1, static_cast<std::size_t>(std::abs(values[i] - values[j]) / k_step_px))] += 1;
  const int reach = static_cast<int>(4 * k_spread_px / k_step_px);
  double best = 0, length = 0;
  for (std::size_t at = first; at < size; ++at) {
    double density = 0;
    for (int k = -reach; k <= reach; ++k) {
      const auto other = static_cast<std::ptrdiff_t>(at) + k;
      // Points of one line have no distance; those nearer than half the least length are such.
      if (static_cast<double>(other) * k_step_px < k_least_length_px / 2 || other >= static_cast<std::ptrdiff_t>(size))
        continue;
      const double deviation = k * k_step_px / k_spread_px;
      density += counts[static_cast<std::size_t>(other)] * std::exp(-deviation * deviation / 2);
    }
    if (density <= best) continue;
    best = density;
    length = (static_cast<double>(at) + 0.5) * k_step_px;
  }
  return length;
}

}  // namespace

std::optional<std::array<Vec2, 2>> projection_lattice(const std::vector<Vec2>& points) {
  if (points.size() < 3) return std::nullopt;
  std::vector<double> values(points.size()), concentrations;
  for (int step = 0; step < k_directions; ++step) {
    const Vec2 q = direction(step);
    std::transform(points.begin(), points.end(), values.begin(), [&](Vec2 p) { return cross(q, p); });
    concentrations.push_back(concentration(values));
  }
  const auto first =
      static_cast<int>(std::max_element(concentrations.begin(), concentrations.end()) - concentrations.begin());
  int second = -1;
  for (int step = 0; step < k_directions; ++step) {
    const int turn = std::abs(step - first), apart = std::min(turn, k_directions - turn);
    if (apart >= k_least_turn && (second < 0 || concentrations[static_cast<std::size_t>(step)] >
                                                    concentrations[static_cast<std::size_t>(second)]))
      second = step;
  }
  const std::array<Vec2, 2> q = {direction(first), direction(second)};
  std::array<Vec2, 2> vectors;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec2 along = q[i], other = q[1 - i];
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](Vec2 p) { return cross(p, other) / cross(along, other); });
    const double length = frequent_distance(values);
    if (!(length > 0)) return std::nullopt;
    vectors[i] = length * along;
  }
  return vectors;
}

}  // namespace papilla::texture_detail
