// SPDX-License-Identifier: MIT
#include "sharp_hurst.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "line_fit.hpp"

namespace papilla::texture_detail {
namespace {

constexpr int k_blocks_a_side = 4, k_blocks = k_blocks_a_side * k_blocks_a_side;
constexpr int k_longest_lag = 32;
/// Second differences below this share of the rounding noise are no longer independent of it.
constexpr double k_least_signal = 0.5;

struct Direction {
  int dx, dy;
  double length;
};
constexpr std::array<Direction, 4> k_directions = {
    {{1, 0, 1}, {0, 1, 1}, {1, 1, 1.4142135623730951}, {1, -1, 1.4142135623730951}}};

/// Squared second differences of one lag and direction, summed by block.
struct BlockSums {
  std::array<double, k_blocks> squares{}, counts{};

  /// The mean without one block, or of all with skipped = −1.
  double mean(int skipped) const {
    double sum = 0, count = 0;
    for (int b = 0; b < k_blocks; ++b) {
      if (b == skipped) continue;
      sum += squares[static_cast<std::size_t>(b)];
      count += counts[static_cast<std::size_t>(b)];
    }
    return count > 0 ? sum / count : 0;
  }
};

/// Σ (z[x + step] − 2 z[x] + z[x − step])²; several sums side by side, so that vector units can add them.
double squared_differences(const float* z, std::ptrdiff_t step, int count) {
  constexpr int k_lanes = 8;
  std::array<double, k_lanes> sums{};
  const auto square = [&](int x) {
    const double d = static_cast<double>((z[x + step] - z[x]) + (z[x - step] - z[x]));
    return d * d;
  };
  int x = 0;
  for (; x + k_lanes <= count; x += k_lanes)
    for (int lane = 0; lane < k_lanes; ++lane) sums[static_cast<std::size_t>(lane)] += square(x + lane);
  double sum = 0;
  for (; x < count; ++x) sum += square(x);
  for (const double lane : sums) sum += lane;
  return sum;
}

BlockSums second_differences(const GreyImage& image, const Direction& direction, int lag) {
  BlockSums sums;
  const int reach_x = lag * direction.dx, reach_y = lag * std::abs(direction.dy);
  const auto step =
      static_cast<std::ptrdiff_t>(lag) * (static_cast<std::ptrdiff_t>(direction.dy) * image.width + direction.dx);
  for (int y = reach_y; y < image.height - reach_y; ++y) {
    const int block_row = y * k_blocks_a_side / image.height * k_blocks_a_side;
    const float* row = image.pixels.data() + image.index(0, y);
    for (int column = 0; column < k_blocks_a_side; ++column) {
      const int begin = std::max(reach_x, column * image.width / k_blocks_a_side);
      const int end = std::min(image.width - reach_x, (column + 1) * image.width / k_blocks_a_side);
      const double squares = begin < end ? squared_differences(row + begin, step, end - begin) : 0;
      const auto block = static_cast<std::size_t>(block_row + column);
      sums.squares[block] += squares;
      sums.counts[block] += std::max(0, end - begin);
    }
  }
  return sums;
}

/// sums[lag − 1][direction].
using LagTable = std::vector<std::array<BlockSums, k_directions.size()>>;

LagTable lag_table(const GreyImage& image, int lags) {
  LagTable table(static_cast<std::size_t>(lags));
  for (int lag = 1; lag <= lags; ++lag)
    for (std::size_t d = 0; d < k_directions.size(); ++d)
      table[static_cast<std::size_t>(lag) - 1][d] = second_differences(image, k_directions[d], lag);
  return table;
}

/// H along one direction: half the slope of log v over log lag. Without usable lags H = 1 (a plane).
double direction_hurst(const LagTable& table, std::size_t direction, double noise, int skipped_block) {
  std::vector<double> x, y, weights;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double raw = table[i][direction].mean(skipped_block), corrected = raw - noise;
    if (!(corrected > k_least_signal * noise)) continue;
    const double lag = static_cast<double>(i + 1), kept = corrected / raw;
    x.push_back(std::log(lag));
    y.push_back(std::log(corrected));
    weights.push_back(kept * kept / (lag * lag));
  }
  return x.size() < 2 ? 1 : fit_line(x, y, weights).slope / 2;
}

std::array<double, 4> directional_hurst(const LagTable& table, double noise, int skipped_block) {
  std::array<double, 4> hurst{};
  for (std::size_t d = 0; d < k_directions.size(); ++d) hurst[d] = direction_hurst(table, d, noise, skipped_block);
  return hurst;
}

double mean_of(const std::array<double, 4>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double half_width(const LagTable& table, double noise) {
  std::array<double, k_blocks> estimates{};
  for (int block = 0; block < k_blocks; ++block)
    estimates[static_cast<std::size_t>(block)] = mean_of(directional_hurst(table, noise, block));
  return jackknife_half_width(estimates);
}

/// True when every direction has two lags above the rounding noise, whichever block is left out. Otherwise
/// direction_hurst() gives the constant 1, whose variation from block to block is 0.
bool is_usable(const LagTable& table, double noise) {
  for (std::size_t d = 0; d < k_directions.size(); ++d)
    for (int skipped = -1; skipped < k_blocks; ++skipped) {
      int lags = 0;
      for (const auto& lag : table) lags += lag[d].mean(skipped) > (1 + k_least_signal) * noise;
      if (lags < 2) return false;
    }
  return true;
}

/// The range of lags, doubled from 1 and 2 on, whose estimate varies least from block to block.
LagTable steadiest(const GreyImage& image, double noise) {
  const LagTable all = lag_table(image, std::min(k_longest_lag, std::min(image.width, image.height) / 8));
  LagTable best;
  double least = 0;
  for (std::size_t lags = 2; lags <= all.size(); lags *= 2) {
    LagTable part(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(lags));
    const double width = half_width(part, noise);
    if (best.empty() || (is_usable(part, noise) && (width < least || !is_usable(best, noise)))) {
      best = std::move(part);
      least = width;
    }
  }
  return best;
}

double mean_variance(const std::array<BlockSums, 4>& sums) {
  double total = 0;
  for (const BlockSums& direction : sums) total += direction.mean(-1);
  return total / 4;
}

}  // namespace

double sharp_hurst(const GreyImage& image, double quantization_step) {
  const double noise = quantization_step * quantization_step / 2;  // (1 + 4 + 1) q²/12
  LagTable table = lag_table(image, 2);
  // With less than this share of noise in the first lag the two shortest lags are the better estimate.
  constexpr double k_tolerable_noise = 0.1;
  if (noise > k_tolerable_noise * mean_variance(table[0])) table = steadiest(image, noise);
  return mean_of(directional_hurst(table, noise, -1));
}

}  // namespace papilla::texture_detail
