// SPDX-License-Identifier: MIT
#include "straighten_seams.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "cheapest_ways.hpp"
#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

/// A new way stays within this part of the old one's length from it.
constexpr double k_corridor = 0.25;

/// A new way that costs more than this part of the old one is not worth a map.
constexpr double k_worthwhile = 0.998;

/// A straight way costs this part of a zigzag beside it at least. One that costs less leaves out what the old one went
/// around: the tip of a finger.
constexpr double k_zigzag = 0.8;

/// As often half of the new ways is given up where all of them break the bound.
constexpr int k_attempts = 2;

struct NewWay {
  std::vector<Index> before, after;  ///< Half-edges.
  double saved = 0;
  double raised = 0;  ///< What the energy rose by around it when it was tried.
};

/// Cheapest ways over the edges of a mesh, within a distance of a path.
class WayFinder {
 public:
  explicit WayFinder(const SeamMesh& mesh) : mesh_(mesh), near_(mesh), ways_(mesh) {}

  /// The cheapest way between the ends of a path, over vertices that are not blocked and not far from it.
  /// @param blocked per vertex; those of the path itself are free. @return empty when there is none.
  std::vector<Index> between_ends(const std::vector<Index>& path, const std::vector<char>& blocked, double most_mm) {
    double length = 0;
    std::vector<Index> on_path;
    for (const Index h : path) length += mesh_.length(h), on_path.push_back(mesh_.from(h));
    const double corridor = std::min(most_mm, k_corridor * length);
    on_path.push_back(mesh_.to(path.back()));
    const Index start = on_path.front(), end = on_path.back();
    own_ = on_path;
    std::sort(own_.begin(), own_.end());
    const auto is_free = [&](Index v) { return !blocked[v] || std::binary_search(own_.begin(), own_.end(), v); };
    near_.search(
        on_path, [&](Index h) { return mesh_.length(h); },
        [&](Index v, double d) { return is_free(v) && d <= corridor; }, [](Index) { return false; });
    const Index reached = ways_.search(
        std::array{start}, [&](Index h) { return mesh_.cost[h]; },
        [&](Index v, double) { return near_.has_reached(v); }, [&](Index v) { return v == end; });
    return reached == end ? ways_.way_to(end) : std::vector<Index>{};
  }

 private:
  const SeamMesh& mesh_;
  CheapestWays near_, ways_;
  std::vector<Index> own_;
};

std::vector<NewWay> new_ways(const SeamMesh& mesh, const std::vector<std::uint8_t>& seam, double most_mm,
                             double least_part) {
  WayFinder finder(mesh);
  const std::vector<SeamPath> paths = seam_paths(mesh, seam);
  std::vector<char> blocked = mesh.on_border;
  for (const SeamPath& path : paths)
    for (const Index h : path.halfedges) blocked[mesh.from(h)] = blocked[mesh.to(h)] = 1;
  std::vector<NewWay> ways;
  for (const SeamPath& path : paths) {
    if (path.halfedges.size() < 2 || mesh.from(path.halfedges.front()) == mesh.to(path.halfedges.back())) continue;
    NewWay way{path.halfedges, finder.between_ends(path.halfedges, blocked, most_mm), 0, 0};
    double before = 0, after = 0;
    for (const Index h : way.before) before += mesh.cost[h];
    for (const Index h : way.after) after += mesh.cost[h];
    if (way.after.empty() || !(after < k_worthwhile * before) || after < least_part * before) continue;
    for (const Index h : way.after) blocked[mesh.from(h)] = blocked[mesh.to(h)] = 1;
    way.saved = before - after;
    ways.push_back(std::move(way));
  }
  return ways;
}

std::vector<std::uint8_t> with_ways(const SeamMesh& mesh, const std::vector<NewWay>& ways,
                                    std::vector<std::uint8_t> seam) {
  for (const NewWay& way : ways)
    for (const Index h : way.before) seam[h] = seam[mesh.opposite[h]] = 0;
  for (const NewWay& way : ways)
    for (const Index h : way.after) seam[h] = seam[mesh.opposite[h]] = 1;
  return seam;
}

}  // namespace

std::vector<std::uint8_t> straightened(const SeamMesh& mesh, std::vector<std::uint8_t> seam, double most_mm) {
  const std::vector<NewWay> ways = new_ways(mesh, seam, most_mm, k_zigzag);
  return with_ways(mesh, ways, std::move(seam));
}

SeamState straighten_seams(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                           const Deadline& deadline) {
  std::vector<NewWay> ways = new_ways(mesh, state.seam, std::numeric_limits<double>::infinity(), 0);
  for (int i = 0; i < k_attempts && !ways.empty() && !deadline.passed(); ++i) {
    SeamState next = map(with_ways(mesh, ways, state.seam), state);
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
