// SPDX-License-Identifier: MIT
#include "piece_cuts.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>

#include "chart_field.hpp"
#include "papilla/core/union_find.hpp"
#include "papilla/core/units.hpp"

namespace papilla::detail {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_hole_turning_deg = 20;
/// Roots that are tried on a closed surface, each farthest from those before.
constexpr int k_roots = 4;

struct MeshTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

std::size_t at(VertexHandle v) { return static_cast<std::size_t>(v.idx()); }
std::size_t at(EdgeHandle e) { return static_cast<std::size_t>(e.idx()); }

class Opener {
 public:
  Opener(const Piece& piece, const SeamWeights& weights) : piece_(piece), weights_(weights) {}

  bool build() {
    for (const Vec3& p : piece_.positions) mesh_.add_vertex({p.x, p.y, p.z});
    for (const Triangle& c : piece_.triangles)
      if (!mesh_
               .add_face(VertexHandle(static_cast<int>(c[0])), VertexHandle(static_cast<int>(c[1])),
                         VertexHandle(static_cast<int>(c[2])))
               .is_valid())
        return false;
    number_.assign(mesh_.n_edges(), k_none);
    cost_.assign(mesh_.n_edges(), 0);
    for (const FaceHandle f : mesh_.faces())
      for (const HalfedgeHandle h : mesh_.fh_range(f)) {
        const auto t = static_cast<Index>(f.idx());
        const auto from = static_cast<Index>(mesh_.from_vertex_handle(h).idx());
        const Index local = 3 * t + (piece_.triangles[t][0] == from ? 0u : piece_.triangles[t][1] == from ? 1u : 2u);
        const std::size_t e = at(mesh_.edge_handle(h));
        number_[e] = local;
        cost_[e] = weights_.cost(piece_.halfedge_of(local));
      }
    return true;
  }

  /// @param loops the border; those with `kept` stay holes.
  std::vector<Index> run(const std::vector<std::vector<Index>>& loops, const std::vector<std::uint8_t>& kept) {
    hole_.assign(mesh_.n_edges(), k_none);
    std::vector<VertexHandle> roots;
    for (Index l = 0; l < loops.size(); ++l)
      for (const Index h : loops[l]) {
        const VertexHandle v(static_cast<int>(piece_.from(h)));
        if (kept[l])
          hole_[at(mesh_.edge_handle(mesh_.find_halfedge(v, VertexHandle(static_cast<int>(piece_.to(h))))))] = l;
        else
          roots.push_back(v);
      }
    holes_ = loops.size();
    if (!roots.empty()) {
      find_paths(roots);
      return system_of_loops();
    }
    return open_closed();
  }

 private:
  /// Shortest paths from the roots (Dijkstra).
  void find_paths(const std::vector<VertexHandle>& roots) {
    distance_.assign(mesh_.n_vertices(), k_infinity);
    way_.assign(mesh_.n_vertices(), EdgeHandle());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const VertexHandle v : roots) {
      distance_[at(v)] = 0;
      queue.emplace(0, v.idx());
    }
    while (!queue.empty()) {
      const auto [distance, index] = queue.top();
      queue.pop();
      const VertexHandle v(index);
      if (distance > distance_[at(v)]) continue;
      for (const HalfedgeHandle h : mesh_.voh_range(v)) {
        const VertexHandle to = mesh_.to_vertex_handle(h);
        const EdgeHandle e = mesh_.edge_handle(h);
        const double there = distance + cost_[at(e)];
        if (!(there < distance_[at(to)])) continue;
        distance_[at(to)] = there;
        way_[at(to)] = e;
        queue.emplace(there, to.idx());
      }
    }
  }

  std::pair<VertexHandle, VertexHandle> ends(EdgeHandle e) const {
    const HalfedgeHandle h = mesh_.halfedge_handle(e, 0);
    return {mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h)};
  }

  /// Of the piece: two borders between the same vertices are one edge to OpenMesh, and no border.
  bool is_border(EdgeHandle e) const { return piece_.opposite[number_[at(e)]] == k_none; }

  double loop_length(EdgeHandle e) const {
    const auto [a, b] = ends(e);
    return distance_[at(a)] + cost_[at(e)] + distance_[at(b)];
  }

  /// Tree of shortest paths, maximal tree of the dual edges that cross none of them; each edge that is left closes a
  /// loop through the roots.
  std::vector<Index> system_of_loops() const {
    std::vector<std::uint8_t> in_tree(mesh_.n_edges(), 0);
    for (const EdgeHandle e : way_)
      if (e.is_valid()) in_tree[at(e)] = 1;
    std::vector<EdgeHandle> rest;
    for (const EdgeHandle e : mesh_.edges())
      if (!in_tree[at(e)] && (!is_border(e) || hole_[at(e)] != k_none)) rest.push_back(e);
    std::stable_sort(rest.begin(), rest.end(),
                     [&](EdgeHandle a, EdgeHandle b) { return loop_length(a) > loop_length(b); });
    UnionFind dual(mesh_.n_faces() + holes_);
    std::vector<std::uint8_t> cut(mesh_.n_edges(), 0);
    const auto face = [&](EdgeHandle e, unsigned side) {
      const FaceHandle f = mesh_.face_handle(mesh_.halfedge_handle(e, side));
      return f.is_valid() ? static_cast<Index>(f.idx()) : static_cast<Index>(mesh_.n_faces()) + hole_[at(e)];
    };
    for (const EdgeHandle e : rest) {
      const Index a = face(e, 0), b = face(e, 1);
      if (dual.find(a) != dual.find(b)) {
        dual.unite(a, b);
        continue;
      }
      cut[at(e)] = 1;
      const auto [v, w] = ends(e);
      for (const VertexHandle end : {v, w}) mark_way(end, cut);
    }
    return collect(cut);
  }

  void mark_way(VertexHandle v, std::vector<std::uint8_t>& cut) const {
    while (way_[at(v)].is_valid()) {
      const EdgeHandle e = way_[at(v)];
      cut[at(e)] = 1;
      const auto [a, b] = ends(e);
      v = a == v ? b : a;
    }
  }

  std::vector<Index> collect(const std::vector<std::uint8_t>& cut) const {
    std::vector<Index> cuts;
    for (const EdgeHandle e : mesh_.edges())
      if (cut[at(e)] && !is_border(e)) cuts.push_back(number_[at(e)]);
    return cuts;
  }

  std::vector<Index> open_closed() {
    std::vector<VertexHandle> roots{VertexHandle(0)};
    std::vector<Index> best;
    double best_cost = k_infinity;
    for (int i = 0; i < k_roots; ++i) {
      find_paths({farthest(roots)});
      std::vector<Index> cuts = system_of_loops();
      if (cuts.empty()) return slit_between_far_points();
      double cost = 0;
      for (const Index h : cuts) cost += weights_.cost(piece_.halfedge_of(h));
      if (cost < best_cost) best_cost = cost, best = std::move(cuts);
      roots.push_back(VertexHandle(root_));
    }
    return best;
  }

  VertexHandle farthest(const std::vector<VertexHandle>& from) {
    find_paths(from);
    root_ = static_cast<int>(std::max_element(distance_.begin(), distance_.end()) - distance_.begin());
    return VertexHandle(root_);
  }

  std::vector<Index> slit_between_far_points() {
    const VertexHandle a = farthest({VertexHandle(0)}), b = farthest({a});
    std::vector<std::uint8_t> cut(mesh_.n_edges(), 0);
    mark_way(b, cut);
    std::vector<Index> cuts = collect(cut);
    if (cuts.size() > 1) return cuts;
    // One edge opens nothing: a second one from either end.
    for (const EdgeHandle e : mesh_.ve_range(b))
      if (!cut[at(e)]) {
        cut[at(e)] = 1;
        break;
      }
    return collect(cut);
  }

  const Piece& piece_;
  const SeamWeights& weights_;
  HalfedgeMesh mesh_;
  std::vector<Index> number_;  ///< Per edge: a half-edge of the piece.
  std::vector<double> cost_, distance_;
  std::vector<EdgeHandle> way_;  ///< Per vertex: the first edge of its path.
  std::vector<Index> hole_;      ///< Per edge: the hole it borders.
  std::size_t holes_ = 0;
  int root_ = 0;
};

std::int64_t euler(const Piece& piece) {
  std::size_t twice_edges = 0;
  for (const Index other : piece.opposite) twice_edges += other == k_none ? 2 : 1;
  return static_cast<std::int64_t>(piece.vertex_count()) - static_cast<std::int64_t>(twice_edges / 2) +
         static_cast<std::int64_t>(piece.size());
}

}  // namespace

Opening open_chart(const Piece& piece, const SeamWeights& weights, bool all_loops) {
  const auto loops = border_loops(piece);
  const bool has_handles = euler(piece) + static_cast<std::int64_t>(loops.size()) != 2;
  std::vector<std::uint8_t> kept(loops.size(), 0);
  std::size_t joined = loops.size();
  if (!all_loops && loops.size() > 1) {
    const std::vector<double> defect = angle_defects(piece);
    for (std::size_t l = 1; l < loops.size(); ++l) {
      double turning = 2 * std::numbers::pi;
      for (const Index h : loops[l]) turning += defect[piece.from(h)];
      kept[l] = std::abs(turning) < k_hole_turning_deg * k_radians_per_degree;
      joined -= kept[l];
    }
  }
  if (joined == 1 && !has_handles) return {};
  Opener opener(piece, weights);
  if (!opener.build()) return {false, {}};
  return {true, opener.run(loops, kept)};
}

}  // namespace papilla::detail
