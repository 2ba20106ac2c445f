// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_welder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace papilla {
namespace {

constexpr Index k_free = std::numeric_limits<Index>::max();

/// Points whose memory is fetched together; more would drive each other out of the first-level cache.
constexpr std::size_t k_batch = 64;

/// A sum of products, so that the coordinates are hashed side by side, and the finalizer of splitmix64
/// [Steele, Lea, Flood 2014], so that every input bit reaches every output bit.
std::uint64_t hash(Vec3 p) noexcept {
  const auto bits = [](double x) { return std::rotl(std::bit_cast<std::uint64_t>(x), 32); };
  std::uint64_t x = bits(p.x) * 0x9e3779b97f4a7c15U + bits(p.y) * 0xc2b2ae3d27d4eb4fU + bits(p.z) * 0x165667b19e3779f9U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

Vec3 without_negative_zero(Vec3 point) noexcept { return point + Vec3{0, 0, 0}; }

}  // namespace

VertexWelder::VertexWelder(std::size_t expected_points) : table_(std::bit_ceil(2 * expected_points + 16), k_free) {
  points_.reserve(expected_points);
}

std::size_t VertexWelder::slot_of(Vec3 point, std::size_t first) const noexcept {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = first & mask;
  while (table_[slot] != k_free && !(points_[table_[slot]] == point)) slot = (slot + 1) & mask;
  return slot;
}

Index VertexWelder::add_at(Vec3 point, std::size_t first_slot) {
  const std::size_t slot = slot_of(point, first_slot);
  if (table_[slot] != k_free) return table_[slot];
  if (points_.size() == k_free) throw std::length_error("VertexWelder: more than 2^32 - 1 points");
  const Index number = static_cast<Index>(points_.size());
  points_.push_back(point);
  table_[slot] = number;
  return number;
}

Index VertexWelder::add(Vec3 point) {
  reserve_slots(1);
  point = without_negative_zero(point);
  return add_at(point, hash(point));
}

void VertexWelder::add(std::span<const Vec3> points, std::span<Index> numbers) {
  std::array<std::size_t, k_batch> slots;
  for (std::size_t begin = 0; begin < points.size(); begin += k_batch) {
    const auto batch = points.subspan(begin, std::min(k_batch, points.size() - begin));
    reserve_slots(batch.size());
    const std::size_t mask = table_.size() - 1;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      slots[i] = hash(without_negative_zero(batch[i])) & mask;
      __builtin_prefetch(&table_[slots[i]]);
    }
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (const Index number = table_[slots[i]]; number != k_free) __builtin_prefetch(&points_[number]);
    for (std::size_t i = 0; i < batch.size(); ++i)
      numbers[begin + i] = add_at(without_negative_zero(batch[i]), slots[i]);
  }
}

/// Keeps the table at most half full.
void VertexWelder::reserve_slots(std::size_t further_points) {
  const std::size_t needed = 2 * (points_.size() + further_points);
  if (needed <= table_.size()) return;
  table_.assign(std::bit_ceil(needed), k_free);
  for (std::size_t i = 0; i < points_.size(); ++i)
    table_[slot_of(points_[i], hash(points_[i]))] = static_cast<Index>(i);
}

}  // namespace papilla
