// SPDX-License-Identifier: MIT
#include "papilla/param/bounded_seams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "exchange_seams.hpp"
#include "lengthen_seams.hpp"
#include "move_tips.hpp"
#include "papilla/core/error.hpp"
#include "reconnect_seams.hpp"
#include "seam_state.hpp"
#include "shorten_seams.hpp"
#include "straighten_seams.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// Seam costs are tried in steps of this factor, from a first guess for each unit of distortion on.
constexpr double k_step = 4, k_first = 0.6;
constexpr double k_least_cost = 1e-7, k_most_cost = 64;

/// So many lower costs in a row that leave this part of D - 4 or more: charts are no longer cut where D comes from.
constexpr int k_most_idle = 3;
constexpr double k_idle = 0.99;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Closing and straightening go on while they bring the seams below this part of what they were.
constexpr double k_worthwhile = 0.98;

/// Costs below the last one that keeps the bound that are tried, too.
constexpr int k_generous = 1;

/// States whose seams are shortened, of those with and without seams along features.
constexpr std::size_t k_starts = 3;

/// What is remembered of maps, in triangles of all of them: 8 bytes each; where uv are remembered, too, they count as
/// so many more.
constexpr std::size_t k_most_remembered = 20'000'000;
constexpr std::size_t k_whole = 6;

/// Of the starts, so many are reconnected that are at most this much dearer than the cheapest when shortened.
constexpr std::size_t k_most_reconnected = 3;
constexpr double k_promising = 1.15;

/// States of fewer seams whose D - 4 is at most this many times what it may be are brought within the bound, too: the
/// cheapest of them.
constexpr double k_near = 2;
constexpr std::size_t k_near_starts = 2;

/// As often charts are halved where no seam cost is low enough, and the part of its energy that a chart is thought to
/// lose by that.
constexpr int k_halvings = 6;
constexpr double k_halved = 0.5;

void check(const DistortionBound& bound) {
  const auto refuse = [](const std::string& what) { throw InvalidInput("keep_bound: " + what); };
  if (!(bound.most >= 4 && std::isfinite(bound.most)))
    refuse("the bound is " + std::to_string(bound.most) + ", it must be at least 4");
  if (bound.percentile && !(*bound.percentile > 0 && *bound.percentile <= 100))
    refuse("percentile " + std::to_string(*bound.percentile) + " does not lie in (0, 100]");
}

class BoundKeeper {
 public:
  BoundKeeper(const TriangleMesh& mesh, const DistortionBound& bound, const SeamTools& tools, Deadline deadline,
              const ProgressCallback& progress)
      : mesh_(mesh, tools.seam_costs), bound_(bound), tools_(tools), deadline_(deadline), progress_(progress) {}

  BoundedSeams run() {
    for (const bool feature_seams : {true, false}) {
      feature_seams_ = feature_seams;
      kept_.clear();
      search();
      keep_cheapest();
    }
    if (starts_.empty())
      halve();
    else
      lengthen();
    SeamState best = starts_.empty() ? std::move(*least_) : shortest();
    result_.kept = keeps(best);
    result_.distortion = best.distortion;
    result_.seam_mm = best.seam_mm;
    result_.seam_cost_mm = best.cost_mm;
    if (deadline_.passed()) result_.stop = StopReason::time_limit;
    result_.charted = std::move(best.charted);
    return std::move(result_);
  }

 private:
  bool keeps(const SeamState& state) const { return state.distortion <= bound_.most + k_bound_slack; }

  void record(const SeamState& state) {
    result_.trace.push_back({clock_.seconds(), state.seam_mm, state.cost_mm, state.distortion});
    constexpr double k_usual_maps = 24;
    report_progress(progress_, "seams", std::min(1.0, static_cast<double>(result_.trace.size()) / k_usual_maps));
  }

  /// Keeps the state where it is of use. @return whether the bound is kept.
  bool consider(SeamState state) {
    record(state);
    const bool good = keeps(state);
    if (!least_ || state.distortion < least_->distortion) least_ = state;
    if (good)
      kept_.push_back(std::move(state));
    else if (state.valid && state.distortion - 4 <= k_near * (bound_.most - 4))
      near_.push_back(std::move(state));
    return good;
  }

  bool try_cost(double seam_cost) {
    Tries& tries = tried_[feature_seams_];
    if (const auto before = tries.find(seam_cost); before != tries.end()) return before->second.keeps_bound;
    try {
      SeamState state = measured(mesh_, tools_.chart(seam_cost, feature_seams_), bound_);
      last_cost_mm_ = state.cost_mm, last_distortion_ = state.distortion;
      Try& tried = tries[seam_cost];
      tried.seam = state.seam;
      return tried.keeps_bound = consider(std::move(state));
    } catch (const Cancelled&) {  // its time was up
      if (!least_ || !deadline_.passed()) throw;
      return false;
    }
  }

  /// Whether seams along features play no part, by the lowest cost that was tried with them.
  bool is_same_without_features() {
    if (tried_[true].empty()) return false;
    const auto& [cost, with] = *tried_[true].begin();
    try_cost(cost);
    const auto without = tried_[false].find(cost);
    return without != tried_[false].end() && without->second.seam == with.seam;
  }

  /// Brackets the cost at which seams become too few. The costs are the same for all bounds, so that what is found
  /// for one serves others.
  void search() {
    if (!feature_seams_ && is_same_without_features()) return;
    const double guess = std::clamp(k_first * (bound_.most - 4), k_step * k_step * k_least_cost, k_most_cost);
    double low = std::pow(k_step, std::round(std::log(guess) / std::log(k_step))), high = low;
    if (try_cost(low)) {
      for (;;) {
        const double before = last_cost_mm_;
        high *= k_step;
        if (high > k_most_cost || deadline_.passed() || !try_cost(high)) break;
        if (!(last_cost_mm_ < before)) break;  // there are no fewer seams
        low = high;
      }
    } else {
      int idle = 0;
      do {
        if (low / k_step < k_least_cost || idle == k_most_idle || deadline_.passed()) return;
        high = low;
        low /= k_step;
        const double before = last_distortion_;
        if (try_cost(low)) break;
        idle = last_distortion_ - 4 < k_idle * (before - 4) ? 0 : idle + 1;
      } while (true);
    }
    if (!deadline_.passed() && !leave_same_seams(low, high)) try_cost(std::sqrt(low * high));
    // Of too many seams, others can be closed than are missing where there are fewer.
    for (int i = 0; i < k_generous && low / k_step >= k_least_cost && !deadline_.passed(); ++i) try_cost(low /= k_step);
  }

  bool leave_same_seams(double low, double high) {
    const Tries& tries = tried_[feature_seams_];
    const auto a = tries.find(low), b = tries.find(high);
    return a != tries.end() && b != tries.end() && a->second.seam == b->second.seam;
  }

  SeamState map(const ChartSet& charts, double most_excess_mm2 = k_infinity) {
    ChartedMap charted = tools_.map(charts, most_excess_mm2);
    std::vector<std::uint8_t> without_map;
    if (!charted.flattening.notes.empty()) {
      std::vector<std::uint8_t> fails(charts.count, 0);
      for (const ChartNote& note : charted.flattening.notes) fails[note.chart] = 1;
      for (const std::uint32_t c : charts.of_triangle) without_map.push_back(fails[c]);
    }
    SeamState state = measured(mesh_, std::move(charted), bound_);
    state.without_map = std::move(without_map);
    return state;
  }

  /// Of charts beyond the bound, those of most energy: as many as will bring the mean down to it.
  std::vector<std::uint32_t> worth_halving(const SeamState& state) const {
    const ChartSet& charts = state.charted.flattening.charts;
    std::vector<double> area(charts.count, 0), excess(charts.count, 0);
    for (std::size_t t = 0; t < charts.of_triangle.size(); ++t) {
      area[charts.of_triangle[t]] += mesh_.rest[t].area;
      excess[charts.of_triangle[t]] += state.excess[t];
    }
    const double most = bound_.most - 4 + k_bound_slack;
    std::vector<std::uint32_t> worst;
    for (std::uint32_t c = 0; c < charts.count; ++c)
      if (!(excess[c] <= most * area[c])) worst.push_back(c);
    std::stable_sort(worst.begin(), worst.end(), [&](auto a, auto b) { return excess[a] > excess[b]; });
    if (bound_.percentile) return worst;
    double left = state.energy - most * mesh_.area;
    std::size_t count = 0;
    while (count < worst.size() && left > 0) left -= k_halved * excess[worst[count++]];
    worst.resize(count);
    return worst;
  }

  /// Cuts charts until the bound is kept.
  void halve() {
    SeamState state = *least_;
    for (int i = 0; i < k_halvings && !deadline_.passed(); ++i) {
      const std::vector<std::uint32_t> worst = worth_halving(state);
      if (worst.empty()) return;
      state = map(tools_.halve(state.charted.flattening.charts, worst));
      if (consider(state)) return keep_cheapest();
    }
  }

  /// Brings states within the bound that have fewer seams than any that keeps it.
  void lengthen() {
    double least = k_infinity;
    for (const SeamState& start : starts_) least = std::min(least, start.cost_mm);
    std::erase_if(near_, [&](const SeamState& state) { return !(state.cost_mm < least); });
    std::stable_sort(near_.begin(), near_.end(), [](const auto& a, const auto& b) { return a.cost_mm < b.cost_mm; });
    for (std::size_t i = 0; i < near_.size() && i < k_near_starts; ++i)
      if (auto state = lengthen_seams(mesh_, std::move(near_[i]), bound_, map_fully_, deadline_))
        starts_.push_back(std::move(*state));
    near_.clear();
  }

  /// Of the states that keep the bound.
  void keep_cheapest() {
    std::stable_sort(kept_.begin(), kept_.end(),
                     [](const SeamState& a, const SeamState& b) { return a.cost_mm < b.cost_mm; });
    for (std::size_t i = 0, taken = 0; i < kept_.size() && taken < k_starts; ++i) {
      const auto same = [&](const SeamState& start) { return start.seam == kept_[i].seam; };
      if (std::any_of(starts_.begin(), starts_.end(), same)) continue;
      starts_.push_back(std::move(kept_[i]));
      ++taken;
    }
    kept_.clear();
  }

  /// A map of seams, made once as long as it is remembered, and again where it was left unfinished and is wanted whole.
  /// @param whole also where it is of no use as it breaks the
  /// bound.
  SeamState map_seams(const std::vector<std::uint8_t>& seam, bool whole) {
    std::vector<bool> key(seam.begin(), seam.end());
    if (const auto before = known_.find(key); before != known_.end() && (before->second.is_whole || !whole))
      return before->second.state;
    const double most = whole || bound_.percentile ? k_infinity : (bound_.most + k_bound_slack - 4) * mesh_.area;
    Known known{map(charts_between(mesh_, seam), most), most == k_infinity};
    record(known.state);
    SeamState state = known.state;
    if (!known.is_whole) {
      if (state.valid && keeps(state))
        known.is_whole = true;
      else
        known.state.charted = {}, known.state.seam = {};
    }
    if (const auto before = known_.find(key); before != known_.end()) remembered_ -= before->second.triangles();
    remembered_ += known.triangles();
    if (remembered_ > k_most_remembered) known_.clear(), remembered_ = known.triangles();
    known_.insert_or_assign(std::move(key), std::move(known));
    return state;
  }

  SeamState reconnected(SeamState state) {
    return reconnect_seams(mesh_, std::move(state), bound_, map_, map_fully_, deadline_);
  }

  /// The starts with their seams shortened: the cheapest that comes of them.
  SeamState shortest() {
    for (SeamState& state : starts_) {
      std::vector<double> doubt(mesh_.opposite.size(), 1);
      for (double before = k_infinity; state.cost_mm < k_worthwhile * before;) {
        before = state.cost_mm;
        state = shorten_seams(mesh_, std::move(state), bound_, map_, doubt, deadline_);
        state = straighten_seams(mesh_, std::move(state), bound_, map_, deadline_);
      }
    }
    std::stable_sort(starts_.begin(), starts_.end(),
                     [](const auto& a, const auto& b) { return a.cost_mm < b.cost_mm; });
    const double most = k_promising * starts_.front().cost_mm;
    std::optional<SeamState> best;
    for (std::size_t i = 0; i < std::min(k_most_reconnected, starts_.size()); ++i) {
      if (starts_[i].cost_mm > most) break;
      SeamState state = reconnected(std::move(starts_[i]));
      if (!best || state.cost_mm < best->cost_mm) best = std::move(state);
    }
    for (double before = k_infinity; best->cost_mm < before;) {
      *best = exchange_seams(mesh_, std::move(*best), bound_, map_, map_fully_, deadline_);
      before = best->cost_mm;
      *best = reconnected(std::move(*best));
      *best = move_tips(mesh_, std::move(*best), bound_, map_, map_fully_, deadline_);
    }
    return straighten_seams(mesh_, std::move(*best), bound_, map_, deadline_);
  }

  SeamMesh mesh_;
  const DistortionBound& bound_;
  const SeamTools& tools_;
  Deadline deadline_;
  const ProgressCallback& progress_;
  Stopwatch clock_;
  bool feature_seams_ = true;
  std::vector<SeamState> kept_, starts_, near_;
  std::optional<SeamState> least_;  ///< Of the least distortion.
  double last_cost_mm_ = 0, last_distortion_ = 0;
  struct Try {
    bool keeps_bound = false;
    std::vector<std::uint8_t> seam;
  };
  using Tries = std::map<double, Try>;  ///< By seam cost.
  std::map<bool, Tries> tried_;         ///< Without seams along features, and with.
  struct Known {
    SeamState state;        ///< Without uv and seams where it is not whole.
    bool is_whole = false;  ///< Not left unfinished.
    std::size_t triangles() const { return (is_whole ? k_whole : 1) * state.excess.size(); }
  };
  std::unordered_map<std::vector<bool>, Known> known_;  ///< By their seams.
  std::size_t remembered_ = 0;                          ///< Triangles of known_.
  const MapSeams map_ = [this](const std::vector<std::uint8_t>& seam) { return map_seams(seam, false); };
  const MapSeams map_fully_ = [this](const std::vector<std::uint8_t>& seam) { return map_seams(seam, true); };
  BoundedSeams result_;
};

}  // namespace

BoundedSeams keep_bound(const TriangleMesh& mesh, const DistortionBound& bound, const SeamTools& tools,
                        Deadline deadline, const ProgressCallback& progress) {
  check(bound);
  return BoundKeeper(mesh, bound, tools, deadline, progress).run();
}

}  // namespace papilla
