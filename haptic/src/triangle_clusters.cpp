// SPDX-License-Identifier: MIT
#include "triangle_clusters.hpp"

#include <cmath>
#include <limits>
#include <thread>

namespace papilla {
namespace {

constexpr std::uint32_t k_group = 4;
constexpr std::size_t k_least_for_threads = 1024;  // Clusters.
constexpr int k_least_exponent = -120, k_largest_exponent = 120;
constexpr std::size_t k_line = 64;
constexpr float k_rounding = 4 * std::numeric_limits<float>::epsilon();

void prefetch_bytes(const void* from, std::size_t bytes) noexcept {
  const auto* at = static_cast<const char*>(from);
  for (std::size_t byte = 0; byte < bytes + k_line - 1; byte += k_line) __builtin_prefetch(at + byte);
}

float middle(const Box3f& box, std::size_t axis) noexcept { return 0.5F * box.low[axis] + 0.5F * box.high[axis]; }

std::size_t widest_axis(std::span<const BoxedItem> items) noexcept {
  Box3f centres;
  for (const auto& [box, item] : items) {
    const std::array<float, 3> c{middle(box, 0), middle(box, 1), middle(box, 2)};
    centres.add(Box3f{c, c});
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (centres.high[k] - centres.low[k] > centres.high[axis] - centres.low[axis]) axis = k;
  return axis;
}

/// Halves the items along their widest axis down to groups; all groups but the last are full.
void sort_into_groups(std::span<BoxedItem> items) {
  if (items.size() <= k_group) return;
  const std::size_t axis = widest_axis(items);
  const std::size_t half = (items.size() / 2 + k_group - 1) / k_group * k_group;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [axis](const BoxedItem& a, const BoxedItem& b) {
                     const float x = middle(a.box, axis), y = middle(b.box, axis);
                     return x != y ? x < y : a.item < b.item;
                   });
  sort_into_groups(items.first(half));
  sort_into_groups(items.subspan(half));
}

/// Exponent of the finest power-of-two cells of which 255 span the extent.
int exponent_of(float extent) noexcept {
  if (!(extent > 0)) return k_largest_exponent;
  int exponent = 0;
  std::frexp(extent, &exponent);  // extent < 2^exponent: less than 128 cells of 2^(exponent − 7).
  const bool finer = std::ldexp(extent, 8 - exponent) < 254;
  return std::clamp((finer ? 8 : 7) - exponent, k_least_exponent, k_largest_exponent);
}

}  // namespace

/// Welds corners of a cluster with equal position and relief, by a hash table with open addressing.
struct TriangleClusters::Weld {
  static constexpr std::size_t k_slots = 512;
  static constexpr std::uint8_t k_none = 0xff;

  TriangleClusters& to;
  bool with_relief;
  std::vector<Vertex> known{};
  std::array<std::uint8_t, k_slots> table{};

  void begin() {
    known.clear();
    table.fill(k_none);
  }

  std::uint8_t add(Vertex vertex) {
    if (!with_relief) vertex.relief = {};
    std::array<float, 6> key = {vertex.corner[0], vertex.corner[1], vertex.corner[2],
                                vertex.relief.u,  vertex.relief.v,  vertex.relief.shift};
    std::uint64_t hash = 0;
    for (float& value : key) {
      value += 0.0F;  // −0 becomes +0.
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29;
    }
    for (std::size_t at = hash % k_slots;; at = (at + 1) % k_slots) {
      if (table[at] != k_none && !(known[table[at]] == vertex)) continue;
      if (table[at] == k_none) {
        table[at] = static_cast<std::uint8_t>(known.size());
        known.push_back(vertex);
        to.vertices_.push_back(vertex.corner);
        if (with_relief) to.reliefs_.push_back(vertex.relief);
      }
      return table[at];
    }
  }
};

TriangleClusters::TriangleClusters(std::vector<BoxedItem> boxes,
                                   const std::function<std::array<Vertex, 3>(std::uint32_t)>& corners,
                                   bool with_relief) {
  build_clusters(boxes);
  order_.reserve(boxes.size());
  for (const BoxedItem& box : boxes) order_.push_back(box.item);
  boxes = std::vector<BoxedItem>();  // Not {}, which keeps the memory.
  corners_.reserve(order_.size());
  vertices_.reserve(order_.size());  // Meshes of good triangles have fewer: 0.7 of them, with those on borders.
  if (with_relief) reliefs_.reserve(order_.size());
  Weld weld{*this, with_relief};
  for (Cluster& cluster : clusters_) {
    weld.begin();
    cluster.vertex = static_cast<std::uint32_t>(vertices_.size());
    for (std::uint32_t i = 0; i < cluster.count; ++i) {
      const std::array<Vertex, 3> of = corners(order_[cluster.first + i]);
      corners_.push_back({weld.add(of[0]), weld.add(of[1]), weld.add(of[2])});
    }
    cluster.vertices = static_cast<std::uint8_t>(weld.known.size());
  }
  vertices_.shrink_to_fit();
  reliefs_.shrink_to_fit();
}

/// Quantizes the boxes of a cluster's groups, into which its items are sorted.
void TriangleClusters::set_groups(Cluster& cluster, std::span<BoxedItem> items) {
  sort_into_groups(items);
  Box3f all;
  for (const BoxedItem& item : items) all.add(item.box);
  cluster.origin = all.low;
  for (std::size_t k = 0; k < 3; ++k)
    cluster.exponent[k] = static_cast<std::int8_t>(exponent_of(all.high[k] - all.low[k]));
  for (std::size_t g = 0; g < k_groups; ++g) {
    Box3f group;
    for (std::size_t i = k_group * g; i < std::min<std::size_t>(k_group * (g + 1), items.size()); ++i)
      group.add(items[i].box);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool empty = !(group.low[k] <= group.high[k]);
      cluster.low[k][g] = empty ? 255 : cluster.cell(group.low[k], k);
      cluster.high[k][g] = empty ? 0 : cluster.cell(group.high[k], k);
    }
  }
}

void TriangleClusters::build_clusters(std::span<BoxedItem> boxes) {
  tree_ = Bvh(boxes, k_most);
  const std::vector<std::uint32_t> begins = tree_.number_leaves();
  clusters_.resize(begins.size() - 1);
  const auto set = [&](std::size_t from, std::size_t to) noexcept {
    for (std::size_t c = from; c < to; ++c) {
      clusters_[c].first = begins[c];
      clusters_[c].count = static_cast<std::uint8_t>(begins[c + 1] - begins[c]);
      set_groups(clusters_[c], boxes.subspan(begins[c], clusters_[c].count));
    }
  };
  if (clusters_.size() < k_least_for_threads || std::thread::hardware_concurrency() < 2)
    return set(0, clusters_.size());
  const std::size_t half = clusters_.size() / 2;
  std::thread other(set, half, clusters_.size());
  set(0, half);
  other.join();
}

/// Grown by one cell and the rounding of single precision.
Box3f TriangleClusters::box_of(std::uint32_t block) const noexcept {
  const Cluster& c = clusters_[block / k_blocks];
  const std::size_t begin = block % k_blocks * (k_block / k_group);
  Box3f box;
  for (std::size_t k = 0; k < 3; ++k) {
    std::uint8_t low = 255, high = 0;
    for (std::size_t g = begin; g < begin + k_block / k_group; ++g) {
      low = std::min(low, c.low[k][g]);
      high = std::max(high, c.high[k][g]);
    }
    const float cell = std::bit_cast<float>(static_cast<std::uint32_t>(127 - c.exponent[k]) << 23);
    const float error = k_rounding * (std::abs(c.origin[k]) + 256 * cell);
    box.low[k] = c.origin[k] + cell * static_cast<float>(low) - error;
    box.high[k] = c.origin[k] + cell * static_cast<float>(high + 1) + error;
  }
  return box;
}

void TriangleClusters::prefetch(std::uint32_t cluster) const noexcept {
  prefetch_bytes(&clusters_[cluster], sizeof(Cluster));
}

void TriangleClusters::prefetch_block(std::uint32_t block) const noexcept {
  const Cluster& c = clusters_[block / k_blocks];
  prefetch_bytes(&corners_[c.first + block % k_blocks * k_block], k_block * sizeof(corners_[0]));
  prefetch_bytes(&vertices_[c.vertex], c.vertices * sizeof(vertices_[0]));
}

std::size_t TriangleClusters::bytes() const noexcept {
  return tree_.bytes() + clusters_.size() * sizeof(Cluster) + corners_.size() * sizeof(corners_[0]) +
         vertices_.size() * sizeof(Corner) + reliefs_.size() * sizeof(Relief);
}

}  // namespace papilla
