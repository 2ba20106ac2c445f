// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace papilla {

/// Histogram of durations in microseconds with 64 bins per octave from 1/64 µs to 1 s: quantiles are accurate to 1.1 %,
/// the maximum is exact. Fixed size, noexcept.
class Histogram {
 public:
  void add(double microseconds) noexcept;
  void add(const Histogram& other) noexcept;
  /// The q-quantile, q ∈ [0, 1]; 0 when empty.
  double quantile(double q) const noexcept;
  double max() const noexcept { return max_; }
  std::uint64_t count() const noexcept { return count_; }

 private:
  static constexpr int k_per_octave = 64, k_octaves = 26, k_lowest_octave = -6;
  std::array<std::uint64_t, k_per_octave * k_octaves> bins_{};
  std::uint64_t count_ = 0;
  double max_ = 0;
};

}  // namespace papilla
