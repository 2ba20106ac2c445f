// SPDX-License-Identifier: MIT
#include "papilla/meshing/duplicate.hpp"

#include <algorithm>
#include <span>

#include "check_mesh.hpp"
#include "papilla/core/union_find.hpp"
#include "repair_steps.hpp"
#include "same_triangles.hpp"

namespace papilla {
namespace {

using namespace detail;

/// True when the corners ascend in the triangle's sense, starting at the smallest.
bool ascends(const Triangle& t) noexcept {
  const std::size_t k = t[0] < t[1] && t[0] < t[2] ? 0 : t[1] < t[2] ? 1 : 2;
  return t[next_corner(k)] < t[previous_corner(k)];
}

/// What becomes of a triangle. A front is the first of its set and has a back, the first that runs against it.
enum State : std::uint8_t { k_drop, k_keep, k_front, k_back };

struct Pair {
  Index front, back;
};

/// Leaves the first of every set, and the first that runs against it.
std::vector<Pair> pair_fronts_with_backs(std::span<const Triangle> triangles, std::vector<std::uint8_t>& state,
                                         DuplicateResult& result) {
  std::vector<Pair> pairs;
  state.assign(triangles.size(), k_keep);
  for_each_same_group(triangles, [&](std::span<const Index> group) {
    const Index front = group.front();
    for (const Index t : group.subspan(1)) {
      if (state[front] == k_keep && ascends(triangles[t]) != ascends(triangles[front])) {
        state[front] = k_front;
        state[t] = k_back;
        pairs.push_back({front, t});
      } else {
        state[t] = k_drop;
        ++result.same;
      }
    }
  });
  return pairs;
}

/// Does the attribute have the same values at the same vertices of two triangles?
template <class T>
bool is_alike(const TriangleMesh& mesh, const CornerAttribute<T>& attribute, const Pair& pair) {
  if (attribute.has_value(pair.front) != attribute.has_value(pair.back)) return false;
  if (!attribute.has_value(pair.front)) return true;
  const Triangle &front = mesh.triangles[pair.front], &back = mesh.triangles[pair.back];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (front[i] == back[k] &&
          !(attribute.values[attribute.indices[pair.front][i]] == attribute.values[attribute.indices[pair.back][k]]))
        return false;
  return true;
}

bool looks_alike(const TriangleMesh& mesh, const Pair& pair) {
  if (!mesh.material.empty() && mesh.material[pair.front] != mesh.material[pair.back]) return false;
  return is_alike(mesh, mesh.uv, pair) && is_alike(mesh, mesh.uv1, pair) && is_alike(mesh, mesh.colors, pair);
}

/// Sheets of fronts that hang together through edges.
class DoubleSheets {
 public:
  DoubleSheets(std::size_t triangle_count, const EdgeTable& edges, const std::vector<std::uint8_t>& state)
      : sheets_(triangle_count), has_border_(triangle_count, 0), is_free_(triangle_count, 0) {
    std::vector<std::pair<Index, bool>> borders;  // front, does the border carry other surface on both sides
    for (std::size_t e = 0; e < edges.size(); ++e) {
      Index fronts = 0, others = 0, first = k_none;
      for (const Index h : edges.halfedges(e)) {
        const Index t = triangle_of(h);
        others += state[t] == k_keep;
        if (state[t] != k_front) continue;
        if (fronts++ == 0) first = t;
        sheets_.unite(first, t);
      }
      if (fronts == 1) borders.emplace_back(first, others >= 2);
    }
    for (const auto& [t, carried] : borders) (carried ? has_border_ : is_free_)[sheets_.find(t)] = 1;
  }

  Index of(Index front) { return sheets_.find(front); }

  /// Every edge of its border carries two or more other triangles: it lies between two places that these bound.
  bool is_wall(Index front) { return has_border_[of(front)] && !is_free_[of(front)]; }

 private:
  UnionFind sheets_;
  std::vector<std::uint8_t> has_border_, is_free_;
};

void drop_back(const TriangleMesh& mesh, const Pair& pair, std::vector<std::uint8_t>& state, DuplicateResult& result) {
  state[pair.back] = k_drop;
  ++result.opposite;
  result.two_sided.insert(mesh.material.empty() ? 0 : mesh.material[pair.front]);
}

/// Backs of walls stay, and those of sheets that look different from behind; the others go.
void settle_backs(const TriangleMesh& mesh, const EdgeTable& edges, const std::vector<Pair>& pairs,
                  std::vector<std::uint8_t>& state, DuplicateResult& result) {
  DoubleSheets sheets(mesh.triangles.size(), edges, state);
  std::vector<std::uint8_t> has_two_looks(mesh.triangles.size(), 0);
  for (const Pair& pair : pairs)
    if (!looks_alike(mesh, pair)) has_two_looks[sheets.of(pair.front)] = 1;
  for (const Pair& pair : pairs) {
    if (sheets.is_wall(pair.front)) {
      ++result.kept_walls;
    } else if (has_two_looks[sheets.of(pair.front)]) {
      ++result.kept_backs;
    } else {
      drop_back(mesh, pair, state, result);
    }
  }
}

bool share_apex(std::span<const Index> halfedges, std::span<const Triangle> triangles) {
  if (halfedges.size() == 2) return apex_of(triangles, halfedges[0]) == apex_of(triangles, halfedges[1]);
  std::vector<Index> apexes;
  for (const Index h : halfedges) apexes.push_back(apex_of(triangles, h));
  std::sort(apexes.begin(), apexes.end());
  return std::adjacent_find(apexes.begin(), apexes.end()) != apexes.end();
}

}  // namespace

namespace detail {

bool has_duplicates(std::span<const Triangle> triangles, const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.halfedges(e).size() > 1 && share_apex(edges.halfedges(e), triangles)) return true;
  return false;
}

bool drop_duplicates(TriangleMesh& mesh, const EdgeTable& edges, Backs backs, DuplicateResult& result) {
  if (!has_duplicates(mesh.triangles, edges)) return false;
  std::vector<std::uint8_t> state;
  const std::vector<Pair> pairs = pair_fronts_with_backs(mesh.triangles, state, result);
  if (backs == Backs::keep_seen)
    settle_backs(mesh, edges, pairs, state, result);
  else
    for (const Pair& pair : pairs) drop_back(mesh, pair, state, result);
  if (result.same + result.opposite == 0) return false;
  keep_triangles(mesh, state);
  return true;
}

}  // namespace detail

DuplicateResult remove_duplicates(TriangleMesh mesh) {
  check_mesh(mesh, "remove_duplicates");
  DuplicateResult result;
  drop_duplicates(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), Backs::keep_seen, result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
