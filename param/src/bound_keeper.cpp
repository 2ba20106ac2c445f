// SPDX-License-Identifier: MIT
#include "bound_keeper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "coarse_seams.hpp"
#include "exchange_seams.hpp"
#include "lengthen_seams.hpp"
#include "move_tips.hpp"
#include "papilla/core/progress.hpp"
#include "reconnect_seams.hpp"
#include "shift_seams.hpp"
#include "straighten_seams.hpp"

namespace papilla::param_detail {
namespace {

/// Seam costs are tried in steps of this factor, from a first guess for each unit of distortion on.
constexpr double k_step = 4, k_first = 0.6;
constexpr double k_least_cost = 1e-7, k_most_cost = 64;

/// So many lower costs in a row that leave this part of D - 4 or more: charts are no longer cut where D comes from.
constexpr int k_most_idle = 3;
constexpr double k_idle = 0.99;

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Closing and straightening go on while they bring the seams below this part of what they were.
constexpr double k_worthwhile = 0.98;

/// What is remembered of maps, in triangles of all of them: 8 bytes each; where uv are remembered, too, they count as
/// so many more.
constexpr std::size_t k_most_remembered = 20'000'000;
constexpr std::size_t k_whole = 6;

/// States of fewer seams whose D - 4 is at most this many times what it may be are brought within the bound, too.
constexpr double k_near = 2;

/// What came of a coarse mesh is good where it costs less than so many times what was lifted: it had a place for such
/// seams. Where there is no other coarse mesh, it has to be worse before the whole mesh is searched.
constexpr double k_dear = 1.3, k_too_dear = 1.5;

/// Seams for another bound are searched on where it leaves so much more of D - 4, or they are dearer by as much.
constexpr double k_much = 1.1;

/// As often charts are halved where no seam cost is low enough, and the part of its energy that a chart is thought to
/// lose by that.
constexpr int k_halvings = 6;
constexpr double k_halved = 0.5;

}  // namespace

BoundKeeper::BoundKeeper(const TriangleMesh& mesh, const DistortionBound& bound, const SeamTools& tools,
                         const Deadline& deadline, SeamTrace& trace)
    : mesh_(mesh, tools.seam_costs),
      bound_(bound),
      tools_(tools),
      extent_(tools.brief ? k_brief : k_thorough),
      deadline_(deadline),
      trace_(trace) {}

SeamState BoundKeeper::search(const Calibrate& calibrate) {
  std::optional<SeamState> best;
  double price = k_infinity;
  for (std::size_t attempt = 0; tools_.coarse && price > k_dear && !deadline_.passed(); ++attempt) {
    const CoarseSurface* surface = tools_.coarse(attempt);
    if (!surface) break;
    CoarseSeams found = seams_from_coarse(*this, bound_, *surface, deadline_, trace_);
    price = std::min(price, found.price);
    if (found.state && !(best && best->cost_mm <= found.state->cost_mm)) best = std::move(found.state);
  }
  if (!best || (price > k_too_dear && !deadline_.passed())) {
    SeamState found = search_mesh(calibrate);
    return best && keeps(*best) && !(keeps(found) && found.cost_mm <= best->cost_mm) ? std::move(*best) : found;
  }
  if (!calibrate) return std::move(*best);
  const DistortionBound bound = calibrate(*best);
  return moved(std::move(*best), bound);
}

/// Without coarse meshes.
SeamState BoundKeeper::search_mesh(const Calibrate& calibrate) {
  for (const bool feature_seams : {true, false}) {
    feature_seams_ = feature_seams;
    kept_.clear();
    search_cost();
    keep_cheapest();
  }
  if (starts_.empty())
    halve();
  else
    lengthen();
  return starts_.empty() ? std::move(*least_) : shortest(calibrate);
}

SeamState BoundKeeper::moved(SeamState state, const DistortionBound& bound) {
  move_bound(bound);
  const auto searched_on = [&](SeamState from) {
    return maps_ < extent_.most_maps ? exchanged(reconnected(std::move(from))) : std::move(from);
  };
  if (keeps(state)) {
    const bool has_room = bound_.most - 4 > k_much * (state.distortion - 4);
    state = shortened(std::move(state));
    return has_room ? searched_on(std::move(state)) : state;
  }
  std::optional<SeamState> known = cheapest_known();
  if (known) *known = shortened(std::move(*known));
  std::optional<SeamState> longer = lengthened(state);
  if (longer) *longer = shortened(std::move(*longer));
  if (!known || (longer && longer->cost_mm < known->cost_mm)) known = std::move(longer);
  if (!known) return state;
  return known->cost_mm > k_much * state.cost_mm ? searched_on(std::move(*known)) : std::move(*known);
}

std::optional<SeamState> BoundKeeper::finished(SeamState state) {
  std::optional<SeamState> kept = keeps(state) ? std::move(state) : lengthened(std::move(state));
  if (!kept) return {};
  std::vector<double> doubt(mesh_.opposite.size(), 1);
  return shorten_seams(mesh_, std::move(*kept), bound_, map_, doubt, deadline_, extent_.most_failures);
}

/// A map that was made.
void BoundKeeper::count(const SeamState& state) {
  ++maps_;
  trace_.add(mesh_, state);
}

/// Keeps the state where it is of use. @return whether the bound is kept.
bool BoundKeeper::consider(SeamState state) {
  count(state);
  remember({state.seam.begin(), state.seam.end()}, {state, true});
  const bool good = keeps(state);
  if (!least_ || state.distortion < least_->distortion) least_ = state;
  if (good)
    kept_.push_back(std::move(state));
  else if (state.valid && state.distortion - 4 <= k_near * (bound_.most - 4))
    near_.push_back(std::move(state));
  return good;
}

bool BoundKeeper::try_cost(double seam_cost) {
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
bool BoundKeeper::is_same_without_features() {
  if (tried_[true].empty()) return false;
  const auto& [cost, with] = *tried_[true].begin();
  try_cost(cost);
  const auto without = tried_[false].find(cost);
  return without != tried_[false].end() && without->second.seam == with.seam;
}

/// Brackets the cost at which seams become too few. The costs are the same for all bounds, so that what is found
/// for one serves others.
void BoundKeeper::search_cost() {
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
  for (int i = 0; i < extent_.generous && low / k_step >= k_least_cost && !deadline_.passed(); ++i)
    try_cost(low /= k_step);
}

bool BoundKeeper::leave_same_seams(double low, double high) {
  const Tries& tries = tried_[feature_seams_];
  const auto a = tries.find(low), b = tries.find(high);
  return a != tries.end() && b != tries.end() && a->second.seam == b->second.seam;
}

SeamState BoundKeeper::map(const ChartSet& charts, double most_excess_mm2, const CornerAttribute<Vec2>* nearby) {
  const bool is_known = nearby && !nearby->indices.empty();
  ChartedMap charted = tools_.map(charts, most_excess_mm2, is_known ? nearby : nullptr);
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
std::vector<std::uint32_t> BoundKeeper::worth_halving(const SeamState& state) const {
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
void BoundKeeper::halve() {
  SeamState state = *least_;
  for (int i = 0; i < k_halvings && !deadline_.passed(); ++i) {
    const std::vector<std::uint32_t> worst = worth_halving(state);
    if (worst.empty()) return;
    state = map(tools_.halve(state.charted.flattening.charts, worst), k_infinity, nullptr);
    if (consider(state)) return keep_cheapest();
  }
}

/// Brings states within the bound that have fewer seams than any that keeps it.
void BoundKeeper::lengthen() {
  double least = k_infinity;
  for (const SeamState& start : starts_) least = std::min(least, start.cost_mm);
  std::erase_if(near_, [&](const SeamState& state) { return !(state.cost_mm < least); });
  std::stable_sort(near_.begin(), near_.end(), [](const auto& a, const auto& b) { return a.cost_mm < b.cost_mm; });
  for (std::size_t i = 0; i < near_.size() && i < extent_.near_starts; ++i)
    if (auto state = lengthened(std::move(near_[i]))) starts_.push_back(std::move(*state));
  near_.clear();
}

/// Of the states that keep the bound.
void BoundKeeper::keep_cheapest() {
  std::stable_sort(kept_.begin(), kept_.end(),
                   [](const SeamState& a, const SeamState& b) { return a.cost_mm < b.cost_mm; });
  for (std::size_t i = 0, taken = 0; i < kept_.size() && taken < extent_.starts; ++i) {
    const auto same = [&](const SeamState& start) { return start.seam == kept_[i].seam; };
    if (std::any_of(starts_.begin(), starts_.end(), same)) continue;
    starts_.push_back(std::move(kept_[i]));
    ++taken;
  }
  kept_.clear();
}

SeamState BoundKeeper::map_seams(const std::vector<std::uint8_t>& seam, bool whole,
                                 const CornerAttribute<Vec2>* nearby) {
  std::vector<bool> key(seam.begin(), seam.end());
  if (const auto before = known_.find(key); before != known_.end() && (before->second.is_whole || !whole))
    return before->second.state;
  const double most = whole || bound_.percentile ? k_infinity : (bound_.most + k_bound_slack - 4) * mesh_.area;
  Known known{map(charts_between(mesh_, seam), most, nearby), most == k_infinity};
  count(known.state);
  SeamState state = known.state;
  if (!known.is_whole) {
    if (state.valid && keeps(state))
      known.is_whole = true;
    else
      known.state.charted = {}, known.state.seam = {};
  }
  remember(std::move(key), std::move(known));
  return state;
}

void BoundKeeper::remember(std::vector<bool> key, Known known) {
  if (const auto before = known_.find(key); before != known_.end()) remembered_ -= before->second.triangles();
  remembered_ += known.triangles();
  if (remembered_ > k_most_remembered) known_.clear(), remembered_ = known.triangles();
  known_.insert_or_assign(std::move(key), std::move(known));
}

std::size_t BoundKeeper::Known::triangles() const { return (is_whole ? k_whole : 1) * state.excess.size(); }

/// What was left unfinished may keep the new bound.
void BoundKeeper::move_bound(const DistortionBound& bound) {
  bound_ = bound;
  std::erase_if(known_, [](const auto& known) { return !known.second.is_whole; });
  remembered_ = 0;
  for (const auto& [seam, known] : known_) remembered_ += known.triangles();
}

/// Of what is remembered and keeps the bound.
std::optional<SeamState> BoundKeeper::cheapest_known() const {
  const SeamState* best = nullptr;
  for (const auto& [seam, known] : known_) {
    const SeamState& state = known.state;
    if (!known.is_whole || !state.valid || !keeps(state)) continue;
    const auto is_before = [&] {
      if (state.cost_mm != best->cost_mm) return state.cost_mm < best->cost_mm;
      return state.distortion != best->distortion ? state.distortion < best->distortion : state.seam < best->seam;
    };
    if (!best || is_before()) best = &state;
  }
  return best ? std::optional(*best) : std::nullopt;
}

std::optional<SeamState> BoundKeeper::lengthened(SeamState state) const {
  return lengthen_seams(mesh_, std::move(state), bound_, map_fully_, deadline_);
}

SeamState BoundKeeper::shortened(SeamState state) {
  std::vector<double> doubt(mesh_.opposite.size(), 1);
  for (double before = k_infinity; state.cost_mm < k_worthwhile * before;) {
    before = state.cost_mm;
    state = shorten_seams(mesh_, std::move(state), bound_, map_, doubt, deadline_);
    state = straighten_seams(mesh_, std::move(state), bound_, map_, deadline_);
  }
  return state;
}

SeamState BoundKeeper::reconnected(SeamState state) {
  return reconnect_seams(mesh_, std::move(state), bound_, map_, map_fully_, deadline_);
}

/// The starts with their seams shortened: the cheapest that comes of them.
SeamState BoundKeeper::shortest(const Calibrate& calibrate) {
  const auto sort_starts = [&] {
    std::stable_sort(starts_.begin(), starts_.end(),
                     [](const auto& a, const auto& b) { return a.cost_mm < b.cost_mm; });
  };
  if (calibrate) {
    sort_starts();
    starts_.front() = shortened(std::move(starts_.front()));
    move_bound(calibrate(starts_.front()));
    for (SeamState& state : starts_)
      if (!keeps(state))
        if (auto longer = lengthened(state)) state = std::move(*longer);
    const SeamState first = starts_.front();
    std::erase_if(starts_, [&](const SeamState& state) { return !keeps(state); });
    if (starts_.empty()) return first;
  }
  for (SeamState& state : starts_) state = shortened(std::move(state));
  sort_starts();
  return exchanged(reconnected(std::move(starts_.front())));
}

SeamState BoundKeeper::exchanged(SeamState state) {
  for (double before = k_infinity; state.cost_mm < before;) {
    state = exchange_seams(mesh_, std::move(state), bound_, map_, map_fully_, deadline_);
    before = state.cost_mm;
    state = reconnected(std::move(state));
    if (extent_.moves_tips) state = move_tips(mesh_, std::move(state), bound_, map_, map_fully_, deadline_);
    state = shift_seams(mesh_, std::move(state), bound_, map_, map_fully_, deadline_);
  }
  return straighten_seams(mesh_, std::move(state), bound_, map_, deadline_);
}

}  // namespace papilla::param_detail
