// SPDX-License-Identifier: MIT
#include "lengthen_seams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "slit_fronts.hpp"

namespace papilla::param_detail {
namespace {

constexpr int k_rounds = 6;

/// More than the energy that is missing is to be released, as what is foreseen is rough; and in one round seams become
/// dearer by this many times what seams usually do for as much: with the fourth root of D - 4.
constexpr double k_more = 1.1, k_most_growth = 2, k_usual_growth = 0.25;

/// How far what came of a round moves what is foreseen of a place, and of places that were not tried.
constexpr double k_least_surprise = 0.1, k_most_surprise = 2, k_least_surprise_of_others = 0.125;

/// A slit that runs on, or a new one.
struct Extension {
  bool is_new = false;
  std::vector<Index> way;
  double foreseen = 0;  ///< Energy that it is thought to release.
};

/// What places release over what is foreseen, as far as it was learnt.
class Trust {
 public:
  double of(Index vertex, bool is_new) const {
    const auto known = of_vertex_.find(vertex);
    return known == of_vertex_.end() ? of_others_[is_new] : known->second;
  }

  /// @param released by each extension.
  void learn(const SeamMesh& mesh, const std::vector<Extension>& tried, const std::vector<double>& released) {
    std::array<double, 2> foreseen{}, came{};
    for (std::size_t i = 0; i < tried.size(); ++i) {
      const Extension& e = tried[i];
      const Index start = mesh.from(e.way.front()), end = mesh.to(e.way.back());
      const double surprise = std::clamp(released[i] / e.foreseen, k_least_surprise, k_most_surprise);
      const double trust = of(start, e.is_new) * surprise;
      of_vertex_[start] = trust;
      if (!e.is_new) of_vertex_[end] = trust;
      foreseen[e.is_new] += e.foreseen, came[e.is_new] += released[i];
    }
    for (const bool is_new : {false, true})
      if (foreseen[is_new] > 0)
        of_others_[is_new] *= std::clamp(came[is_new] / foreseen[is_new], k_least_surprise_of_others, 1.0);
  }

 private:
  std::unordered_map<Index, double> of_vertex_;  ///< By where a way begins.
  std::array<double, 2> of_others_{1, 1};        ///< Of tips, of new slits.
};

class Lengthener {
 public:
  explicit Lengthener(const SeamMesh& mesh) : mesh_(mesh), edges_(mesh) {}

  /// What is to release an energy at a cost of at most so much, but for the last edge.
  std::vector<Extension> extensions(const SeamState& state, const Trust& trust, double energy, double most_cost) const {
    std::vector<SlitFront> fronts = slit_fronts(mesh_, edges_, state);
    for (SlitFront& front : fronts)
      for (double& released : front.released) released *= trust.of(front.start(mesh_), front.is_new);
    std::vector<std::pair<double, const SlitFront*>> order;  // by energy per cost
    for (const SlitFront& front : fronts) order.emplace_back(front.released.back() / cost_of(front.way), &front);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<char> is_taken(mesh_.on_border.size(), 0);
    std::vector<Extension> all;
    for (const auto& [worth, front] : order) {
      if (!(energy > 0 && most_cost > 0)) break;
      Extension e{front->is_new, {}, 0};
      double cost = 0;
      for (std::size_t i = 0; i < front->way.size() && e.foreseen < energy && cost < most_cost; ++i) {
        const Index h = front->way[i];
        if (is_taken[mesh_.to(h)]) break;
        is_taken[mesh_.to(h)] = 1;
        e.way.push_back(h);
        e.foreseen = front->released[i];
        cost += mesh_.cost[h];
      }
      energy -= e.foreseen, most_cost -= cost;
      if (e.foreseen > 0) all.push_back(std::move(e));
    }
    return all;
  }

  std::vector<std::uint8_t> with(const std::vector<Extension>& extensions, std::vector<std::uint8_t> seam) const {
    for (const Extension& e : extensions)
      for (const Index h : e.way) seam[h] = seam[mesh_.opposite[h]] = 1;
    return seam;
  }

 private:
  double cost_of(const std::vector<Index>& way) const {
    double cost = 0;
    for (const Index h : way) cost += mesh_.cost[h];
    return cost;
  }

  const SeamMesh& mesh_;
  OutgoingEdges edges_;
};

/// What each extension released, from one state to another.
std::vector<double> released_by(const SeamMesh& mesh, const std::vector<Extension>& extensions, const SeamState& before,
                                const SeamState& after) {
  std::vector<std::vector<Index>> places;
  for (const Extension& e : extensions) places.push_back(e.way);
  std::vector<double> released = raised_around(mesh, before, after, places);
  for (double& energy : released) energy = -energy;
  return released;
}

}  // namespace

std::optional<SeamState> lengthen_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound,
                                        const MapSeams& map, const Deadline& deadline) {
  const Lengthener lengthener(mesh);
  Trust trust;
  for (int round = 0; round < k_rounds && !deadline.passed(); ++round) {
    const double over = (state.distortion - 4) / (bound.most - 4);
    const double missing = (1 - 1 / over) * state.energy;
    const double growth = k_most_growth * (std::pow(over, k_usual_growth) - 1);
    const double most_cost = state.cost_mm > 0 ? growth * state.cost_mm : std::numeric_limits<double>::infinity();
    const std::vector<Extension> tried = lengthener.extensions(state, trust, k_more * missing, most_cost);
    if (tried.empty()) return {};
    SeamState next = map(lengthener.with(tried, state.seam), state);
    if (!next.valid) return {};
    if (next.distortion <= bound.most + k_bound_slack) return next;
    trust.learn(mesh, tried, released_by(mesh, tried, state, next));
    if (next.distortion < state.distortion) state = std::move(next);
  }
  return {};
}

}  // namespace papilla::param_detail
