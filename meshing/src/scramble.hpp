// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace papilla::detail {

/// A number whose bits each depend on many of x; another for every x. For hashes.
constexpr std::uint64_t scramble(std::uint64_t x) noexcept {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  x ^= x >> 32;
  return x;
}

}  // namespace papilla::detail
