// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "papilla/core/deadline.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/param/chart_choice.hpp"
#include "papilla/param/flattening.hpp"

namespace papilla {

/// What the distortion of a part may be at most: of e = σ1² + σ2² + σ1⁻² + σ2⁻² of its triangles, 4 at an isometry, the
/// mean by area, or a percentile by area.
struct DistortionBound {
  double most = 4.1;                      ///< At least 4.
  std::optional<double> percentile = {};  ///< In (0, 100]; not given: the mean.
};

/// What a bound limits: Σ A e / Σ A over all triangles, or the least e that this per cent of the area does not exceed.
/// The uv count as they are, in the mesh's unit; infinite where a triangle is flipped. O(n log n).
/// @throws InvalidInput when the uv do not fit the mesh.
double bounded_distortion(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, const DistortionBound& bound);

/// Charts with their cuts, a map of them, and what it was that mapped them.
struct ChartedMap {
  Flattening flattening;
  std::vector<ChartChoice> choices;
};

struct CoarseSurface;

/// What keep_bound() works with.
struct SeamTools {
  /// Charts of the whole mesh for a seam cost, with seams along features or only where they are needed, and their map.
  /// Throws Cancelled when the deadline ends it.
  std::function<ChartedMap(double seam_cost, bool feature_seams)> chart;
  /// The map of given charts; notes where one has none. It is of no use where Σ A (e - 4) is more than
  /// `most_excess_mm2` in a chart: that may then be mapped in any way in which it is. `nearby` is a map with much the
  /// same charts, from which this one may begin, or null.
  std::function<ChartedMap(const ChartSet&, double most_excess_mm2, const CornerAttribute<Vec2>* nearby)> map;
  /// Charts with the named ones cut in two.
  std::function<ChartSet(const ChartSet&, std::span<const std::uint32_t>)> halve;
  std::vector<double> seam_costs;  ///< Per half-edge 3 t + k: what a seam there counts [mm]; not negative.
  /// Given: surfaces on which seams are sought first, to be finished on the whole mesh. The one for the first attempt,
  /// and another one for the next where little comes of that; null: there is none. They have to outlive the search.
  std::function<const CoarseSurface*(std::size_t attempt)> coarse;
  /// Fewer seams are tried: of charts with and without seams along features the cheapest go on, none beyond the bound,
  /// no tips are moved, closing is given up sooner on the whole mesh, and after a hundred maps seams for another coarse
  /// bound are not searched on.
  bool brief = false;
};

/// A surface with fewer triangles.
struct CoarseSurface {
  const TriangleMesh& mesh;
  std::span<const Index> vertices;  ///< Per vertex: which one of the fine mesh it is.
  SeamTools tools;                  ///< For this mesh.
};

/// One map on the way to the result.
struct SeamSample {
  double seconds = 0;         ///< Since keep_bound() was entered.
  std::size_t triangles = 0;  ///< Of the mesh that was mapped: the coarse one or the whole.
  double seam_mm = 0;         ///< Length of its seams.
  double seam_cost_mm = 0;    ///< Σ of SeamTools::seam_costs over them.
  double distortion = 0;      ///< bounded_distortion().
};

struct BoundedSeams {
  ChartedMap charted;
  bool kept = false;      ///< The bound is kept, up to k_bound_slack.
  double distortion = 0;  ///< bounded_distortion().
  double seam_mm = 0, seam_cost_mm = 0;
  std::vector<SeamSample> trace;  ///< Of all maps that were made, those that were refused too.
  StopReason stop = StopReason::converged;
};

/// What a distortion may exceed its bound by: the exactness of maps that are isometries.
inline constexpr double k_bound_slack = 1e-6;

/// Charts and map of a part with short seams whose distortion keeps a bound: seeks the least
///     S = Σ c_h over the seams h,   with D <= bound,
/// c the costs that are given, D bounded_distortion(). It is the problem of [Li et al., OptCuts, 2018].
///
/// Method. 1. The seam cost λ of the segmentation is bracketed in factors of four and halved once, with seams along
/// features and without: of what keeps the bound the cheapest of either go on, and of what is near it and has fewer
/// seams the cheapest, once their seams have become longer where that releases most energy per cost: a slit that is δ
/// wide at the distance r from its tip releases π δ² / (4 r) per length [Irwin 1957] when it runs on, turned by the
/// angle of the greatest hoop tension [Erdogan and Sih 1963]; a new one, across a tension ε from a stretched seam or
/// border, 8 π (∫ ε)². Where no seam cost is low enough, the charts of most energy are halved. 2. Seams are shortened
/// in rounds. Closing a slit from its tip over a gap δ of the map raises the energy Σ A (e - 4) by about π δ² / 4 (the
/// energy release rate of a crack in a sheet of this energy); joining two charts over a stretch by about 3/2 of the
/// largest gap squared that a rigid motion leaves. Of all slits and stretches each round takes those lengths that save
/// most per energy for the energy that is left; the charts are mapped anew, and what came out worse than foreseen
/// around a place counts as dearer there from then on. A round that breaks the bound is taken back and made with half
/// of the energy. 3. Stretches between two places where seams meet or end are laid along the cheapest way beside the
/// old one while the bound allows it; then rounds begin again. 4. Of the cheapest that comes of it, stretches without
/// which the seams would fall into two pieces are exchanged for the cheapest way between these (key-path exchange, [Voß
/// 1992]). 5. It is brought away from the bound and back, its slits end at other vertices, its stretches move sideways
/// to where the energy on both sides, e_right - e_left per area that they sweep over, and their cost are least together
/// (a least cut), and 4. begins again while that pays. No seams are mapped twice as long as they are remembered, but
/// those whose map was left unfinished and is wanted whole; a map may begin at that of the seams that it was made of.
///
/// With `coarse`, all that is done on the coarse mesh, for a bound under which the fine map of the same seams comes out
/// at the one that is asked for: found from the ratio of their D - 4, once when first seams are short and up to four
/// times at the end. Seams are lifted to the fine mesh edge by edge, zigzags straightened within a coarse edge, and
/// their map begins at the coarse one; 2. and 3. finish them there. Where nothing comes of that, or seams that are much
/// longer than what was lifted, the next coarse mesh is searched, and at last the whole one.
///
/// Guarantees: the charts are those of `map`, of genus 0 with a border when those of `chart` are. `kept` says whether
/// the bound is kept; when it is not, the map of the least distortion that was found is the result. Not the shortest
/// seams there are: a local search; a coarse mesh that has no place for the details of the fine one costs some per
/// cent. Cost: 20 to 300 maps, most often 100; with `coarse` so many of the coarse mesh, and 6 to 8 of the whole.
/// Deterministic when the tools are.
/// @throws InvalidInput for a bound out of range or costs that do not fit the mesh; what the tools throw.
BoundedSeams keep_bound(const TriangleMesh& mesh, const DistortionBound& bound, const SeamTools& tools,
                        Deadline deadline = {}, const ProgressCallback& progress = {});

}  // namespace papilla
