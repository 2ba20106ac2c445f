// SPDX-License-Identifier: MIT
// Across which edges a relief goes on as one.

#include <algorithm>

#include "contact_triangles.hpp"
#include "position_weld.hpp"

namespace papilla {
namespace {

constexpr std::uint32_t k_most_edges = 256;  // From a position to later ones; with more the relief ends at each.
constexpr std::size_t k_parts = 4;           // Of the positions: one after the other takes less memory.

/// Edge k of triangle t as 3·t + k, by the first of its two positions, for the positions from one to another.
class EdgesByFirst {
 public:
  struct Edge {
    std::uint32_t first, last;  ///< Positions, in the order of their numbers.
    bool backwards;             ///< The triangle has it the other way round.
  };
  /// @param is_left_out by triangle.
  template <class EdgeAt, class IsLeftOut>
  EdgesByFirst(std::size_t from, std::size_t to, std::size_t triangles, const EdgeAt& edge_at,
               const IsLeftOut& is_left_out)
      : start_(to - from + 1) {
    const auto for_each = [&](const auto& visit) {
      for (std::uint32_t t = 0; t < triangles; ++t)
        for (std::uint32_t k = 0; k < 3 && !is_left_out(t); ++k)
          if (const std::size_t first = edge_at(3 * t + k).first; first >= from && first < to)
            visit(first - from, 3 * t + k);
    };
    for_each([&](std::size_t first, std::uint32_t) { ++start_[first]; });
    for (std::size_t p = 1; p < start_.size(); ++p) start_[p] += start_[p - 1];
    edges_.resize(start_.back());
    for_each([&](std::size_t first, std::uint32_t edge) { edges_[--start_[first]] = edge; });
  }
  std::size_t positions() const noexcept { return start_.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t p) const noexcept {
    return {edges_.data() + start_[p], edges_.data() + start_[p + 1]};
  }

 private:
  std::vector<std::uint32_t> start_, edges_;
};

}  // namespace

/// Both triangles have the same height map and, at both ends of the edge, the same place on it and the same base.
bool ContactTriangles::goes_on(std::uint32_t place, std::uint32_t edge, std::uint32_t other,
                               std::uint32_t other_edge) const noexcept {
  return materials_[material_of(place)].height == materials_[material_of(other)].height &&
         relief(place, edge) == relief(other, (other_edge + 1) % 3) &&
         relief(place, (edge + 1) % 3) == relief(other, other_edge);
}

/// Edges of one or of more than two triangles, of needles and between opposite orientations end the relief. Cost:
/// linear, in 12 bytes a triangle besides the result.
void ContactTriangles::continue_relief(const ContactMesh& mesh) {
  continued_.assign(source_.size(), {k_no_place, k_no_place, k_no_place});
  std::vector<std::uint32_t> place_of(mesh.triangles.size(), k_no_place);
  for (std::uint32_t cluster = 0; cluster < clusters_.clusters(); ++cluster)
    for (std::uint32_t i = 0; i < clusters_.triangles_of(cluster); ++i) {
      const std::uint32_t place = cluster * TriangleClusters::k_most + i;
      if (has_relief(place) && !(face_normal(place) == Vec3{})) place_of[source_of(place)] = place;
    }
  std::size_t positions = 0;
  const std::vector<std::uint32_t> position = weld_positions(mesh.positions, positions);
  const auto edge_at = [&](std::uint32_t edge) {
    const auto& corner = mesh.triangles[edge / 3];
    const std::uint32_t from = position[corner[edge % 3]], to = position[corner[(edge + 1) % 3]];
    return EdgesByFirst::Edge{std::min(from, to), std::max(from, to), from > to};
  };
  const auto link = [&](std::uint32_t edge, std::uint32_t other) {
    const std::uint32_t place = place_of[edge / 3], behind = place_of[other / 3];
    if (!goes_on(place, edge % 3, behind, other % 3)) return;
    continued_[clusters_.slot(place)][edge % 3] = behind;
    continued_[clusters_.slot(behind)][other % 3] = place;
  };
  for (std::size_t part = 0; part < k_parts; ++part) {
    const EdgesByFirst edges(part * positions / k_parts, (part + 1) * positions / k_parts, mesh.triangles.size(),
                             edge_at, [&](std::uint32_t t) { return place_of[t] == k_no_place; });
    for (std::size_t p = 0; p < edges.positions(); ++p) {
      const std::span<const std::uint32_t> here = edges.of(p);
      for (std::size_t i = 0; i < here.size() && here.size() <= k_most_edges; ++i) {
        const EdgesByFirst::Edge edge = edge_at(here[i]);
        int others = 0;
        std::uint32_t opposite = k_no_place;
        for (const std::uint32_t other : here) {
          const EdgesByFirst::Edge there = edge_at(other);
          if (other == here[i] || there.last != edge.last) continue;
          ++others;
          if (there.backwards != edge.backwards) opposite = other;
        }
        if (others == 1 && opposite != k_no_place && !edge.backwards) link(here[i], opposite);
      }
    }
  }
}

}  // namespace papilla
