// SPDX-License-Identifier: MIT
#include "papilla/meshing/orient.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "check_mesh.hpp"
#include "repair_steps.hpp"
#include "union_find.hpp"

namespace papilla {
namespace {

using namespace detail;

struct Box {
  Vec3 low, high;
  void include(const Vec3& p) noexcept {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool contains(const Box& b) const noexcept {
    return low.x < b.low.x && low.y < b.low.y && low.z < b.low.z && high.x > b.high.x && high.y > b.high.y &&
           high.z > b.high.z;
  }
};

/// A range of `Traversal::order` and what orienting needs to know about it.
struct Component {
  std::size_t begin = 0, end = 0;
  std::size_t turned = 0;
  bool closed = true, orientable = true;
  double volume = 0;
  Box box;
  bool turn_all = false;
};

struct Traversal {
  std::vector<Index> order;        ///< Triangles, component by component.
  std::vector<std::uint8_t> turn;  ///< Per triangle.
  std::vector<Component> components;
};

/// The other half-edge of edges with exactly two, whichever way they run.
std::vector<Index> neighbours(const EdgeTable& edges, std::size_t triangle_count) {
  std::vector<Index> neighbour(3 * triangle_count, k_none);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    if (h.size() != 2) continue;
    neighbour[h[0]] = h[1];
    neighbour[h[1]] = h[0];
  }
  return neighbour;
}

/// True when no two neighbours run the same way.
bool is_consistent(const std::vector<Triangle>& triangles, std::span<const Index> neighbour) {
  for (Index h = 0; h < neighbour.size(); ++h)
    if (neighbour[h] != k_none && runs_up(triangles, h) == runs_up(triangles, neighbour[h])) return false;
  return true;
}

/// The components of a mesh that needs no turning, each in ascending order: no traversal, which would jump in memory.
Traversal consistent_components(const TriangleMesh& mesh, std::span<const Index> neighbour) {
  UnionFind sets(mesh.triangles.size());
  for (Index h = 0; h < neighbour.size(); ++h)
    if (neighbour[h] != k_none && neighbour[h] < h) sets.unite(triangle_of(h), triangle_of(neighbour[h]));
  Index count = 0;
  const std::vector<Index> label = sets.labels(count);

  Traversal result;
  result.components.resize(count);
  result.turn.assign(label.size(), 0);
  for (const Index c : label) ++result.components[c].end;
  std::size_t begin = 0;
  for (Component& c : result.components) {
    const std::size_t size = c.end;
    c.begin = c.end = begin;
    begin += size;
  }
  result.order.resize(label.size());
  for (Index t = 0; t < label.size(); ++t) result.order[result.components[label[t]].end++] = t;
  for (Index h = 0; h < neighbour.size(); ++h)
    if (neighbour[h] == k_none) result.components[label[triangle_of(h)]].closed = false;
  return result;
}

/// Breadth-first through each component, turning each triangle to agree with the one it was reached from.
Traversal traverse(const TriangleMesh& mesh, std::span<const Index> neighbour, std::size_t& conflicts) {
  Traversal result;
  result.order.reserve(mesh.triangles.size());
  result.turn.assign(mesh.triangles.size(), 0);
  std::vector<std::uint8_t> seen(mesh.triangles.size(), 0);
  std::size_t conflict_halfedges = 0;
  for (Index seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (seen[seed]) continue;
    Component component;
    component.begin = result.order.size();
    seen[seed] = 1;
    result.order.push_back(seed);
    for (std::size_t at = component.begin; at < result.order.size(); ++at) {
      const Index t = result.order[at];
      component.turned += result.turn[t];
      for (Index h = 3 * t; h < 3 * t + 3; ++h) {
        if (neighbour[h] == k_none) {
          component.closed = false;
          continue;
        }
        const Index other = triangle_of(neighbour[h]);
        const bool same_way = runs_up(mesh.triangles, h) == runs_up(mesh.triangles, neighbour[h]);
        const std::uint8_t wanted = result.turn[t] ^ static_cast<std::uint8_t>(same_way);
        if (!seen[other]) {
          seen[other] = 1;
          result.turn[other] = wanted;
          result.order.push_back(other);
        } else if (result.turn[other] != wanted) {
          component.orientable = false;
          ++conflict_halfedges;
        }
      }
    }
    component.end = result.order.size();
    result.components.push_back(component);
  }
  conflicts = conflict_halfedges / 2;
  return result;
}

void measure(const TriangleMesh& mesh, const Traversal& traversal, Component& component) {
  const Vec3 origin = mesh.corner(traversal.order[component.begin], 0);
  component.box = {origin, origin};
  for (std::size_t i = component.begin; i < component.end; ++i) {
    const Index t = traversal.order[i];
    const Vec3 a = mesh.corner(t, 0) - origin, b = mesh.corner(t, 1) - origin, c = mesh.corner(t, 2) - origin;
    for (int k = 0; k < 3; ++k) component.box.include(mesh.corner(t, k));
    component.volume += (traversal.turn[t] ? -1 : 1) * dot(a, cross(b, c)) / 6;
  }
}

/// True when a ray from p along a fixed oblique direction crosses the component an odd number of times.
bool is_inside(const TriangleMesh& mesh, const Traversal& traversal, const Component& component, const Vec3& p) {
  constexpr Vec3 k_direction{0.5571, 0.6403, 0.5288};  // oblique to the axes and planes that CAD parts favour
  bool inside = false;
  for (std::size_t i = component.begin; i < component.end; ++i) {
    const Index t = traversal.order[i];
    const Vec3 a = mesh.corner(t, 0) - p, b = mesh.corner(t, 1) - p, c = mesh.corner(t, 2) - p;
    const double u = dot(k_direction, cross(b, c)), v = dot(k_direction, cross(c, a)),
                 w = dot(k_direction, cross(a, b));
    if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
    if (dot(a, cross(b, c)) * (u + v + w) > 0) inside = !inside;
  }
  return inside;
}

/// An inward component that its file meant so: it was consistent, and lies inside an odd number of closed others.
bool is_cavity(const TriangleMesh& mesh, const Traversal& traversal, const Component& component) {
  if (component.turned != 0 && component.turned != component.end - component.begin) return false;
  std::size_t around = 0;
  const Vec3 p = mesh.corner(traversal.order[component.begin], 0);
  for (const Component& other : traversal.components)
    if (other.closed && other.orientable && other.box.contains(component.box))
      around += is_inside(mesh, traversal, other, p);
  return around % 2 == 1;
}

void decide_senses(const TriangleMesh& mesh, Traversal& traversal) {
  for (Component& c : traversal.components)
    if (c.closed && c.orientable) measure(mesh, traversal, c);
  for (Component& c : traversal.components) {
    if (c.closed && c.orientable)
      c.turn_all = c.volume < 0 && !is_cavity(mesh, traversal, c);
    else
      c.turn_all = 2 * c.turned > c.end - c.begin;
  }
}

}  // namespace

namespace detail {

bool turn_over(TriangleMesh& mesh, const EdgeTable& edges, OrientResult& result) {
  const std::vector<Index> neighbour = neighbours(edges, mesh.triangles.size());
  Traversal traversal = is_consistent(mesh.triangles, neighbour) ? consistent_components(mesh, neighbour)
                                                                 : traverse(mesh, neighbour, result.conflicting_edges);
  decide_senses(mesh, traversal);
  for (const Component& c : traversal.components) {
    result.closed += c.closed;
    result.reversed += c.turn_all ? c.end - c.begin - c.turned : c.turned;
    if (c.turn_all)
      for (std::size_t i = c.begin; i < c.end; ++i) traversal.turn[traversal.order[i]] ^= 1;
  }
  result.components = traversal.components.size();
  if (result.reversed > 0) reverse_triangles(mesh, traversal.turn);
  return result.reversed > 0;
}

}  // namespace detail

OrientResult orient(TriangleMesh mesh) {
  check_mesh(mesh, "orient");
  OrientResult result;
  turn_over(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
