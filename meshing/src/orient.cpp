// SPDX-License-Identifier: MIT
#include "papilla/meshing/orient.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/union_find.hpp"
#include "repair_steps.hpp"
#include "traversal.hpp"

namespace papilla {
namespace {

using namespace detail;

/// The volume of the tetrahedron over a triangle.
double volume_over(const TriangleMesh& mesh, Index t, const Vec3& origin) {
  return dot(mesh.corner(t, 0) - origin, cross(mesh.corner(t, 1) - origin, mesh.corner(t, 2) - origin)) / 6;
}

/// The components of a mesh as they are, found by streaming through it, where a traversal would jump.
struct ComponentsAsTheyAre {
  std::vector<Component> components;  ///< Without ranges and boxes.
  std::vector<Index> of_triangle;
  std::vector<std::uint8_t> consistent;  ///< Per component: all neighbours agree.
};

ComponentsAsTheyAre components_as_they_are(const TriangleMesh& mesh, const EdgeTable& edges) {
  UnionFind sets(mesh.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (const auto h = edges.halfedges(e); h.size() == 2) sets.unite(triangle_of(h[0]), triangle_of(h[1]));
  Index count = 0;
  ComponentsAsTheyAre result;
  result.of_triangle = sets.labels(count);
  result.components.resize(count);
  result.consistent.assign(count, 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.halfedges(e);
    if (h.size() != 2)
      for (const Index half : h) result.components[result.of_triangle[triangle_of(half)]].closed = false;
    else if (runs_up(mesh.triangles, h[0]) == runs_up(mesh.triangles, h[1]))
      result.consistent[result.of_triangle[triangle_of(h[0])]] = 0;
  }
  std::vector<Index> first(count, k_none);
  for (Index t = 0; t < result.of_triangle.size(); ++t) {
    const Index c = result.of_triangle[t];
    if (first[c] == k_none) first[c] = t;
    result.components[c].volume += volume_over(mesh, t, mesh.corner(first[c], 0));
  }
  return result;
}

/// True when a closed, consistent component encloses a negative volume: a cavity, or inside out.
bool has_inward(const ComponentsAsTheyAre& found) {
  for (std::size_t c = 0; c < found.components.size(); ++c)
    if (found.consistent[c] && found.components[c].closed && found.components[c].volume < 0) return true;
  return false;
}

void measure(const TriangleMesh& mesh, const Traversal& traversal, Component& component) {
  const Vec3 origin = mesh.corner(traversal.order[component.begin], 0);
  for (std::size_t i = component.begin; i < component.end; ++i) {
    const Index t = traversal.order[i];
    for (int k = 0; k < 3; ++k) component.box.add(mesh.corner(t, k));
    component.volume += (traversal.turn[t] ? -1 : 1) * volume_over(mesh, t, origin);
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
  const ComponentsAsTheyAre found = components_as_they_are(mesh, edges);
  std::vector<std::uint8_t> fine(mesh.triangles.size(), 0);
  if (!has_inward(found)) {
    for (Index t = 0; t < fine.size(); ++t) fine[t] = found.consistent[found.of_triangle[t]];
    for (std::size_t c = 0; c < found.components.size(); ++c)
      result.closed += found.consistent[c] && found.components[c].closed;
    result.components = static_cast<std::size_t>(std::count(found.consistent.begin(), found.consistent.end(), 1));
    if (result.components == found.components.size()) return false;
  }
  Traversal traversal =
      traverse(mesh.triangles, neighbours(edges, mesh.triangles.size()), std::move(fine), result.conflicting_edges);
  decide_senses(mesh, traversal);
  for (const Component& c : traversal.components) {
    result.closed += c.closed;
    result.reversed += c.turn_all ? c.end - c.begin - c.turned : c.turned;
    if (c.turn_all)
      for (std::size_t i = c.begin; i < c.end; ++i) traversal.turn[traversal.order[i]] ^= 1;
  }
  result.components += traversal.components.size();
  if (result.reversed > 0) reverse_triangles(mesh, traversal.turn);
  return result.reversed > 0;
}

}  // namespace detail

void turn_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& turn) {
  if (turn.size() != mesh.triangles.size())
    throw InvalidInput("turn_triangles: turn has " + std::to_string(turn.size()) + " entries for " +
                       std::to_string(mesh.triangles.size()) + " triangles");
  reverse_triangles(mesh, turn);
}

OrientResult orient(TriangleMesh mesh) {
  check_mesh(mesh, "orient");
  OrientResult result;
  turn_over(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
