// SPDX-License-Identifier: MIT
#include "lengthen_seams.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "outgoing_edges.hpp"
#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

constexpr int k_rounds = 5;

/// Edges behind a tip over which its opening is looked at.
constexpr std::size_t k_behind = 3;

/// More than the energy that is missing is released at once, as what is foreseen is rough; and a slit grows by this
/// part of its length at most.
constexpr double k_more = 1.1, k_most_growth = 0.5;

/// Energy that was foreseen, over that which was released: as far as that is believed.
constexpr double k_most_over = 8;

struct Tip {
  Index vertex = 0;
  Vec2 direction;      ///< In the map, of length 1.
  double release = 0;  ///< Energy per length.
  double most_mm = 0;  ///< That it may grow.
};

class Lengthener {
 public:
  explicit Lengthener(const SeamMesh& mesh) : mesh_(mesh), edges_(mesh) {}

  /// Adds to `seam` what is to release an energy. @return whether anything was added.
  bool extend(const SeamState& state, double energy, std::vector<std::uint8_t>& seam) const {
    const std::vector<SeamPath> paths = seam_paths(mesh_, state.seam);
    std::vector<char> blocked = mesh_.on_border;
    for (const SeamPath& path : paths)
      for (const Index h : path.halfedges) blocked[mesh_.from(h)] = blocked[mesh_.to(h)] = 1;
    bool is_longer = false;
    for (const Tip& tip : tips(paths, state)) {
      if (!(energy > 0)) break;
      const double wanted = std::min(energy / tip.release, tip.most_mm);
      Index v = tip.vertex;
      double length = 0;
      while (length < wanted) {
        const Index h = next_edge(v, tip.direction, state, blocked);
        if (h == k_none) break;
        seam[h] = seam[mesh_.opposite[h]] = 1;
        v = mesh_.to(h);
        blocked[v] = 1;
        length += mesh_.length(h);
        is_longer = true;
      }
      energy -= tip.release * length;
    }
    return is_longer;
  }

 private:
  static constexpr Index k_none = ~Index{0};

  /// Those of most release first.
  std::vector<Tip> tips(const std::vector<SeamPath>& paths, const SeamState& state) const {
    std::vector<Tip> tips;
    for (const SeamPath& path : paths)
      for (const bool at_end : {false, true})
        if (at_end ? path.tip_at_end : path.tip_at_start) tips.push_back(tip_of(path, at_end, state));
    std::erase_if(tips, [](const Tip& tip) { return !(tip.release > 0); });
    std::stable_sort(tips.begin(), tips.end(), [](const Tip& a, const Tip& b) { return a.release > b.release; });
    return tips;
  }

  Tip tip_of(const SeamPath& path, bool at_end, const SeamState& state) const {
    const std::size_t count = std::min(k_behind, path.halfedges.size());
    Tip tip;
    double behind = 0, whole = 0;
    for (const Index h : path.halfedges) whole += mesh_.length(h);
    for (std::size_t i = 0; i < count; ++i)
      behind += mesh_.length(path.halfedges[at_end ? path.halfedges.size() - 1 - i : i]);
    const Index last = at_end ? path.halfedges.back() : path.halfedges.front();
    const Index base = path.halfedges[at_end ? path.halfedges.size() - count : count - 1];
    tip.vertex = at_end ? mesh_.to(last) : mesh_.from(last);
    const Vec2 at = at_end ? state.uv_at_end(last) : state.uv(last);
    const Vec2 left = at_end ? state.uv(base) : state.uv_at_end(base);
    const Vec2 right = at_end ? state.uv_at_end(mesh_.opposite[base]) : state.uv(mesh_.opposite[base]);
    const Vec2 along = at - 0.5 * (left + right), gap = left - right;
    if (!(behind > 0) || !(norm(along) > 0)) return tip;
    tip.direction = (1 / norm(along)) * along;
    tip.release = 0.25 * std::numbers::pi * dot(gap, gap) / behind;
    tip.most_mm = k_most_growth * whole;
    return tip;
  }

  /// The edge from a vertex that runs most nearly in a direction of the map, not backwards. @return k_none: there is
  /// none that leaves seams and borders alone.
  Index next_edge(Index v, Vec2 direction, const SeamState& state, const std::vector<char>& blocked) const {
    Index best = k_none;
    double most = 0;
    for (const Index h : edges_.of(v)) {
      const Vec2 edge = state.uv_at_end(h) - state.uv(h);
      const double cosine = dot(edge, direction) / norm(edge);
      if (!state.seam[h] && cosine > most && !blocked[mesh_.to(h)]) most = cosine, best = h;
    }
    return best;
  }

  const SeamMesh& mesh_;
  OutgoingEdges edges_;
};

}  // namespace

std::optional<SeamState> lengthen_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound,
                                        const MapSeams& map, const Deadline& deadline) {
  const Lengthener lengthener(mesh);
  double over = 1;  // what was foreseen over what came of it
  for (int round = 0; round < k_rounds && !deadline.passed(); ++round) {
    const double missing = (1 - (bound.most - 4) / (state.distortion - 4)) * state.energy;
    std::vector<std::uint8_t> seam = state.seam;
    if (!lengthener.extend(state, over * k_more * missing, seam)) return {};
    SeamState next = map(seam, state);
    if (!next.valid || !(next.distortion < state.distortion)) return {};
    if (next.distortion <= bound.most + k_bound_slack) return next;
    over = std::clamp(over * k_more * missing / (state.energy - next.energy), 1.0, k_most_over);
    state = std::move(next);
  }
  return {};
}

}  // namespace papilla::param_detail
