// SPDX-License-Identifier: MIT
#include "papilla/haptic/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace papilla {

void Histogram::add(double microseconds) noexcept {
  const double value = microseconds > 0 ? microseconds : 0;
  const double octave = value > 0 ? std::log2(value) - k_lowest_octave : 0;
  const int last = static_cast<int>(bins_.size()) - 1;
  const int bin = static_cast<int>(std::clamp(std::floor(octave * k_per_octave), 0.0, static_cast<double>(last)));
  ++bins_[static_cast<std::size_t>(bin)];
  ++count_;
  max_ = std::max(max_, value);
}

void Histogram::add(const Histogram& other) noexcept {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  count_ += other.count_;
  max_ = std::max(max_, other.max_);
}

double Histogram::quantile(double q) const noexcept {
  if (count_ == 0) return 0;
  const double wanted = std::max(1.0, std::ceil(q * static_cast<double>(count_)));
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    sum += bins_[i];
    if (static_cast<double>(sum) >= wanted)
      return std::min(max_, std::exp2(static_cast<double>(i + 1) / k_per_octave + k_lowest_octave));
  }
  return max_;
}

}  // namespace papilla
