// SPDX-License-Identifier: MIT
#include "segmentation_steps.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <atomic>
#include <cmath>
#include <iterator>
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
              std::vector<std::uint8_t>& seam)
      : surface_(surface), weights_(weights), disks_(disks), cutter_(cutter), seam_(seam) {}

  /// Calls finish(piece, work, charts) for every piece of the right topology, which adds to the charts or returns the
  /// parts that it cut the piece into. Parts go on in parallel; the order of the charts does not depend on it.
  template <class Finish>
  std::vector<ChartOutline> run(Work work, const Finish& finish) {
    std::vector<ChartOutline> charts;
    std::vector<Work> parts;
    {
      const Piece piece = cutter_.cut(std::move(work.triangles));
      parts = open(piece, work);
      if (parts.empty()) parts = finish(piece, work, charts);
    }
    std::vector<std::vector<ChartOutline>> of_parts(parts.size());
    oneapi::tbb::parallel_for(std::size_t{0}, parts.size(),
                              [&](std::size_t i) { of_parts[i] = run(std::move(parts[i]), finish); });
    for (std::vector<ChartOutline>& of_part : of_parts)
      charts.insert(charts.end(), std::make_move_iterator(of_part.begin()), std::make_move_iterator(of_part.end()));
    return charts;
  }

  std::vector<Work> halve(const Piece& piece, Work work) {
    ++halvings_;
    ++work.halvings;
    return part(piece, cut_in_halves(piece, weights_), work);
  }

  /// Cuts between two places of the outline that lie over each other.
  std::vector<Work> halve(const Piece& piece, const ChartOutline& outline, Work work) {
    const auto crossing = widest_crossing(outline.place);
    if (!crossing) return halve(piece, std::move(work));
    const std::vector<Index> outer = border_loops(piece).front();
    const Index a = triangle_of(outer[crossing->first]), b = triangle_of(outer[crossing->second]);
    if (a == b) return halve(piece, std::move(work));
    ++halvings_;
    ++work.halvings;
    std::vector<Index> one, two;
    oneapi::tbb::parallel_invoke([&] { one = cut_in_halves(piece, weights_); },
                                 [&] { two = cut_apart(piece, weights_, a, b); });
    return part(piece, cost(piece, one) < cost(piece, two) ? one : two, work);
  }

  std::vector<Work> relieve(const Piece& piece, const std::vector<Index>& cuts, const Work& work) {
    ++reliefs_;
    return part(piece, cuts, work);
  }

  PatchCuts cuts() const { return {openings_, reliefs_, halvings_}; }

 private:
  double cost(const Piece& piece, const std::vector<Index>& cuts) const {
    double sum = 0;
    for (const Index h : cuts) sum += weights_.cost(piece.halfedge_of(h));
    return sum;
  }

  /// Marks the cuts; the pieces that they leave.
  std::vector<Work> part(const Piece& piece, const std::vector<Index>& cuts, const Work& work) {
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
    std::vector<Work> parts(count, {{}, work.openings, work.halvings, work.relieved});
    // The last one first, which is how charts are numbered.
    for (Index t = 0; t < piece.size(); ++t) parts[count - 1 - label[t]].triangles.push_back(piece.triangle_of[t]);
    return parts;
  }

  /// The parts of a piece that was not of the right topology.
  std::vector<Work> open(const Piece& piece, Work& work) {
    const Opening opening = open_chart(piece, weights_, disks_);
    if (opening.possible && opening.cuts.empty()) return {};
    if (!opening.possible || work.openings >= k_max_openings) return halve(piece, work);
    ++openings_;
    ++work.openings;
    return part(piece, opening.cuts, work);
  }

  const SegmentedMesh& surface_;
  const SeamWeights& weights_;
  bool disks_;
  PieceCutter& cutter_;
  std::vector<std::uint8_t>& seam_;
  std::atomic<std::size_t> openings_{0}, reliefs_{0}, halvings_{0};
};

}  // namespace

std::vector<ChartOutline> cut_patch(const SegmentedMesh& surface, const SeamWeights& weights,
                                    const SegmentationOptions& options, std::vector<Index> triangles,
                                    PieceCutter& cutter, std::vector<std::uint8_t>& seam, PatchCuts& cuts,
                                    const std::function<void(std::size_t)>& finished) {
  PatchCutter patch(surface, weights, options.disks, cutter, seam);
  std::vector<ChartOutline> result =
      patch.run({std::move(triangles), 0, 0, false},
                [&](const Piece& piece, Work& work, std::vector<ChartOutline>& charts) -> std::vector<Work> {
                  ChartField field(piece);
                  if (!std::exchange(work.relieved, true)) {
                    const double unit = options.common_price ? std::sqrt(surface.total_area / piece.area()) : 1;
                    const std::vector<Index> relief = relieve(piece, field, weights, unit * options.seam_cost);
                    if (!relief.empty()) return patch.relieve(piece, relief, work);
                  }
                  ChartOutline outline = make_outline(piece, field);
                  if (piece.size() > 1 && work.halvings < k_max_halvings && overlaps_itself(outline.place))
                    return patch.halve(piece, outline, work);
                  charts.push_back(std::move(outline));
                  finished(piece.size());
                  return {};
                });
  cuts = patch.cuts();
  return result;
}

void open_patch(const SegmentedMesh& surface, const SeamWeights& weights, bool disks, std::vector<Index> triangles,
                PieceCutter& cutter, std::vector<std::uint8_t>& seam) {
  PatchCutter(surface, weights, disks, cutter, seam)
      .run({std::move(triangles), 0, 0, false},
           [](const Piece&, Work&, std::vector<ChartOutline>&) { return std::vector<Work>(); });
}

}  // namespace papilla::detail
