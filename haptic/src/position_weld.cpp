// SPDX-License-Identifier: MIT
#include "position_weld.hpp"

#include <bit>

namespace papilla {

/// By a hash table with linear probing.
std::vector<std::uint32_t> weld_positions(const std::vector<Vec3>& positions, std::size_t& count) {
  constexpr std::uint32_t k_free = 0xffffffffU;
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // −0 becomes +0.
  const auto same = [&](Vec3 a, Vec3 b) {
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
  };
  std::vector<std::uint32_t> place(positions.size()), table(std::bit_ceil(2 * positions.size() + 1), k_free);
  count = 0;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const Vec3 p = positions[i];
    std::uint64_t hash = (bits(p.x) * 0x9E3779B97F4A7C15U ^ bits(p.y)) * 0xC2B2AE3D27D4EB4FU ^ bits(p.z);
    hash = (hash ^ hash >> 32) * 0x9E3779B97F4A7C15U;
    std::size_t slot = (hash ^ hash >> 32) & (table.size() - 1);
    while (table[slot] != k_free && !same(positions[table[slot]], p)) slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == k_free) {
      table[slot] = i;
      place[i] = static_cast<std::uint32_t>(count++);
    } else {
      place[i] = place[table[slot]];
    }
  }
  return place;
}

}  // namespace papilla
