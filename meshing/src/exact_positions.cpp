// SPDX-License-Identifier: MIT
#include "exact_positions.hpp"

#include <array>
#include <bit>
#include <cstdint>

#include "mesh_attributes.hpp"
#include "scramble.hpp"

namespace papilla::detail {
namespace {

std::uint64_t hash(const Vec3& p) noexcept {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };  // -0 + 0 is +0
  return scramble(bits(p.x) + scramble(bits(p.y) + scramble(bits(p.z) + 0x9e3779b97f4a7c15u)));
}

}  // namespace

ExactPositions exact_positions(const TriangleMesh& mesh) {
  const Values<Vec3>& positions = mesh.positions;
  const std::size_t count = positions.size(), slots = std::bit_ceil(2 * count + 1);
  ExactPositions result;
  result.of_position.assign(count, k_none);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) result.of_position[v] = 0;

  // Each slot holds the first vertex of a position. Slots and those vertices' positions are asked for so early that
  // they arrive from memory in time.
  constexpr std::size_t k_ahead = 16, k_halfway = k_ahead / 2;
  std::vector<Index> table(slots, k_none);
  std::array<std::size_t, k_ahead> slot_ahead;
  const auto look_ahead = [&](std::size_t v) {
    if (v >= count) return;
    slot_ahead[v % k_ahead] = hash(positions[v]) & (slots - 1);
    __builtin_prefetch(&table[slot_ahead[v % k_ahead]]);
  };
  for (std::size_t v = 0; v < k_ahead; ++v) look_ahead(v);
  for (Index v = 0; v < count; ++v) {
    if (v + k_halfway < count)
      if (const Index first = table[slot_ahead[(v + k_halfway) % k_ahead]]; first != k_none)
        __builtin_prefetch(&positions[first]);
    std::size_t slot = slot_ahead[v % k_ahead];
    look_ahead(v + k_ahead);
    if (result.of_position[v] == k_none) continue;
    while (table[slot] != k_none && !(positions[table[slot]] == positions[v])) slot = (slot + 1) & (slots - 1);
    if (table[slot] == k_none) {
      table[slot] = v;
      result.of_position[v] = static_cast<Index>(result.first.size());
      result.first.push_back(v);
    } else {
      result.of_position[v] = result.of_position[table[slot]];
    }
  }
  return result;
}

}  // namespace papilla::detail
