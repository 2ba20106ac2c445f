// SPDX-License-Identifier: MIT
#include "cut_patch.hpp"

#include <utility>

#include "open_chart.hpp"
#include "polygon_overlap.hpp"
#include "relief_cut.hpp"
#include "union_find.hpp"

namespace papilla::detail {
namespace {

/// Of an outline may lie over itself: what the layout is exact to.
constexpr double k_max_overlap = 1e-3;
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
  PatchCutter(const Surface& surface, const SeamWeights& weights, const SegmentationOptions& options,
              PieceCutter& cutter, std::vector<std::uint8_t>& seam, PatchCuts& cuts)
      : surface_(surface), weights_(weights), options_(options), cutter_(cutter), seam_(seam), cuts_(cuts) {}

  std::vector<ChartOutline> run(std::vector<Index> patch) {
    pending_.push_back({std::move(patch), 0, 0, false});
    while (!pending_.empty()) {
      Work work = std::move(pending_.back());
      pending_.pop_back();
      step(std::move(work));
    }
    return std::move(charts_);
  }

 private:
  void step(Work work) {
    Piece piece = cutter_.cut(std::move(work.triangles));
    const Opening opening = open_chart(piece, weights_, options_.disks);
    if (!opening.possible || work.openings > k_max_openings) {
      ++cuts_.halving;
      return part(piece, cut_in_halves(piece), work);
    }
    if (!opening.cuts.empty()) {
      ++cuts_.opening;
      ++work.openings;
      return part(piece, opening.cuts, work);
    }
    ChartField field(piece);
    if (!work.relieved) {
      work.relieved = true;
      const std::vector<Index> relief = relieve(piece, field, weights_, options_.seam_cost);
      if (!relief.empty()) {
        ++cuts_.relief;
        return part(piece, relief, work);
      }
    }
    ChartOutline outline = make_outline(piece, field);
    if (piece.size() > 1 && work.halvings < k_max_halvings && overlap_fraction(outline.place) > k_max_overlap) {
      ++cuts_.halving;
      ++work.halvings;
      return part(piece, cut_in_halves(piece), work);
    }
    charts_.push_back(std::move(outline));
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

  const Surface& surface_;
  const SeamWeights& weights_;
  const SegmentationOptions& options_;
  PieceCutter& cutter_;
  std::vector<std::uint8_t>& seam_;
  PatchCuts& cuts_;
  std::vector<Work> pending_;
  std::vector<ChartOutline> charts_;
};

}  // namespace

std::vector<ChartOutline> cut_patch(const Surface& surface, const SeamWeights& weights,
                                    const SegmentationOptions& options, std::vector<Index> triangles,
                                    PieceCutter& cutter, std::vector<std::uint8_t>& seam, PatchCuts& cuts) {
  return PatchCutter(surface, weights, options, cutter, seam, cuts).run(std::move(triangles));
}

}  // namespace papilla::detail
