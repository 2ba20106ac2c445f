// SPDX-License-Identifier: MIT
#include "coarse_seams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lift_map.hpp"
#include "lift_seams.hpp"

namespace papilla::param_detail {
namespace {

/// What D - 4 of the coarse mesh is taken to be over that of the fine one before it is known, and what it may be: a
/// cylinder of few triangles is no developable surface, and a coarse bump has less detail.
constexpr double k_first_ratio = 1.3, k_least_ratio = 1.0 / 3, k_most_ratio = 1000;

/// As often the coarse bound is moved after the search, where D - 4 of the fine mesh is beyond these parts of what it
/// may be. Where it stays too large, each time by so much more.
constexpr int k_moves = 4;
constexpr double k_low = 0.93, k_high = 1.01, k_more = 0.05;

/// What seams are thought to cost when they are finished: they get shorter by so small a power of what is left of D -
/// 4, and longer by so much for what is missing. Of 301 that were finished, those at 0.97 of it came out at 0.98 of
/// their cost, those at 1.05 at 1.02, and those at 1.11 at 1.06.
constexpr double k_shorter = 0.25, k_longer = 0.5;

/// Beyond this part of what D - 4 may be seams are not brought within the bound. Where others are within it, those that
/// are thought to cost so much less are brought there, too, from further away: the coarse bound may have been moved too
/// far.
constexpr double k_most_part = 1.5, k_most_part_then = 2.5, k_hope = 1.05;

/// Of the time that there is.
constexpr double k_share_of_time = 0.5;

class CoarseSearch {
 public:
  CoarseSearch(BoundKeeper& fine, const DistortionBound& bound, const CoarseSurface& coarse, const Deadline& deadline,
               SeamTrace& trace)
      : fine_(fine),
        bound_(bound),
        deadline_(deadline),
        coarse_deadline_(deadline.never() ? deadline : Deadline(k_share_of_time * deadline.left())),
        coarse_(coarse.mesh, scaled(k_first_ratio), coarse.tools, coarse_deadline_, trace),
        vertices_(coarse.vertices),
        lifter_(fine.mesh(), coarse_.mesh(), coarse.vertices) {}

  CoarseSeams run() {
    SeamState found = coarse_.search(
        [&](const SeamState& state) { return scaled(lift(state) ? ratio_to_lifted(state) : k_first_ratio); });
    bool is_new = lift(found);
    for (int i = 0; i < k_moves && is_new && !deadline_.passed(); ++i) {
      const double part = part_of(lifted_.back());
      if (part < k_high && (part > k_low || i > 1)) break;
      const double aim = part < k_high ? 1 : 1 - k_more * i;
      SeamState next = coarse_.moved(found, scaled(aim * ratio_to_lifted(found)));
      is_new = next.seam != found.seam && lift(next);
      found = std::move(next);
    }
    return finished();
  }

 private:
  DistortionBound scaled(double ratio) const { return {4 + (bound_.most - 4) * ratio, bound_.percentile}; }

  double part_of(const SeamState& state) const { return (state.distortion - 4) / (bound_.most - 4); }

  /// D - 4 of a state over that of the last one that was lifted.
  double ratio_to_lifted(const SeamState& state) const {
    return std::clamp((state.distortion - 4) / (lifted_.back().distortion - 4), k_least_ratio, k_most_ratio);
  }

  /// @return whether it has a map on the fine mesh.
  bool lift(const SeamState& state) {
    const CornerAttribute<Vec2> nearby = lifter_.lift(state.charted.flattening.uv);
    SeamState fine = fine_.map_seams(lift_seams(fine_.mesh(), coarse_.mesh(), vertices_, state.seam), true, &nearby);
    if (!fine.valid) return false;
    lifted_.push_back(std::move(fine));
    return true;
  }

  double cost_when_finished(const SeamState& state) const {
    const double part = part_of(state);
    return state.cost_mm * (part > 1 ? 1 + k_longer * (part - 1) : std::pow(part, k_shorter));
  }

  /// What was lifted and is worth most, on the fine mesh; others too, where they may come out cheaper.
  CoarseSeams finished() {
    std::stable_sort(lifted_.begin(), lifted_.end(),
                     [&](const auto& a, const auto& b) { return cost_when_finished(a) < cost_when_finished(b); });
    double least = std::numeric_limits<double>::infinity();
    for (const SeamState& state : lifted_)
      if (part_of(state) <= k_most_part) least = std::min(least, state.cost_mm);
    std::optional<SeamState> best;
    for (const SeamState& state : lifted_) {
      if (best && (deadline_.passed() || !(k_hope * cost_when_finished(state) < best->cost_mm))) continue;
      if (part_of(state) > (best ? k_most_part_then : k_most_part)) continue;
      if (auto done = fine_.finished(state); done && !(best && best->cost_mm <= done->cost_mm)) best = std::move(done);
    }
    if (!best && deadline_.passed() && !lifted_.empty())
      best = *std::min_element(lifted_.begin(), lifted_.end(),
                               [](const auto& a, const auto& b) { return a.distortion < b.distortion; });
    double price = std::numeric_limits<double>::infinity();
    if (best) price = best->cost_mm > least ? best->cost_mm / least : 1;  // no seams at all are not dear
    return {std::move(best), price};
  }

  BoundKeeper& fine_;
  const DistortionBound& bound_;
  const Deadline& deadline_;
  Deadline coarse_deadline_;
  BoundKeeper coarse_;
  std::span<const Index> vertices_;
  MapLifter lifter_;
  std::vector<SeamState> lifted_;
};

}  // namespace

CoarseSeams seams_from_coarse(BoundKeeper& fine, const DistortionBound& bound, const CoarseSurface& coarse,
                              const Deadline& deadline, SeamTrace& trace) {
  return CoarseSearch(fine, bound, coarse, deadline, trace).run();
}

}  // namespace papilla::param_detail
