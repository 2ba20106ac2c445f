// SPDX-License-Identifier: MIT
#include "lift_seams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "cheapest_ways.hpp"
#include "straighten_seams.hpp"

namespace papilla::param_detail {
namespace {

/// A way stays within this part of its edge's length from it, and what lies so far off counts so many times as much.
constexpr double k_corridor = 1, k_dearest = 4;

class Lifter {
 public:
  explicit Lifter(const SeamMesh& fine)
      : fine_(fine),
        ways_(fine),
        on_seam_(fine.on_border),
        seam_(fine.opposite.size(), 0),
        place_(fine.on_border.size()) {
    for (Index v = 0; v < place_.size(); ++v) place_[v] = v;
    const OutgoingEdges edges(fine);
    for (Index h = 0; h < seam_.size(); ++h) {
      if (fine.opposite[h] != k_no_triangle) continue;
      seam_[h] = 1;
      const Index v = fine.from(h);
      if (edges.of(v).empty()) place_[v] = fine.to(h);
    }
  }

  /// Ways go round the ends of others.
  void reserve(Index vertex) { on_seam_[place_[vertex]] = 1; }

  void lift(Index from, Index to) {
    from = place_[from], to = place_[to];
    std::vector<Index> way = way_between(from, to, true, k_corridor);
    if (way.empty()) way = way_between(from, to, true, std::numeric_limits<double>::infinity());
    if (way.empty()) way = way_between(from, to, false, std::numeric_limits<double>::infinity());
    for (const Index h : way) {
      seam_[h] = seam_[fine_.opposite[h]] = 1;
      on_seam_[fine_.from(h)] = on_seam_[fine_.to(h)] = 1;
    }
  }

  std::vector<std::uint8_t> seam() { return std::move(seam_); }

 private:
  std::vector<Index> way_between(Index from, Index to, bool keep_clear, double corridor) {
    const Vec3 a = fine_.mesh.positions[from], edge = fine_.mesh.positions[to] - a;
    const double length2 = dot(edge, edge);
    const auto off = [&](Index v) {
      const Vec3 d = fine_.mesh.positions[v] - a;
      const double along = std::clamp(dot(d, edge) / length2, 0.0, 1.0);
      return norm(d - along * edge) / std::sqrt(length2);
    };
    const Index reached = ways_.search(
        std::array{from},
        [&](Index h) { return fine_.cost[h] * (1 + (k_dearest - 1) * std::min(1.0, off(fine_.to(h)))); },
        [&](Index v, double) { return v == to || (!(keep_clear && on_seam_[v]) && off(v) <= corridor); },
        [&](Index v) { return v == to; });
    return reached == to ? ways_.way_to(to) : std::vector<Index>{};
  }

  const SeamMesh& fine_;
  CheapestWays ways_;
  std::vector<char> on_seam_;
  std::vector<std::uint8_t> seam_;
  std::vector<Index> place_;  ///< Per vertex: itself, or the next one on the border where no seam can reach it.
};

}  // namespace

std::vector<std::uint8_t> lift_seams(const SeamMesh& fine, const SeamMesh& coarse, std::span<const Index> vertices,
                                     const std::vector<std::uint8_t>& seam) {
  Lifter lifter(fine);
  double length = 0;
  std::size_t count = 0;
  for (Index h = 0; h < seam.size(); ++h) {
    if (!seam[h] || coarse.opposite[h] == k_no_triangle) continue;
    lifter.reserve(vertices[coarse.from(h)]);
    length += coarse.length(h), ++count;
  }
  if (count == 0) return lifter.seam();
  for (Index h = 0; h < seam.size(); ++h)
    if (seam[h] && coarse.opposite[h] != k_no_triangle && h < coarse.opposite[h])
      lifter.lift(vertices[coarse.from(h)], vertices[coarse.to(h)]);
  return straightened(fine, lifter.seam(), length / static_cast<double>(count));
}

}  // namespace papilla::param_detail
