// SPDX-License-Identifier: MIT
#include "segmentation_steps.hpp"

#include <utility>

#include "papilla/core/union_find.hpp"
#include "piece_cuts.hpp"
#include "polygon_overlap.hpp"

namespace papilla::detail {
namespace {

/// Openings on the way from a patch to a piece; one is enough unless paths run along holes.
constexpr int k_max_openings = 8;
/// Halvings on the way from a patch to a piece.
constexpr int k_max_halvings = 16;

struct Work {
  std::vector<Index> triangles;
  int openings = 0, halvings = 0;
  bool relieved = false;
};

class PatchCutter {
 public:
  PatchCutter(const SegmentedMesh& surface, const SeamWeights& weights, bool disks, PieceCutter& cutter,
              std::vector<std::uint8_t>& seam, PatchCuts& cuts)
      : surface_(surface), weights_(weights), disks_(disks), cutter_(cutter), seam_(seam), cuts_(cuts) {}

  /// Calls finish(piece, work) for every piece of the right topology.
  template <class Finish>
  void run(std::vector<Index> patch, const Finish& finish) {
    pending_.push_back({std::move(patch), 0, 0, false});
    while (!pending_.empty()) {
      Work work = std::move(pending_.back());
      pending_.pop_back();
      const Piece piece = cutter_.cut(std::move(work.triangles));
      if (!open(piece, work)) finish(piece, work);
    }
  }

  void halve(const Piece& piece, Work work) {
    ++cuts_.halving;
    ++work.halvings;
    part(piece, cut_in_halves(piece, weights_), work);
  }

  /// Cuts between two places of the outline that lie over each other.
  void halve(const Piece& piece, const ChartOutline& outline, Work work) {
    const auto crossing = widest_crossing(outline.place);
    if (!crossing) return halve(piece, std::move(work));
    const std::vector<Index> outer = border_loops(piece).front();
    const Index a = triangle_of(outer[crossing->first]), b = triangle_of(outer[crossing->second]);
    if (a == b) return halve(piece, std::move(work));
    ++cuts_.halving;
    ++work.halvings;
    std::vector<Index> one = cut_in_halves(piece, weights_), two = cut_apart(piece, weights_, a, b);
    part(piece, cost(piece, one) < cost(piece, two) ? one : two, work);
  }

  /// Marks the cuts and puts the pieces that they leave back to work.
  void part(const Piece& piece, const std::vector<Index>& cuts, const Work& work) {
    for (const Index h : cuts) {
      const Index global = piece.halfedge_of(h);
      seam_[global] = seam_[surface_.opposite[global]] = 1;
    }
    UnionFind sets(piece.size());
    for (Index h = 0; h < piece.opposite.size(); ++h)
      if (piece.opposite[h] != k_none && !seam_[piece.halfedge_of(h)])
        sets.unite(triangle_of(h), triangle_of(piece.opposite[h]));
    Index count = 0;
    const std::vector<Index> label = sets.labels(count);
    std::vector<std::vector<Index>> parts(count);
    for (Index t = 0; t < piece.size(); ++t) parts[label[t]].push_back(piece.triangle_of[t]);
    for (auto& triangles : parts)
      pending_.push_back({std::move(triangles), work.openings, work.halvings, work.relieved});
  }

 private:
  double cost(const Piece& piece, const std::vector<Index>& cuts) const {
    double sum = 0;
    for (const Index h : cuts) sum += weights_.cost(piece.halfedge_of(h));
    return sum;
  }

  /// True when the piece was not of the right topology and its parts wait.
  bool open(const Piece& piece, Work& work) {
    const Opening opening = open_chart(piece, weights_, disks_);
    if (opening.possible && opening.cuts.empty()) return false;
    if (!opening.possible || work.openings >= k_max_openings) return halve(piece, work), true;
    ++cuts_.opening;
    ++work.openings;
    part(piece, opening.cuts, work);
    return true;
  }

  const SegmentedMesh& surface_;
  const SeamWeights& weights_;
  bool disks_;
  PieceCutter& cutter_;
  std::vector<std::uint8_t>& seam_;
  PatchCuts& cuts_;
  std::vector<Work> pending_;
};

}  // namespace

std::vector<ChartOutline> cut_patch(const SegmentedMesh& surface, const SeamWeights& weights,
                                    const SegmentationOptions& options, std::vector<Index> triangles,
                                    PieceCutter& cutter, std::vector<std::uint8_t>& seam, PatchCuts& cuts,
                                    const std::function<void(std::size_t)>& finished) {
  PatchCutter patch(surface, weights, options.disks, cutter, seam, cuts);
  std::vector<ChartOutline> charts;
  patch.run(std::move(triangles), [&](const Piece& piece, Work& work) {
    ChartField field(piece);
    if (!std::exchange(work.relieved, true)) {
      const std::vector<Index> relief = relieve(piece, field, weights, options.seam_cost);
      if (!relief.empty()) {
        ++cuts.relief;
        return patch.part(piece, relief, work);
      }
    }
    ChartOutline outline = make_outline(piece, field);
    if (piece.size() > 1 && work.halvings < k_max_halvings && overlaps_itself(outline.place))
      return patch.halve(piece, outline, work);
    charts.push_back(std::move(outline));
    finished(piece.size());
  });
  return charts;
}

void open_patch(const SegmentedMesh& surface, const SeamWeights& weights, bool disks, std::vector<Index> triangles,
                PieceCutter& cutter, std::vector<std::uint8_t>& seam) {
  PatchCuts cuts;
  PatchCutter(surface, weights, disks, cutter, seam, cuts).run(std::move(triangles), [](const Piece&, Work&) {});
}

}  // namespace papilla::detail
