// SPDX-License-Identifier: MIT
#include "open_sheets.hpp"

#include <algorithm>
#include <utility>

#include "exact_positions.hpp"
#include "traversal.hpp"

namespace papilla::detail {
namespace {

/// The triangle from its smallest vertex on.
Triangle rotated(const Triangle& t) {
  if (t[0] <= t[1] && t[0] <= t[2]) return t;
  return t[1] <= t[2] ? Triangle{t[1], t[2], t[0]} : Triangle{t[2], t[0], t[1]};
}

/// Leaves out triangles over the same three vertices: all of those of which some show their backs, else all but the
/// first.
/// @return the latter, each with the first.
std::vector<std::pair<Index, Index>> leave_out_doubles(std::vector<Triangle>& triangles,
                                                       std::vector<std::uint8_t>& left_out) {
  struct Key {
    Triangle vertices;
    bool is_reversed;
    Index triangle;
  };
  std::vector<Key> keys;
  for (Index t = 0; t < triangles.size(); ++t) {
    if (left_out[t]) continue;
    Triangle vertices = rotated(triangles[t]);
    const bool is_reversed = vertices[1] > vertices[2];
    if (is_reversed) std::swap(vertices[1], vertices[2]);
    keys.push_back({vertices, is_reversed, t});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.triangle < b.triangle;
  });
  std::vector<std::pair<Index, Index>> copies;
  const auto leave_out = [&](Index t) {
    left_out[t] = 1;
    triangles[t] = {};
  };
  for (std::size_t begin = 0, end; begin < keys.size(); begin = end) {
    bool both = false;
    for (end = begin + 1; end < keys.size() && keys[end].vertices == keys[begin].vertices; ++end)
      both |= keys[end].is_reversed != keys[begin].is_reversed;
    if (both) leave_out(keys[begin].triangle);
    for (std::size_t i = begin + 1; i < end; ++i) {
      leave_out(keys[i].triangle);
      if (!both) copies.emplace_back(keys[i].triangle, keys[begin].triangle);
    }
  }
  return copies;
}

bool has_crowded_edge(const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.halfedges(e).size() > 2) return true;
  return false;
}

}  // namespace

OpenSheets find_open_sheets(const TriangleMesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  const ExactPositions welded = exact_positions(mesh);
  std::vector<Triangle> triangles(count);
  std::vector<std::uint8_t> left_out(count, 0);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 3; ++k) triangles[t][k] = welded.of_position[mesh.triangles[t][k]];
    left_out[t] = repeats_corner(triangles[t]);
  }
  std::vector<std::pair<Index, Index>> copies;
  EdgeTable edges(triangles, welded.first.size());
  if (has_crowded_edge(edges)) {
    copies = leave_out_doubles(triangles, left_out);
    edges = EdgeTable(triangles, welded.first.size());
  }
  std::size_t conflicts = 0;
  const Traversal traversal = traverse(triangles, neighbours(edges, count), std::move(left_out), conflicts);

  const std::vector<Component>& components = traversal.components;
  std::vector<Index> component_of(count, k_none);
  for (Index c = 0; c < components.size(); ++c)
    for (std::size_t i = components[c].begin; i < components[c].end; ++i) component_of[traversal.order[i]] = c;
  std::vector<std::uint8_t> is_open(components.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (const auto halfedges = edges.halfedges(e); halfedges.size() % 2 == 1)
      for (const Index h : halfedges) is_open[component_of[triangle_of(h)]] = 1;

  OpenSheets result;
  result.against.assign(count, 0);
  std::vector<Index> sheet_of(components.size(), k_none);
  for (std::size_t c = 0; c < components.size(); ++c) {
    const Component& component = components[c];
    if (!is_open[c] && component.orientable) continue;
    sheet_of[c] = static_cast<Index>(result.sheets.size());
    OpenSheet sheet;
    sheet.orientable = component.orientable;
    const bool turn_all = 2 * component.turned > component.end - component.begin;
    for (std::size_t i = component.begin; i < component.end; ++i) {
      const Index t = traversal.order[i];
      result.against[t] = static_cast<std::uint8_t>((traversal.turn[t] != 0) != turn_all);
      sheet.triangles.push_back(t);
    }
    std::sort(sheet.triangles.begin(), sheet.triangles.end());
    result.sheets.push_back(std::move(sheet));
  }
  for (const Index h : edges.boundary_halfedges())
    if (const Index sheet = sheet_of[component_of[triangle_of(h)]]; sheet != k_none)
      result.sheets[sheet].border.push_back(h);
  for (const auto& [copy, first] : copies)
    if (component_of[first] != k_none && sheet_of[component_of[first]] != k_none) {
      result.sheets[sheet_of[component_of[first]]].triangles.push_back(copy);
      result.against[copy] = result.against[first];
    }
  return result;
}

}  // namespace papilla::detail
