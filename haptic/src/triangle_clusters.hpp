// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "bvh.hpp"
#include "large_array.hpp"

namespace papilla {

/// Clusters of up to 64 neighbouring triangles, under a tree of the clusters.
///
/// Searches in large meshes are bound by memory, not by arithmetic. A cluster is therefore two cache lines with its
/// origin and a box for every four triangles, 8 bits a coordinate, tested all at once. Its vertices are contiguous and
/// indexed by 8 bits. The tree is a fiftieth of one over triangles and stays in the cache. Boxes are rounded outwards.
/// Vertices that several clusters share are stored once in each.
///
/// A triangle is identified by its place, 64 · cluster + index; the owner's data of it is at slot(place).
/// Build: O(n log n), deterministic, in 28 bytes a triangle besides the result. Memory: about 15 bytes a triangle (with
/// relief 24). Queries are noexcept and allocate nothing.
class TriangleClusters {
 public:
  static constexpr std::uint32_t k_most = 64;  ///< Triangles in a cluster.
  using Corner = std::array<float, 3>;
  struct Relief {
    float u, v;
    float shift;  ///< Offset of the base along the vertex normal, ≤ 0.
    friend bool operator==(const Relief&, const Relief&) = default;
  };
  struct Vertex {
    Corner corner;
    Relief relief;
    friend bool operator==(const Vertex&, const Vertex&) = default;
  };

  TriangleClusters() = default;
  /// @param boxes of the triangles with their relief, finite, and the triangles' numbers. Freed on the way.
  /// @param corners triangle → its vertices. @param with_relief false: Vertex::relief is not stored.
  TriangleClusters(std::vector<BoxedItem> boxes, const std::function<std::array<Vertex, 3>(std::uint32_t)>& corners,
                   bool with_relief);

  /// Number of the input triangle at each slot; moves it out.
  LargeArray<std::uint32_t> take_order() noexcept { return std::exchange(order_, {}); }
  std::size_t triangles() const noexcept { return corners_.size(); }
  std::size_t bytes() const noexcept;

  std::uint32_t clusters() const noexcept { return static_cast<std::uint32_t>(clusters_.size()); }
  std::uint32_t triangles_of(std::uint32_t cluster) const noexcept { return clusters_[cluster].count; }
  std::uint32_t slot(std::uint32_t place) const noexcept { return clusters_[place / k_most].first + place % k_most; }
  const Corner& corner(std::uint32_t place, std::size_t k) const noexcept { return vertices_[vertex(place, k)]; }
  const Relief& relief(std::uint32_t place, std::size_t k) const noexcept { return reliefs_[vertex(place, k)]; }

  /// Calls visit(cluster) for each with a point nearer than `radius` to `centre`, in order of distance. `visit` may
  /// shrink `radius`.
  template <class Visit>
  void within(Vec3 centre, double& radius, Visit&& visit) const noexcept {
    tree_.within(centre, radius, [&](std::uint32_t cluster, std::uint32_t) noexcept { visit(cluster); });
  }

  /// Calls visit(cluster) for each that comes nearer than `radius` to the points from + t·way, t ∈ [0, t_max], in
  /// order of entry. `visit` may shrink `t_max`.
  template <class Visit>
  void along(Vec3 from, Vec3 way, double radius, double& t_max, Visit&& visit) const noexcept {
    tree_.along(from, way, radius, t_max, [&](std::uint32_t cluster, std::uint32_t) noexcept { visit(cluster); });
  }

  /// Calls visit(place) for the triangles of a cluster, in groups of four, whose group box overlaps `box`.
  template <class Visit>
  void in_box(std::uint32_t cluster, const Box3f& box, Visit&& visit) const noexcept {
    const Cluster& c = clusters_[cluster];
    for (std::uint32_t groups = c.overlaps(box); groups != 0; groups &= groups - 1) {
      const std::uint32_t begin = k_group * static_cast<std::uint32_t>(std::countr_zero(groups));
      for (std::uint32_t i = begin; i < std::min(begin + k_group, std::uint32_t{c.count}); ++i)
        visit(cluster * k_most + i);
    }
  }

  /// Blocks of up to k_block neighbouring triangles of a cluster: places from k_block · index on.
  static constexpr std::uint32_t k_block = 16;
  std::uint32_t first_block(std::uint32_t cluster) const noexcept { return cluster * k_blocks; }
  std::uint32_t blocks_of(std::uint32_t cluster) const noexcept {
    return (triangles_of(cluster) + k_block - 1) / k_block;
  }
  std::uint32_t triangles_in(std::uint32_t block) const noexcept {
    return std::min(k_block, clusters_[block / k_blocks].count - block % k_blocks * k_block);
  }
  /// Box of the triangles of a block with their relief.
  Box3f box_of(std::uint32_t block) const noexcept;

  /// Prefetches the boxes of a cluster.
  void prefetch(std::uint32_t cluster) const noexcept;
  /// Prefetches the triangles of a block and the vertices of its cluster.
  void prefetch_block(std::uint32_t block) const noexcept;

 private:
  static constexpr std::uint32_t k_group = 4, k_groups = k_most / k_group, k_blocks = k_most / k_block;

  struct alignas(64) Cluster {
    std::array<std::array<std::uint8_t, k_groups>, 3> low{}, high{};  // Of each group, in cells.
    std::array<float, 3> origin{};                                    // Low corner of cell 0.
    std::array<std::int8_t, 3> exponent{};                            // Cells per metre: 2^exponent.
    std::uint8_t count = 0;
    std::uint32_t first = 0;   // Slot of the first triangle.
    std::uint32_t vertex = 0;  // The first vertex.
    std::uint8_t vertices = 0;

    /// Rounded down; monotone, so that boxes which overlap in metres overlap in cells.
    std::uint8_t cell(float x, std::size_t axis) const noexcept {
      const float cells = std::bit_cast<float>(static_cast<std::uint32_t>(exponent[axis] + 127) << 23);
      return static_cast<std::uint8_t>(std::clamp((x - origin[axis]) * cells, 0.0F, 255.0F));
    }
    /// A bit for each group whose box overlaps `box`.
    std::uint32_t overlaps(const Box3f& box) const noexcept {
      std::array<std::uint8_t, 3> from{}, to{};
      for (std::size_t k = 0; k < 3; ++k) from[k] = cell(box.low[k], k), to[k] = cell(box.high[k], k);
      std::array<std::uint8_t, k_groups> met{};
      for (std::size_t g = 0; g < k_groups; ++g)
        met[g] = static_cast<std::uint8_t>((low[0][g] <= to[0]) & (high[0][g] >= from[0]) & (low[1][g] <= to[1]) &
                                           (high[1][g] >= from[1]) & (low[2][g] <= to[2]) & (high[2][g] >= from[2]));
      std::uint32_t groups = 0;
      for (std::size_t g = 0; g < k_groups; ++g) groups |= std::uint32_t{met[g]} << g;
      return groups;
    }
  };
  static_assert(sizeof(Cluster) == 128);
  struct Weld;

  std::uint32_t vertex(std::uint32_t place, std::size_t k) const noexcept {
    const Cluster& c = clusters_[place / k_most];
    return c.vertex + corners_[c.first + place % k_most][k];
  }
  static void set_groups(Cluster& cluster, std::span<BoxedItem> items);
  void build_clusters(std::span<BoxedItem> boxes);

  Bvh tree_;
  LargeArray<Cluster> clusters_;
  LargeArray<std::array<std::uint8_t, 3>> corners_;
  LargeArray<Corner> vertices_;
  LargeArray<Relief> reliefs_;
  LargeArray<std::uint32_t> order_;
};

}  // namespace papilla
