// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>

namespace papilla::texture_detail {

/// Four sums side by side: one alone waits for every addition.
inline double lane_sum(const double* values, std::size_t count) {
  std::array<double, 4> sums{};
  std::size_t x = 0;
  for (; x + sums.size() <= count; x += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += values[x + k];
  for (; x < count; ++x) sums[0] += values[x];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

}  // namespace papilla::texture_detail
