// SPDX-License-Identifier: MIT
#include "exact_positions.hpp"

#include <bit>
#include <cstdint>

#include "mesh_attributes.hpp"

namespace papilla::detail {
namespace {

constexpr std::uint64_t scramble(std::uint64_t x) noexcept {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93u;
  x ^= x >> 32;
  return x;
}

std::uint64_t hash(const Vec3& p) noexcept {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };  // -0 + 0 is +0
  return scramble(bits(p.x) + scramble(bits(p.y) + scramble(bits(p.z) + 0x9e3779b97f4a7c15u)));
}

}  // namespace

ExactPositions exact_positions(const TriangleMesh& mesh) {
  const std::size_t slots = std::bit_ceil(2 * mesh.positions.size() + 1);
  std::vector<Index> table(slots, k_none);
  ExactPositions result;
  result.of_position.assign(mesh.positions.size(), k_none);
  for (const Triangle& t : mesh.triangles)
    for (const Index v : t) result.of_position[v] = 0;
  constexpr Index k_ahead = 16;  // far enough for the slot to arrive from memory
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    if (v + k_ahead < mesh.positions.size())
      __builtin_prefetch(&table[hash(mesh.positions[v + k_ahead]) & (slots - 1)]);
    if (result.of_position[v] == k_none) continue;
    const Vec3& p = mesh.positions[v];
    std::size_t slot = hash(p) & (slots - 1);
    while (table[slot] != k_none && !(mesh.positions[result.first[table[slot]]] == p)) slot = (slot + 1) & (slots - 1);
    if (table[slot] == k_none) {
      table[slot] = static_cast<Index>(result.first.size());
      result.first.push_back(v);
    }
    result.of_position[v] = table[slot];
  }
  return result;
}

}  // namespace papilla::detail
