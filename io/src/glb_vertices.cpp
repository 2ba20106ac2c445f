// SPDX-License-Identifier: MIT
#include "glb_vertices.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace papilla {
namespace {

constexpr Index k_free = std::numeric_limits<Index>::max();

/// Corners whose memory is fetched together; more would drive each other out of the first-level cache.
constexpr std::size_t k_batch = 48;

using Words = std::array<std::uint32_t, 13>;
static_assert(sizeof(GlbVertex) == sizeof(Words));

/// Odd numbers without pattern: the outputs of splitmix64 [Steele, Lea, Flood 2014].
constexpr std::array<std::uint64_t, 13> k_factors = [] {
  std::array<std::uint64_t, 13> factors{};
  std::uint64_t state = 0;
  for (std::uint64_t& factor : factors) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    factor = (z ^ (z >> 31)) | 1U;
  }
  return factors;
}();

std::uint64_t hash(const GlbVertex& vertex) noexcept {
  const Words words = std::bit_cast<Words>(vertex);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < words.size(); ++i) sum += words[i] * k_factors[i];
  sum = (sum ^ (sum >> 32)) * 0xbf58476d1ce4e5b9U;
  return sum ^ (sum >> 29);
}

}  // namespace

GlbVertices::GlbVertices(const GlbLayout& layout, std::size_t expected_vertices)
    : layout_(layout), table_(std::bit_ceil(2 * expected_vertices + 16), k_free) {
  positions.reserve(expected_vertices);
  normals.reserve(expected_vertices);
  if (layout.tex_coords > 0) uv0.reserve(expected_vertices);
  if (layout.tex_coords > 1) uv1.reserve(expected_vertices);
  if (layout.colors) colors.reserve(expected_vertices);
  if (layout.tangents) handedness.reserve(expected_vertices);
}

GlbVertex GlbVertices::vertex(Index number) const {
  GlbVertex vertex;
  vertex.position = positions[number];
  vertex.normal = normals[number];
  if (layout_.tex_coords > 0) vertex.uv0 = uv0[number];
  if (layout_.tex_coords > 1) vertex.uv1 = uv1[number];
  if (layout_.colors) vertex.color = colors[number];
  if (layout_.tangents) vertex.handedness = handedness[number];
  return vertex;
}

bool GlbVertices::equals(Index number, const GlbVertex& v) const {
  return positions[number] == v.position && normals[number] == v.normal &&
         (layout_.tex_coords < 1 || uv0[number] == v.uv0) && (layout_.tex_coords < 2 || uv1[number] == v.uv1) &&
         (!layout_.colors || colors[number] == v.color) && (!layout_.tangents || handedness[number] == v.handedness);
}

void GlbVertices::append(const GlbVertex& vertex) {
  positions.push_back(vertex.position);
  normals.push_back(vertex.normal);
  if (layout_.tex_coords > 0) uv0.push_back(vertex.uv0);
  if (layout_.tex_coords > 1) uv1.push_back(vertex.uv1);
  if (layout_.colors) colors.push_back(vertex.color);
  if (layout_.tangents) handedness.push_back(vertex.handedness);
}

Index GlbVertices::add_at(const GlbVertex& vertex, std::size_t slot) {
  const std::size_t mask = table_.size() - 1;
  while (table_[slot] != k_free) {
    if (equals(table_[slot], vertex)) return table_[slot];
    slot = (slot + 1) & mask;
  }
  table_[slot] = static_cast<Index>(positions.size());
  append(vertex);
  return table_[slot];
}

void GlbVertices::add(std::span<const GlbVertex> corners, std::span<Index> numbers) {
  std::array<std::size_t, k_batch> slots;
  for (std::size_t begin = 0; begin < corners.size(); begin += k_batch) {
    const auto batch = corners.subspan(begin, std::min(k_batch, corners.size() - begin));
    reserve_slots(batch.size());
    for (std::size_t i = 0; i < batch.size(); ++i) {
      slots[i] = hash(batch[i]) & (table_.size() - 1);
      __builtin_prefetch(&table_[slots[i]]);
    }
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (const Index number = table_[slots[i]]; number != k_free) {
        __builtin_prefetch(&positions[number]);
        __builtin_prefetch(&normals[number]);
      }
    for (std::size_t i = 0; i < batch.size(); ++i) numbers[begin + i] = add_at(batch[i], slots[i]);
  }
}

/// Keeps the table at most half full.
void GlbVertices::reserve_slots(std::size_t further_vertices) {
  const std::size_t needed = 2 * (size() + further_vertices);
  if (needed <= table_.size()) return;
  table_.assign(std::bit_ceil(needed), k_free);
  const std::size_t mask = table_.size() - 1;
  for (Index i = 0; i < size(); ++i) {
    std::size_t slot = hash(vertex(i)) & mask;
    while (table_[slot] != k_free) slot = (slot + 1) & mask;
    table_[slot] = i;
  }
}

void GlbVertices::finish() { table_ = {}; }

}  // namespace papilla
