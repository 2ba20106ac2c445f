// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace papilla {

/// Random numbers that are the same with every standard library, which its distributions are not.
class SeededRandom {
 public:
  /// @param stream  independent numbers for the same seed, such as one a participant.
  explicit SeededRandom(std::uint64_t seed, std::uint64_t stream = 0);

  /// In [0, 1).
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
  /// Of the standard normal distribution.
  double normal();
  /// From 0 to n − 1. @pre n >= 1.
  std::size_t below(std::size_t n);

  /// Every order is equally likely [Fisher and Yates; Durstenfeld 1964].
  template <class T>
  void shuffle(std::vector<T>& list) {
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[below(i)]);
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace papilla
