// SPDX-License-Identifier: MIT
#include "move_tips.hpp"

#include <algorithm>
#include <utility>

#include "outgoing_edges.hpp"
#include "seam_exchange.hpp"
#include "seam_paths.hpp"

namespace papilla::param_detail {
namespace {

/// Edges of a slit that are taken away at most.
constexpr std::size_t k_last_edges = 2;

/// Part of what all seams cost that is worth a map: less would be tried at every tip of a fine mesh.
constexpr double k_least_saving = 0.01;

std::vector<SeamExchange> other_tips(const SeamMesh& mesh, const OutgoingEdges& edges, const SeamState& state) {
  const std::vector<SeamPath> paths = seam_paths(mesh, state.seam);
  std::vector<char> on_seam = mesh.on_border;
  for (const SeamPath& path : paths)
    for (const Index h : path.halfedges) on_seam[mesh.from(h)] = on_seam[mesh.to(h)] = 1;
  std::vector<SeamExchange> all;
  for (const SeamPath& path : paths)
    for (const bool at_end : {false, true}) {
      if (!(at_end ? path.tip_at_end : path.tip_at_start)) continue;
      std::vector<Index> last;
      double gone = 0;
      while (last.size() < std::min(k_last_edges, path.halfedges.size() - 1)) {
        const Index h = at_end ? path.halfedges[path.halfedges.size() - 1 - last.size()] : path.halfedges[last.size()];
        last.push_back(h);
        gone += mesh.cost[h];
        for (const Index e : edges.of(at_end ? mesh.from(h) : mesh.to(h)))
          if (!on_seam[mesh.to(e)] && gone > mesh.cost[e]) all.push_back({last, {e}, gone - mesh.cost[e]});
      }
    }
  return all;
}

}  // namespace

SeamState move_tips(const SeamMesh& mesh, SeamState state, const DistortionBound& bound, const MapSeams& map,
                    const MapSeams& map_fully, const Deadline& deadline) {
  const OutgoingEdges edges(mesh);
  return take_exchanges(mesh, std::move(state), bound, map, map_fully, deadline, k_least_saving,
                        [&](const SeamState& of) { return other_tips(mesh, edges, of); });
}

}  // namespace papilla::param_detail
