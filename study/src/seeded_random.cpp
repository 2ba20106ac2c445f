// SPDX-License-Identifier: MIT
#include "papilla/study/seeded_random.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace papilla {
namespace {

/// Neighbouring seeds give unrelated numbers [splitmix64, Steele, Lea and Flood 2014].
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

}  // namespace

SeededRandom::SeededRandom(std::uint64_t seed, std::uint64_t stream) : generator_(mixed(mixed(seed) + stream)) {}

double SeededRandom::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));  // [Box and Muller 1958]
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

std::size_t SeededRandom::below(std::size_t n) {
  const std::uint64_t all = std::numeric_limits<std::uint64_t>::max(), last = all - all % n;
  for (;;) {
    const std::uint64_t drawn = generator_();
    if (drawn < last) return static_cast<std::size_t>(drawn % n);
  }
}

}  // namespace papilla
