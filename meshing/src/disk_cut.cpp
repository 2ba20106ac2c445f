// SPDX-License-Identifier: MIT
#include "disk_cut.hpp"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "label_topology.hpp"
#include "papilla/meshing/submesh.hpp"
#include "union_find.hpp"

namespace papilla::detail {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Where a region starts to grow: a triangle and its distance from what the region starts at.
struct Source {
  Index triangle = 0;
  double distance = 0;
};

/// One chart as a surface of its own.
struct Piece {
  explicit Piece(Submesh submesh)
      : mesh(std::move(submesh)),
        edges(mesh.triangles, mesh.positions.size()),
        opposite(opposite_halfedges(mesh.triangles, edges)) {
    centroid.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
      centroid.push_back((1.0 / 3) * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]));
  }

  std::size_t size() const noexcept { return mesh.triangles.size(); }
  Vec3 from(Index h) const { return mesh.positions[from_vertex(mesh.triangles, h)]; }
  Vec3 to(Index h) const { return mesh.positions[to_vertex(mesh.triangles, h)]; }
  double length(Index h) const { return norm(to(h) - from(h)); }
  double area(Index t) const { return 0.5 * norm(cross(to(3 * t) - from(3 * t), to(3 * t + 1) - from(3 * t))); }

  /// Every edge has one triangle, or two that run opposite ways.
  bool is_manifold() const {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.halfedges(e);
      if (h.size() > 2 || (h.size() == 2 && opposite[h[0]] == k_none)) return false;
    }
    return edges.size() > 0 && std::none_of(mesh.triangles.begin(), mesh.triangles.end(), repeats_corner);
  }

  Submesh mesh;
  EdgeTable edges;
  std::vector<Index> opposite;
  std::vector<Vec3> centroid;
};

/// Grows one region per source list over the triangles, nearest first (distances between centroids), not across
/// half-edges with a barrier. Returns each triangle's region and distance.
struct Growth {
  std::vector<std::uint8_t> region;
  std::vector<double> distance;
};
Growth grow(const Piece& piece, const std::vector<std::vector<Source>>& sources,
            const std::vector<std::uint8_t>& barrier) {
  using Entry = std::tuple<double, Index, std::uint8_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  Growth growth{std::vector<std::uint8_t>(piece.size(), 0xff), std::vector<double>(piece.size(), k_infinity)};
  const auto reach = [&](Index t, double distance, std::uint8_t region) {
    if (!(distance < growth.distance[t])) return;
    growth.distance[t] = distance;
    growth.region[t] = region;
    queue.emplace(distance, t, region);
  };
  for (std::uint8_t r = 0; r < sources.size(); ++r)
    for (const Source& s : sources[r]) reach(s.triangle, s.distance, r);
  while (!queue.empty()) {
    const auto [distance, t, region] = queue.top();
    queue.pop();
    if (distance > growth.distance[t] || region != growth.region[t]) continue;
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      if (piece.opposite[h] == k_none || barrier[h]) continue;
      const Index other = triangle_of(piece.opposite[h]);
      reach(other, distance + norm(piece.centroid[other] - piece.centroid[t]), region);
    }
  }
  return growth;
}

/// Makes both regions connected where long triangles let them interlock: of each, the piece with the most area stays
/// and the others go to the other region.
void connect_regions(const Piece& piece, const std::vector<std::uint8_t>& barrier, std::vector<std::uint8_t>& region) {
  std::vector<Index> inner = piece.opposite;
  for (Index h = 0; h < inner.size(); ++h)
    if (barrier[h]) inner[h] = k_none;
  for (const std::uint8_t side : {std::uint8_t{0}, std::uint8_t{1}}) {
    std::vector<std::uint32_t> parts(region.begin(), region.end());
    std::vector<double> area(split_into_components(inner, parts), 0);
    for (Index t = 0; t < piece.size(); ++t)
      if (region[t] == side) area[parts[t]] += piece.area(t);
    const auto largest = std::max_element(area.begin(), area.end());
    if (!(*largest > 0)) return;
    for (Index t = 0; t < piece.size(); ++t)
      if (region[t] == side && parts[t] != largest - area.begin()) region[t] = static_cast<std::uint8_t>(1 - side);
  }
}

/// Half way between the two triangles that lie furthest apart (found by two sweeps).
std::vector<std::uint8_t> bisect_between_farthest(const Piece& piece) {
  const std::vector<std::uint8_t> no_barrier(piece.opposite.size(), 0);
  const auto farthest = [&](Index from) {
    const Growth growth = grow(piece, {{{from, 0}}}, no_barrier);
    return static_cast<Index>(std::max_element(growth.distance.begin(), growth.distance.end()) -
                              growth.distance.begin());
  };
  const Index a = farthest(0);
  Index b = farthest(a);
  if (a == b) b = a == 0 ? 1 : 0;  // all triangles in one place
  return grow(piece, {{{a, 0}}, {{b, 0}}}, no_barrier).region;
}

struct MeshTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Joins the border loops of a chart of genus 0 by shortest paths, which makes it a disk, and bisects that disk so that
/// the two sides of as many paths as possible fall apart.
class LoopCutter {
 public:
  explicit LoopCutter(const Piece& piece) : piece_(piece), barrier_(piece.opposite.size(), 0) { build(); }

  /// Nothing when the paths don't make a disk of the chart.
  std::optional<std::vector<std::uint8_t>> run() {
    find_paths();
    join_loops();
    const std::vector<Index> tour = walk_around();
    if (cut_edges_ == 0 || tour.size() != border_ + 2 * cut_edges_) return std::nullopt;
    std::vector<std::uint8_t> region = grow(piece_, halves_of(tour), barrier_).region;
    connect_regions(piece_, barrier_, region);
    return region;
  }

 private:
  void build() {
    for (const Vec3& p : piece_.mesh.positions) mesh_.add_vertex({p.x, p.y, p.z});
    number_.resize(piece_.opposite.size());
    for (Index t = 0; t < piece_.size(); ++t) {
      const Triangle& c = piece_.mesh.triangles[t];
      const FaceHandle face = mesh_.add_face(VertexHandle(static_cast<int>(c[0])), VertexHandle(static_cast<int>(c[1])),
                                             VertexHandle(static_cast<int>(c[2])));
      if (!face.is_valid()) continue;  // run() then finds that its tour is not closed over the chart
      for (const HalfedgeHandle h : mesh_.fh_range(face)) {
        const auto index = static_cast<std::size_t>(h.idx());
        if (number_.size() <= index) number_.resize(index + 1, k_none);
        const auto from = static_cast<Index>(mesh_.from_vertex_handle(h).idx());
        number_[index] = 3 * t + (c[0] == from ? 0u : c[1] == from ? 1u : 2u);
      }
    }
  }

  Index number(HalfedgeHandle h) const { return number_[static_cast<std::size_t>(h.idx())]; }
  static std::size_t at(VertexHandle v) { return static_cast<std::size_t>(v.idx()); }

  /// Numbers the border loops and finds for each vertex the nearest one and the way there (Dijkstra from all loops).
  void find_paths() {
    loop_.assign(mesh_.n_vertices(), k_none);
    distance_.assign(mesh_.n_vertices(), k_infinity);
    way_.assign(mesh_.n_vertices(), HalfedgeHandle());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const HalfedgeHandle start : mesh_.halfedges()) {
      if (!mesh_.is_boundary(start) || loop_[at(mesh_.to_vertex_handle(start))] != k_none) continue;
      HalfedgeHandle h = start;
      do {
        const VertexHandle v = mesh_.to_vertex_handle(h);
        loop_[at(v)] = loops_;
        distance_[at(v)] = 0;
        queue.emplace(0, v.idx());
        ++border_;
        h = mesh_.next_halfedge_handle(h);
      } while (h != start);
      ++loops_;
    }
    while (!queue.empty()) {
      const auto [distance, index] = queue.top();
      queue.pop();
      const VertexHandle v(index);
      if (distance > distance_[at(v)]) continue;
      for (const HalfedgeHandle h : mesh_.voh_range(v)) {
        const VertexHandle to = mesh_.to_vertex_handle(h);
        const double there = distance + mesh_.calc_edge_length(h);
        if (!(there < distance_[at(to)])) continue;
        distance_[at(to)] = there;
        loop_[at(to)] = loop_[at(v)];
        way_[at(to)] = mesh_.opposite_halfedge_handle(h);
        queue.emplace(there, to.idx());
      }
    }
  }

  /// A way from loop to loop over an edge where their catchments meet.
  struct Link {
    double cost;
    EdgeHandle edge;
    bool deferred;
    bool operator>(const Link& other) const { return std::tie(cost, edge) > std::tie(other.cost, other.edge); }
  };

  /// Kruskal over all links; cuts along the paths of the spanning tree. A tree that is a chain lets one bisection part
  /// all its cuts, so a third path at a loop is taken only when it saves half the length.
  void join_loops() {
    std::priority_queue<Link, std::vector<Link>, std::greater<>> links;
    for (const EdgeHandle e : mesh_.edges()) {
      const auto [a, b] = ends(e);
      if (loop_[at(a)] == loop_[at(b)]) continue;
      links.push({distance_[at(a)] + mesh_.calc_edge_length(e) + distance_[at(b)], e, false});
    }
    UnionFind joined(loops_);
    std::vector<int> paths(loops_, 0);
    while (!links.empty()) {
      const Link link = links.top();
      links.pop();
      const auto [a, b] = ends(link.edge);
      const Index p = loop_[at(a)], q = loop_[at(b)];
      if (joined.find(p) == joined.find(q)) continue;
      if (!link.deferred && std::max(paths[p], paths[q]) >= 2) {
        links.push({2 * link.cost, link.edge, true});
        continue;
      }
      joined.unite(p, q);
      ++paths[p];
      ++paths[q];
      cut(mesh_.halfedge_handle(link.edge, 0));
      for (VertexHandle v : {a, b})
        for (; way_[at(v)].is_valid(); v = mesh_.to_vertex_handle(way_[at(v)])) cut(way_[at(v)]);
    }
  }

  std::pair<VertexHandle, VertexHandle> ends(EdgeHandle e) const {
    const HalfedgeHandle h = mesh_.halfedge_handle(e, 0);
    return {mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h)};
  }

  void cut(HalfedgeHandle h) {
    const Index a = number(h), b = number(mesh_.opposite_halfedge_handle(h));
    if (barrier_[a]) return;
    barrier_[a] = barrier_[b] = 1;
    ++cut_edges_;
  }

  bool ends_disk(Index h) const { return barrier_[h] || piece_.opposite[h] == k_none; }

  /// The half-edges around the disk that the cuts leave, in order, starting on a cut.
  std::vector<Index> walk_around() const {
    const auto first = std::find(barrier_.begin(), barrier_.end(), std::uint8_t{1});
    if (first == barrier_.end()) return {};
    const Index start = static_cast<Index>(first - barrier_.begin());
    std::vector<Index> tour;
    Index h = start;
    do {
      tour.push_back(h);
      h = next_halfedge(h);
      while (!ends_disk(h)) h = next_halfedge(piece_.opposite[h]);
    } while (h != start && tour.size() <= barrier_.size());
    return tour;
  }

  /// Halves the tour: both sides of a cut edge should lie in different halves, as many as possible; among equally good
  /// places the one in the middle of the longest border.
  std::vector<std::vector<Source>> halves_of(const std::vector<Index>& tour) const {
    std::vector<std::size_t> cuts;  // places in the tour that are cut half-edges
    for (std::size_t i = 0; i < tour.size(); ++i)
      if (barrier_[tour[i]]) cuts.push_back(i);
    const std::size_t half = cuts.size() / 2;
    const auto gap_before = [&](std::size_t c) { return border_between(tour, cuts, c); };

    std::vector<std::uint8_t> inside(piece_.opposite.size(), 0);
    std::ptrdiff_t parted = 0;
    const auto toggle = [&](std::size_t c) {
      const Index h = tour[cuts[c % cuts.size()]];
      inside[h] ^= 1;
      parted += inside[h] != inside[piece_.opposite[h]] ? 1 : -1;
    };
    for (std::size_t c = 0; c < half; ++c) toggle(c);
    std::size_t best = 0;
    std::pair<std::ptrdiff_t, double> best_score{-1, 0};
    for (std::size_t c = 0; c < half; ++c) {
      const std::pair<std::ptrdiff_t, double> score{parted, std::min(gap_before(c), gap_before(c + half))};
      if (score > best_score) best = c, best_score = score;
      toggle(c);
      toggle(c + half);
    }

    const std::size_t begin = middle_of_gap(tour, cuts, best), end = middle_of_gap(tour, cuts, best + half);
    std::vector<std::vector<Source>> halves(2);
    for (std::size_t i = 0; i < tour.size(); ++i) {
      const bool in_first = begin <= end ? i >= begin && i < end : i >= begin || i < end;
      const Index h = tour[i], t = triangle_of(h);
      halves[in_first ? 0 : 1].push_back({t, norm(0.5 * (piece_.from(h) + piece_.to(h)) - piece_.centroid[t])});
    }
    return halves;
  }

  /// Length of the border between cut half-edge c - 1 and c of the tour.
  double border_between(const std::vector<Index>& tour, const std::vector<std::size_t>& cuts, std::size_t c) const {
    const std::size_t n = cuts.size();
    double length = 0;
    for (std::size_t i = (cuts[(c + n - 1) % n] + 1) % tour.size(); i != cuts[c % n]; i = (i + 1) % tour.size())
      length += piece_.length(tour[i]);
    return length;
  }

  /// The place in the tour half way along that border.
  std::size_t middle_of_gap(const std::vector<Index>& tour, const std::vector<std::size_t>& cuts, std::size_t c) const {
    const std::size_t n = cuts.size();
    double left = 0.5 * border_between(tour, cuts, c);
    std::size_t i = (cuts[(c + n - 1) % n] + 1) % tour.size();
    for (; i != cuts[c % n]; i = (i + 1) % tour.size()) {
      left -= piece_.length(tour[i]);
      if (left < 0) break;
    }
    return i;
  }

  const Piece& piece_;
  HalfedgeMesh mesh_;
  std::vector<Index> number_;  ///< OpenMesh half-edge -> half-edge of the piece; k_none outside.
  std::vector<std::uint8_t> barrier_;
  std::vector<Index> loop_;
  std::vector<double> distance_;
  std::vector<HalfedgeHandle> way_;
  Index loops_ = 0;
  std::size_t border_ = 0, cut_edges_ = 0;
};

bool has_both(const std::vector<std::uint8_t>& region) {
  return std::find(region.begin(), region.end(), 0) != region.end() &&
         std::find(region.begin(), region.end(), 1) != region.end();
}

std::vector<std::uint8_t> bisect(const Piece& piece, const ChartTopology& topology) {
  if (topology.genus() == 0 && topology.boundary_loops > 1 && piece.is_manifold()) {
    const auto region = LoopCutter(piece).run();
    if (region && has_both(*region)) return *region;
  }
  return bisect_between_farthest(piece);
}

}  // namespace

std::size_t cut_to_disks(const TriangleMesh& mesh, const Surface& surface, const Progress& progress,
                         std::uint32_t count, std::vector<std::uint32_t>& labels) {
  const std::vector<ChartTopology> topologies =
      label_topologies(opposite_within_labels(surface.triangles, surface.edges, labels), labels, count);
  std::vector<std::vector<Index>> pending;
  {
    std::vector<std::vector<Index>> of_label(count);
    for (Index t = 0; t < labels.size(); ++t)
      if (!topologies[labels[t]].is_disk()) of_label[labels[t]].push_back(t);
    for (auto& triangles : of_label)
      if (!triangles.empty()) pending.push_back(std::move(triangles));
  }
  std::size_t bisections = 0;
  const std::size_t first_pending = pending.size();
  while (!pending.empty()) {
    const Piece piece(extract(mesh, pending.back()));
    pending.pop_back();
    if (progress && pending.size() < first_pending)
      progress("disks", 1 - static_cast<double>(pending.size()) / static_cast<double>(first_pending));
    const std::vector<std::uint32_t> one_label(piece.size(), 0);
    const ChartTopology topology = label_topologies(piece.opposite, one_label, 1).front();
    if (topology.is_disk()) continue;
    ++bisections;
    std::vector<std::uint32_t> parts(piece.size(), 0);
    if (topology.components == 1) {
      const std::vector<std::uint8_t> region = bisect(piece, topology);
      parts.assign(region.begin(), region.end());
    }
    const std::uint32_t part_count = split_into_components(piece.opposite, parts);
    std::vector<std::vector<Index>> triangles(part_count);
    for (Index t = 0; t < piece.size(); ++t) triangles[parts[t]].push_back(piece.mesh.triangle_of[t]);
    for (std::uint32_t part = 0; part < part_count; ++part) {
      if (part > 0)
        for (const Index t : triangles[part]) labels[t] = count;
      count += part > 0;
      pending.push_back(std::move(triangles[part]));
    }
  }
  return bisections;
}

}  // namespace papilla::detail
