// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_welder.hpp"

#include <bit>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace papilla {
namespace {

constexpr Index k_free = std::numeric_limits<Index>::max();

/// Finalizer of splitmix64 [Steele, Lea, Flood 2014]: every input bit reaches every output bit.
std::uint64_t mix(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

std::uint64_t hash(Vec3 p) noexcept {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return mix(bits(p.x) + mix(bits(p.y) + mix(bits(p.z) + 0x9e3779b97f4a7c15U)));
}

}  // namespace

VertexWelder::VertexWelder(std::size_t expected_points) : table_(std::bit_ceil(2 * expected_points + 16), k_free) {
  points_.reserve(expected_points);
}

std::size_t VertexWelder::slot_of(Vec3 point) const noexcept {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash(point) & mask;
  while (table_[slot] != k_free && !(points_[table_[slot]] == point)) slot = (slot + 1) & mask;
  return slot;
}

Index VertexWelder::add(Vec3 point) {
  point = point + Vec3{0, 0, 0};  // −0 + 0 = 0
  const std::size_t slot = slot_of(point);
  if (table_[slot] != k_free) return table_[slot];
  if (points_.size() == k_free) throw std::length_error("VertexWelder: more than 2^32 - 1 points");
  const Index number = static_cast<Index>(points_.size());
  points_.push_back(point);
  table_[slot] = number;
  if (2 * points_.size() > table_.size()) grow();
  return number;
}

void VertexWelder::grow() {
  table_.assign(2 * table_.size(), k_free);
  for (std::size_t i = 0; i < points_.size(); ++i) table_[slot_of(points_[i])] = static_cast<Index>(i);
}

}  // namespace papilla
