// SPDX-License-Identifier: MIT
#include "polygon_patch.hpp"

#include <BRepTools.hxx>
#include <BRepTools_WireExplorer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "papilla/core/bounds.hpp"

namespace papilla::cad {
namespace {

using Loop = std::vector<Index>;

double twice_area(const Loop& loop, const std::vector<Vec2>& at) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) sum += cross(at[loop[i]], at[loop[(i + 1) % loop.size()]]);
  return sum;
}

/// Adds the edge's nodes to the face, and in the wire's order to the loop; the last one starts the next edge.
void append_edge(const TopoDS_Edge& edge, const EdgeNet& net, const FaceSurface& surface, FaceMesh& mesh, Loop& loop) {
  EdgeUse use;
  if (!make_use(net, edge, mesh.face, use)) return;
  const EdgeLine& line = net.lines()[use.edge];
  for (std::size_t k = 0; k < line.parameters.size(); ++k) {
    use.nodes.push_back(static_cast<Index>(mesh.patch.nodes.size()));
    mesh.patch.nodes.push_back(
        edge_node(use, line.parameters[k], surface, line.shared[k], net.points()[line.shared[k]]));
  }
  Loop nodes = use.nodes;
  if (use.reversed) std::reverse(nodes.begin(), nodes.end());
  loop.insert(loop.end(), nodes.begin(), nodes.end());
  mesh.uses.push_back(std::move(use));
}

/// Neighbouring edges end and begin in the same vertex, mostly at the same parameters: one node then.
void join_ends(FaceMesh& mesh, Loop& loop, double tolerance) {
  std::vector<Index> replaced(mesh.patch.nodes.size());
  std::iota(replaced.begin(), replaced.end(), Index{0});
  Loop joined;
  for (const Index node : loop) {
    if (!joined.empty()) {
      const PatchNode &a = mesh.patch.nodes[joined.back()], &b = mesh.patch.nodes[node];
      if (a.shared == b.shared && norm(b.uv - a.uv) <= tolerance) {
        replaced[node] = joined.back();
        continue;
      }
    }
    joined.push_back(node);
  }
  if (joined.size() > 1) {
    const PatchNode &a = mesh.patch.nodes[joined.back()], &b = mesh.patch.nodes[joined.front()];
    if (a.shared == b.shared && norm(b.uv - a.uv) <= tolerance) {
      replaced[joined.back()] = joined.front();
      joined.pop_back();
    }
  }
  for (EdgeUse& use : mesh.uses)
    for (Index& node : use.nodes) node = replaced[replaced[node]];
  loop = std::move(joined);
}

bool blocks(const std::vector<Vec2>& at, const Loop& loop, std::size_t i, Index a, Index b, Index c) {
  const Index p = loop[i];
  if (p == a || p == b || p == c || at[p] == at[a] || at[p] == at[b] || at[p] == at[c]) return false;
  return cross(at[b] - at[a], at[p] - at[a]) >= 0 && cross(at[c] - at[b], at[p] - at[b]) >= 0 &&
         cross(at[a] - at[c], at[p] - at[c]) >= 0;
}

/// Sine of the smallest angle, negative when clockwise.
double shape_of(Vec2 a, Vec2 b, Vec2 c) {
  const double area = cross(b - a, c - a);
  const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  return longest > 0 ? area / longest : 0;
}

/// The position of the best ear: free of other points and well shaped; when none is free, the best shaped.
std::size_t best_ear(const Loop& loop, const std::vector<Vec2>& at) {
  std::size_t best = 0;
  double best_score = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Index a = loop[(i + loop.size() - 1) % loop.size()], b = loop[i], c = loop[(i + 1) % loop.size()];
    double score = shape_of(at[a], at[b], at[c]);
    constexpr double k_blocked = 10;  // Shapes are at most 0.87.
    if (score <= best_score) continue;
    bool blocked = a == c;
    for (std::size_t k = 0; k < loop.size() && !blocked; ++k) blocked = blocks(at, loop, k, a, b, c);
    if (blocked) score -= k_blocked;
    if (score <= best_score) continue;
    best_score = score;
    best = i;
  }
  return best;
}

std::vector<Triangle> clip_ears(Loop loop, const std::vector<Vec2>& at) {
  std::vector<Triangle> triangles;
  while (loop.size() >= 3) {
    const std::size_t i = best_ear(loop, at);
    const Index a = loop[(i + loop.size() - 1) % loop.size()], c = loop[(i + 1) % loop.size()];
    triangles.push_back({a, loop[i], c});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return triangles;
}

bool segments_cross(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const double p = cross(b - a, c - a), q = cross(b - a, d - a), r = cross(d - c, a - c), s = cross(d - c, b - c);
  return ((p > 0) != (q > 0)) && ((r > 0) != (s > 0));
}

/// Joins a hole to the loop around it by a bridge that is walked in both directions.
void bridge(Loop& outer, const Loop& hole, const std::vector<Vec2>& at) {
  struct Bridge {
    double length;
    std::size_t from, to;
  };
  std::vector<Bridge> bridges;
  for (std::size_t i = 0; i < outer.size(); ++i)
    for (std::size_t k = 0; k < hole.size(); ++k) bridges.push_back({norm(at[hole[k]] - at[outer[i]]), i, k});
  std::stable_sort(bridges.begin(), bridges.end(),
                   [](const Bridge& a, const Bridge& b) { return a.length < b.length; });
  const auto is_free = [&](const Bridge& b) {
    const Index p = outer[b.from], q = hole[b.to];
    const auto crossed_by = [&](const Loop& loop) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Index c = loop[i], d = loop[(i + 1) % loop.size()];
        if (c == p || c == q || d == p || d == q) continue;
        if (segments_cross(at[p], at[q], at[c], at[d])) return true;
      }
      return false;
    };
    return !crossed_by(outer) && !crossed_by(hole);
  };
  auto best = std::find_if(bridges.begin(), bridges.end(), is_free);
  if (best == bridges.end()) best = bridges.begin();
  Loop joined(outer.begin(), outer.begin() + static_cast<std::ptrdiff_t>(best->from) + 1);
  for (std::size_t k = 0; k <= hole.size(); ++k) joined.push_back(hole[(best->to + k) % hole.size()]);
  joined.insert(joined.end(), outer.begin() + static_cast<std::ptrdiff_t>(best->from), outer.end());
  outer = std::move(joined);
}

/// Parameters scaled so that lengths are about those on the surface.
std::vector<Vec2> scaled_parameters(const FaceMesh& mesh, const FaceSurface& surface) {
  Bounds2 bounds;
  for (const PatchNode& node : mesh.patch.nodes) bounds.add(node.uv);
  const SurfaceSample middle = surface.at(bounds.middle());
  const auto usable = [](double scale) { return std::isfinite(scale) && scale > 0 ? scale : 1; };
  const double su = usable(norm(middle.du)), sv = usable(norm(middle.dv));
  std::vector<Vec2> result;
  for (const PatchNode& node : mesh.patch.nodes) result.push_back({su * node.uv.x, sv * node.uv.y});
  return result;
}

}  // namespace

std::optional<FaceMesh> polygon_patch(const TopoDS_Face& face, const EdgeNet& net) {
  FaceMesh mesh;
  mesh.face = face;
  const FaceSurface surface(face);
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  const double tolerance = 1e-4 * std::hypot(u1 - u0, v1 - v0);
  std::vector<Loop> loops;
  for (TopExp_Explorer wires(face, TopAbs_WIRE); wires.More(); wires.Next()) {
    const TopoDS_Wire& wire = TopoDS::Wire(wires.Current());
    std::size_t edges = 0, visited = 0;
    for (TopExp_Explorer all(wire, TopAbs_EDGE); all.More(); all.Next()) ++edges;
    Loop loop;
    for (BRepTools_WireExplorer ordered(wire, face); ordered.More(); ordered.Next(), ++visited)
      append_edge(ordered.Current(), net, surface, mesh, loop);
    if (visited != edges) return std::nullopt;
    join_ends(mesh, loop, tolerance);
    if (loop.size() >= 3) loops.push_back(std::move(loop));
  }
  if (loops.empty()) return std::nullopt;
  const std::vector<Vec2> at = scaled_parameters(mesh, surface);
  const auto size = [&](const Loop& loop) { return std::abs(twice_area(loop, at)); };
  std::stable_sort(loops.begin(), loops.end(), [&](const Loop& a, const Loop& b) { return size(a) > size(b); });
  for (std::size_t i = 0; i < loops.size(); ++i)
    if ((twice_area(loops[i], at) > 0) != (i == 0)) std::reverse(loops[i].begin(), loops[i].end());
  Loop outer = loops.front();
  for (std::size_t i = 1; i < loops.size(); ++i) bridge(outer, loops[i], at);
  mesh.patch.triangles = clip_ears(std::move(outer), at);
  return mesh;
}

}  // namespace papilla::cad
