// SPDX-License-Identifier: MIT
// Across which edges a relief goes on as one.

#include "contact_triangles.hpp"
#include "position_weld.hpp"

namespace papilla {
namespace {

constexpr std::uint32_t k_most_edges = 256;  // From a position; where there are more, the relief ends at each.

constexpr std::uint32_t k_none = 0xffffffffU;

struct Ends {
  std::uint32_t from, to;  ///< Positions.
};

/// The directed edges that leave each position.
template <class EndsOf>
class EdgesByStart {
 public:
  /// @param ends_of a directed edge, of all numbers below `edges`. @param left_out edges to ignore.
  template <class LeftOut>
  EdgesByStart(std::size_t positions, std::uint32_t edges, const EndsOf& ends_of, const LeftOut& left_out)
      : ends_of_(&ends_of), first_(positions + 1) {
    for (std::uint32_t e = 0; e < edges; ++e)
      if (!left_out(e)) ++first_[ends_of(e).from];
    for (std::size_t p = 1; p <= positions; ++p) first_[p] += first_[p - 1];
    edges_.resize(first_[positions]);
    for (std::uint32_t e = edges; e-- > 0;)
      if (!left_out(e)) edges_[--first_[ends_of(e).from]] = e;
  }

  /// The only edge between two positions in this direction; k_none when there is none or several.
  std::uint32_t only(Ends ends) const {
    std::uint32_t found = k_none;
    if (first_[ends.from + 1] - first_[ends.from] > k_most_edges) return found;
    for (std::uint32_t i = first_[ends.from]; i < first_[ends.from + 1]; ++i) {
      if ((*ends_of_)(edges_[i]).to != ends.to) continue;
      if (found != k_none) return k_none;
      found = edges_[i];
    }
    return found;
  }

 private:
  const EndsOf* ends_of_;
  std::vector<std::uint32_t> first_, edges_;
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
/// linear, in 36 bytes a triangle besides the result.
void ContactTriangles::continue_relief(const ContactMesh& mesh) {
  std::vector<std::uint32_t> place_at;  // By slot.
  place_at.reserve(source_.size());
  arch_.reserve(source_.size());
  for (std::uint32_t cluster = 0; cluster < clusters_.clusters(); ++cluster)
    for (std::uint32_t i = 0; i < clusters_.triangles_of(cluster); ++i) {
      const std::uint32_t place = cluster * TriangleClusters::k_most + i;
      place_at.push_back(place);
      arch_.push_back(has_relief(place) && !(face_normal(place) == Vec3{}) ? 0 : k_no_arch);
    }
  const auto edges = static_cast<std::uint32_t>(3 * source_.size());
  std::vector<std::uint32_t> opposite(edges, k_no_place);
  {
    std::size_t positions = 0;
    const std::vector<std::uint32_t> position = weld_positions(mesh.positions, positions);
    const auto ends_of = [&](std::uint32_t edge) {
      const auto& corner = mesh.triangles[source_[edge / 3]];
      return Ends{position[corner[edge % 3]], position[corner[(edge + 1) % 3]]};
    };
    const EdgesByStart by_start(positions, edges, ends_of,
                                [&](std::uint32_t edge) { return arch_[edge / 3] == k_no_arch; });
    for (std::uint32_t edge = 0; edge < edges; ++edge) {
      const Ends ends = ends_of(edge);
      const std::uint32_t there = by_start.only({ends.to, ends.from});
      if (there != k_none && by_start.only(ends) == edge &&
          goes_on(place_at[edge / 3], edge % 3, place_at[there / 3], there % 3))
        opposite[edge] = there;
    }
  }
  find_arches(opposite, place_at);
  continued_.reserve(source_.size());
  for (std::size_t slot = 0; slot < source_.size(); ++slot) {
    Continued& across = continued_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t there = opposite[3 * slot + k];
      across[k] = there == k_no_place ? k_no_place : place_at[there / 3];
    }
  }
}

}  // namespace papilla
