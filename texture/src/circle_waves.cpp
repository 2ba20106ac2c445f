// SPDX-License-Identifier: MIT
#include "circle_waves.hpp"

#include <numbers>

namespace papilla::texture_detail {

CircleWaves::CircleWaves(const std::vector<double>& samples) {
  const std::size_t count = samples.size(), highest = count / 4;
  std::vector<std::complex<double>> roots;
  for (std::size_t i = 0; i < count; ++i)
    roots.push_back(std::polar(1 / static_cast<double>(count),
                               -2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count)));
  for (std::size_t m = 0; m <= highest; ++m) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < count; ++i) sum += samples[i] * roots[m * i % count];
    values_.push_back(sum);
  }
}

}  // namespace papilla::texture_detail
