// SPDX-License-Identifier: MIT
#include "straighten_seams.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// A new way stays within this part of the old one's length from it.
constexpr double k_corridor = 0.25;

/// A new way that costs more than this part of the old one is not worth a map.
constexpr double k_worthwhile = 0.998;

/// As often half of the new ways is given up where all of them break the bound.
constexpr int k_attempts = 4;

struct NewWay {
  std::vector<Index> before, after;  ///< Half-edges.
  double saved = 0;
  double raised = 0;  ///< What the energy rose by around it when it was tried.
};

/// Shortest ways over the edges of a mesh, within a distance of a path.
class WayFinder {
 public:
  explicit WayFinder(const SeamMesh& mesh) : mesh_(mesh), first_(mesh.on_border.size() + 1, 0) {
    for (Index h = 0; h < mesh.opposite.size(); ++h)
      if (mesh.opposite[h] != k_no_triangle) ++first_[mesh.from(h) + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    out_.resize(first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (Index h = 0; h < mesh.opposite.size(); ++h)
      if (mesh.opposite[h] != k_no_triangle) out_[next[mesh.from(h)]++] = h;
    near_.assign(mesh.on_border.size(), k_infinity);
    distance_ = near_;
    way_.resize(near_.size());
  }

  /// The cheapest way between the ends of a path, over vertices that are not blocked and not far from it.
  /// @param blocked per vertex; those of the path itself are free. @return empty when there is none.
  std::vector<Index> between_ends(const std::vector<Index>& path, const std::vector<char>& blocked) {
    double length = 0;
    std::vector<Index> on_path;
    for (const Index h : path) length += mesh_.length(h), on_path.push_back(mesh_.from(h));
    on_path.push_back(mesh_.to(path.back()));
    const Index start = on_path.front(), end = on_path.back();
    own_ = on_path;
    std::sort(own_.begin(), own_.end());
    const auto free = [&](Index v) { return !blocked[v] || std::binary_search(own_.begin(), own_.end(), v); };
    search(
        on_path, near_, near_touched_, [&](Index h) { return mesh_.length(h); },
        [&](Index v, double d) { return free(v) && d <= k_corridor * length; }, k_no_triangle);
    search(
        {start}, distance_, distance_touched_, [&](Index h) { return mesh_.cost[h]; },
        [&](Index v, double) { return near_[v] < k_infinity; }, end);
    std::vector<Index> way;
    if (distance_[end] < k_infinity)
      for (Index v = end; v != start; v = mesh_.from(way_[v])) way.push_back(way_[v]);
    std::reverse(way.begin(), way.end());
    clear(near_, near_touched_);
    clear(distance_, distance_touched_);
    return way;
  }

 private:
  template <class Cost, class May>
  void search(const std::vector<Index>& from, std::vector<double>& distance, std::vector<Index>& touched, Cost cost,
              May may, Index until) {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index v : from)
      if (distance[v] > 0) distance[v] = 0, touched.push_back(v), queue.emplace(0, v);
    while (!queue.empty()) {
      const auto [there, v] = queue.top();
      queue.pop();
      if (there > distance[v]) continue;
      if (v == until) return;
      for (Index i = first_[v]; i < first_[v + 1]; ++i) {
        const Index h = out_[i], to = mesh_.to(h);
        const double next = there + cost(h);
        if (!(next < distance[to]) || !may(to, next)) continue;
        if (distance[to] == k_infinity) touched.push_back(to);
        distance[to] = next;
        way_[to] = h;
        queue.emplace(next, to);
      }
    }
  }

  static void clear(std::vector<double>& distance, std::vector<Index>& touched) {
    for (const Index v : touched) distance[v] = k_infinity;
    touched.clear();
  }

  const SeamMesh& mesh_;
  std::vector<Index> first_, out_, way_, own_, near_touched_, distance_touched_;
  std::vector<double> near_, distance_;
};

std::vector<NewWay> new_ways(const SeamMesh& mesh, const SeamState& state) {
  WayFinder finder(mesh);
  const std::vector<SeamPath> paths = seam_paths(mesh, state);
  std::vector<char> blocked = mesh.on_border;
  for (const SeamPath& path : paths)
    for (const Index h : path.halfedges) blocked[mesh.from(h)] = blocked[mesh.to(h)] = 1;
  std::vector<NewWay> ways;
  for (const SeamPath& path : paths) {
    if (path.halfedges.size() < 2 || mesh.from(path.halfedges.front()) == mesh.to(path.halfedges.back())) continue;
    NewWay way{path.halfedges, finder.between_ends(path.halfedges, blocked), 0, 0};
    double before = 0, after = 0;
    for (const Index h : way.before) before += mesh.cost[h];
    for (const Index h : way.after) after += mesh.cost[h];
    if (way.after.empty() || !(after < k_worthwhile * before)) continue;
    for (const Index h : way.after) blocked[mesh.from(h)] = blocked[mesh.to(h)] = 1;
    way.saved = before - after;
    ways.push_back(std::move(way));
  }
  return ways;
}

}  // namespace

SeamState straighten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                           const Deadline& deadline) {
  std::vector<NewWay> ways = new_ways(mesh, state);
  for (int i = 0; i < k_attempts && !ways.empty() && !deadline.passed(); ++i) {
    std::vector<std::uint8_t> seam = state.seam;
    for (const NewWay& way : ways)
      for (const Index h : way.before) seam[h] = seam[mesh.opposite[h]] = 0;
    for (const NewWay& way : ways)
      for (const Index h : way.after) seam[h] = seam[mesh.opposite[h]] = 1;
    SeamState next = map(seam);
    if (next.valid && next.distortion <= bound.most + k_bound_slack && next.cost_mm < state.cost_mm) return next;
    std::vector<std::vector<Index>> places;
    for (const NewWay& way : ways) {
      places.push_back(way.before);
      places.back().insert(places.back().end(), way.after.begin(), way.after.end());
    }
    const std::vector<double> raised = raised_around(mesh, state, next, places);
    for (std::size_t w = 0; w < ways.size(); ++w) ways[w].raised = raised[w];
    std::stable_sort(ways.begin(), ways.end(),
                     [](const NewWay& a, const NewWay& b) { return a.raised * b.saved < b.raised * a.saved; });
    ways.resize(ways.size() / 2);
  }
  return state;
}

}  // namespace papilla::param_detail
