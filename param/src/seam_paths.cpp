// SPDX-License-Identifier: MIT
#include "seam_paths.hpp"

#include <utility>

namespace papilla::param_detail {
namespace {

/// Seam edges by their vertices.
class SeamGraph {
 public:
  SeamGraph(const SeamMesh& mesh, const std::vector<std::uint8_t>& seam)
      : mesh_(mesh), first_(mesh.on_border.size() + 1, 0) {
    const auto each = [&](auto visit) {
      for (Index h = 0; h < seam.size(); ++h)
        if (seam[h] && mesh.opposite[h] != k_no_triangle) visit(h);
    };
    each([&](Index h) { ++first_[mesh.from(h) + 1]; });
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    out_.resize(first_.back());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    each([&](Index h) { out_[next[mesh.from(h)]++] = h; });
    walked_.assign(seam.size(), 0);
  }

  /// Half-edges along seams from a vertex.
  std::span<const Index> out(Index v) const { return {out_.data() + first_[v], first_[v + 1] - first_[v]}; }
  bool is_node(Index v) const { return mesh_.on_border[v] || out(v).size() != 2; }
  bool is_tip(Index v) const { return !mesh_.on_border[v] && out(v).size() == 1; }
  bool walked(Index h) const { return walked_[h]; }

  SeamPath walk(Index h) {
    SeamPath path;
    path.tip_at_start = is_tip(mesh_.from(h));
    for (;;) {
      path.halfedges.push_back(h);
      walked_[h] = walked_[mesh_.opposite[h]] = 1;
      const Index v = mesh_.to(h);
      if (is_node(v)) break;
      const auto from = out(v);
      const Index next = from[0] == mesh_.opposite[h] ? from[1] : from[0];
      if (walked_[next]) break;
      h = next;
    }
    path.tip_at_end = is_tip(mesh_.to(path.halfedges.back()));
    return path;
  }

 private:
  const SeamMesh& mesh_;
  std::vector<Index> first_, out_;
  std::vector<char> walked_;
};

}  // namespace

std::vector<SeamPath> seam_paths(const SeamMesh& mesh, const std::vector<std::uint8_t>& seam) {
  SeamGraph graph(mesh, seam);
  std::vector<SeamPath> paths;
  const auto vertices = static_cast<Index>(mesh.on_border.size());
  for (const bool loops : {false, true})
    for (Index v = 0; v < vertices; ++v)
      if (loops || graph.is_node(v))
        for (const Index h : graph.out(v))
          if (!graph.walked(h)) paths.push_back(graph.walk(h));
  return paths;
}

}  // namespace papilla::param_detail
