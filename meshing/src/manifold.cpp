// SPDX-License-Identifier: MIT
#include "papilla/meshing/manifold.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "point_tree.hpp"
#include "repair_steps.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Copies move by at most this fraction of the shortest edge around, so that no triangle turns over.
constexpr double k_largest_move = 0.2;

/// Where the directions into a fan's triangles, of length 1, add up to less, the fan lies all around its vertex.
constexpr double k_least_inward = 0.1;

/// Copies keep this fraction of the gap from every other vertex: twice the weld's tolerance at the default gap.
constexpr double k_clearance = 0.6;

/// Of two half-edges of one edge: are their triangles front and back of a double sheet?
bool are_front_and_back(Index a, Index b, std::span<const Triangle> triangles) {
  return apex_of(triangles, a) == apex_of(triangles, b);
}

bool is_bad(std::span<const Index> halfedges, std::span<const Triangle> triangles) {
  return halfedges.size() > 2 ||
         (halfedges.size() == 2 && (runs_up(triangles, halfedges[0]) == runs_up(triangles, halfedges[1]) ||
                                    are_front_and_back(halfedges[0], halfedges[1], triangles)));
}

/// The half-edges of one edge in the order of their triangles around it, counter-clockwise seen against the edge's
/// direction from its smaller to its larger vertex.
std::vector<Index> sorted_around(const TriangleMesh& mesh, std::span<const Index> halfedges) {
  const Index h0 = halfedges.front();
  Index low = from_vertex(mesh.triangles, h0), high = to_vertex(mesh.triangles, h0);
  if (low > high) std::swap(low, high);
  const Vec3 origin = mesh.positions[low], axis = normalized(mesh.positions[high] - origin);
  const auto apex = [&](Index h) {
    const Vec3 w = mesh.positions[apex_of(mesh.triangles, h)] - origin;
    return w - dot(w, axis) * axis;
  };
  const Vec3 x = normalized(apex(h0)), y = cross(axis, x);
  std::vector<std::tuple<double, bool, Index>> sorted;
  for (const Index h : halfedges) {
    const Vec3 w = apex(h);
    // Upward first at equal angles: a double sheet ends the place before it and starts the one behind it.
    sorted.emplace_back(std::atan2(dot(w, y), dot(w, x)), !runs_up(mesh.triangles, h), h);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> order;
  for (const auto& entry : sorted) order.push_back(std::get<2>(entry));
  return order;
}

/// Pairs half-edges of one edge like brackets around it: the inner side of a downward one lies at growing angles, that
/// of an upward one at falling angles, so a downward one and the next upward one after it bound one solid. Front and
/// back of a double sheet bound none.
void pair_around(const TriangleMesh& mesh, std::span<const Index> halfedges, std::vector<Index>& opposite) {
  const std::vector<Index> order = sorted_around(mesh, halfedges);
  std::vector<Index> open;
  for (int round = 0; round < 2; ++round)  // the second round closes brackets over the start of the circle
    for (const Index h : order) {
      if (opposite[h] != k_none) continue;
      if (!runs_up(mesh.triangles, h)) {
        if (round == 0) open.push_back(h);
      } else if (!open.empty() && !are_front_and_back(h, open.back(), mesh.triangles)) {
        opposite[h] = open.back();
        opposite[open.back()] = h;
        open.pop_back();
      }
    }
}

/// Finds places for copies that keep clear of all vertices and of each other, so that no weld joins them again.
class FreePlaces {
 public:
  /// `starts`: where along() will start from, with steps of at most `step`.
  FreePlaces(std::span<const Vec3> positions, std::span<const Vec3> starts, double step, double clearance)
      : clearance_(clearance), tree_(positions, near(positions, starts, k_most_parting_steps * step + clearance)) {}

  /// start + m · step for the smallest m from 1 that is clear; m = k_most_parting_steps when none is.
  Vec3 along(const Vec3& start, const Vec3& step) {
    Vec3 place = start + step;
    for (int m = 1; m < k_most_parting_steps && !is_clear(place); ++m) place = place + step;
    placed_.emplace(cell_of(place, clearance_, 0), place);
    return place;
  }

 private:
  static constexpr int k_neighbours = 27, k_own = 0;
  using Cell = std::array<double, 3>;  // whole numbers, whatever their size

  /// The cell that p lies in, or one of the 26 around it.
  static Cell cell_of(const Vec3& p, double size, int neighbour) {
    constexpr int k_steps[3] = {0, 1, -1};
    const auto index = [size](double value, int d) { return std::floor(value / size) + d; };
    return {index(p.x, k_steps[neighbour % 3]), index(p.y, k_steps[neighbour / 3 % 3]),
            index(p.z, k_steps[neighbour / 9])};
  }

  struct CellHash {
    std::size_t operator()(const Cell& cell) const noexcept {
      std::uint64_t h = 0;
      for (const double x : cell) h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u;
      return h ^ h >> 32;
    }
  };

  /// A superset of the positions within `radius` of a start.
  static std::vector<Index> near(std::span<const Vec3> positions, std::span<const Vec3> starts, double radius) {
    std::unordered_set<Cell, CellHash> cells;
    for (const Vec3& p : starts)
      for (int i = 0; i < k_neighbours; ++i) cells.insert(cell_of(p, radius, i));
    std::vector<Index> members;
    for (Index v = 0; v < positions.size(); ++v)
      if (cells.contains(cell_of(positions[v], radius, k_own))) members.push_back(v);
    return members;
  }

  bool is_clear(const Vec3& p) const {
    bool clear = true;
    tree_.near_point(p, clearance_, [&](Index, const Vec3& q) { clear = clear && norm(q - p) >= clearance_; });
    for (int i = 0; i < k_neighbours && clear; ++i) {
      const auto [begin, end] = placed_.equal_range(cell_of(p, clearance_, i));
      for (auto other = begin; other != end && clear; ++other) clear = norm(other->second - p) >= clearance_;
    }
    return clear;
  }

  double clearance_;
  PointTree tree_;
  std::unordered_multimap<Cell, Vec3, CellHash> placed_;
};

/// The corners around vertices that have several fans of triangles; corners are numbered like half-edges.
class FansAround {
 public:
  struct Corner {
    Index vertex, fan, corner;  ///< `fan`: the smallest corner of its fan.
    auto operator<=>(const Corner&) const = default;
  };

  FansAround(std::span<const Triangle> triangles, std::size_t vertex_count, std::span<const Index> opposite)
      : opposite_(opposite) {
    const std::vector<std::uint8_t> several = vertices_with_several_fans(triangles, vertex_count);
    if (several.empty()) return;
    for (Index c = 0; c < opposite.size(); ++c)
      if (several[from_vertex(triangles, c)])
        corners_.push_back({from_vertex(triangles, c), smallest_corner_of_fan(c), c});
    std::sort(corners_.begin(), corners_.end());
  }

  /// In the order of vertices, fans, corners.
  const std::vector<Corner>& corners() const noexcept { return corners_; }

 private:
  /// The corner of the same vertex in the next triangle, against and with the clock.
  Index forward(Index c) const noexcept { return opposite_[previous_halfedge(c)]; }
  Index backward(Index c) const noexcept { return opposite_[c] == k_none ? k_none : next_halfedge(opposite_[c]); }

  /// Visits the corners of c's fan.
  template <class Visit>
  void walk(Index c, const Visit& visit) const {
    visit(c);
    Index at = forward(c);
    for (; at != k_none && at != c; at = forward(at)) visit(at);
    if (at == c) return;
    for (at = backward(c); at != k_none; at = backward(at)) visit(at);
  }

  Index smallest_corner_of_fan(Index c) const {
    Index smallest = c;
    walk(c, [&](Index other) { smallest = std::min(smallest, other); });
    return smallest;
  }

  /// Empty when there is none.
  std::vector<std::uint8_t> vertices_with_several_fans(std::span<const Triangle> triangles,
                                                       std::size_t vertex_count) const {
    std::vector<std::int32_t> unseen(vertex_count, 0);
    for (const Triangle& t : triangles)
      for (const Index v : t) ++unseen[v];
    std::vector<std::uint8_t> walked(vertex_count, 0);
    bool any = false;
    for (Index c = 0; c < opposite_.size(); ++c) {
      const Index v = from_vertex(triangles, c);
      if (walked[v]) continue;
      walked[v] = 1;
      walk(c, [&](Index) { --unseen[v]; });
      any = any || unseen[v] != 0;
    }
    if (!any) return {};
    for (std::size_t v = 0; v < vertex_count; ++v) walked[v] = unseen[v] != 0;
    return walked;
  }

  std::span<const Index> opposite_;
  std::vector<Corner> corners_;
};

class Splitter {
 public:
  Splitter(TriangleMesh& mesh, const EdgeTable& edges, double gap, ManifoldResult& result)
      : mesh_(mesh),
        edges_(edges),
        gap_(gap),
        result_(result),
        opposite_(opposite_halfedges(mesh.triangles, edges)),
        is_double_(mesh.triangles.size(), 0) {}

  void run() {
    find_bad_edges();
    copy_vertices();
    if (!bad_edges_.empty()) part_edges_between_same_vertices();
  }

 private:
  /// The new position of a vertex that is separated from another one at `start`.
  Vec3 place(const Vec3& start, const Vec3& step) {
    if (!(gap_ > 0)) return start;
    if (!places_) places_.emplace(mesh_.positions, places_at_bad_edges(), gap_, k_clearance * gap_);
    const Vec3 free = places_->along(start, step);
    result_.max_deviation_mm = std::max(result_.max_deviation_mm, norm(free - start));
    return free;
  }

  std::vector<Vec3> places_at_bad_edges() const {
    std::vector<Vec3> places;
    for (const std::size_t e : bad_edges_) {
      const Index h = edges_.halfedges(e).front();
      const Vec3 a = mesh_.positions[from_vertex(mesh_.triangles, h)],
                 b = mesh_.positions[to_vertex(mesh_.triangles, h)];
      places.insert(places.end(), {a, 0.5 * (a + b), b});
    }
    return places;
  }

  void find_bad_edges() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto h = edges_.halfedges(e);
      if (!is_bad(h, mesh_.triangles)) continue;
      bad_edges_.push_back(e);
      for (const Index half : h) opposite_[half] = k_none;
      note_double_sheets(h);
      if (h.size() > 2) pair_around(mesh_, h, opposite_);
    }
    result_.parted_edges = bad_edges_.size();
  }

  void note_double_sheets(std::span<const Index> halfedges) {
    for (std::size_t i = 0; i < halfedges.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (are_front_and_back(halfedges[i], halfedges[j], mesh_.triangles))
          is_double_[triangle_of(halfedges[i])] = is_double_[triangle_of(halfedges[j])] = 1;
  }

  /// Gives every fan of a vertex but the first its own copy of the vertex.
  void copy_vertices() {
    const FansAround fans(mesh_.triangles, mesh_.positions.size(), opposite_);
    const auto& corners = fans.corners();
    const std::vector<Index> parted = corners_at_bad_edges();
    std::vector<std::pair<Index, Vec3>> moves;
    std::size_t begin = 0;
    while (begin < corners.size()) {
      std::size_t end = begin;  // of the vertex
      double shortest = std::numeric_limits<double>::max();
      for (; end < corners.size() && corners[end].vertex == corners[begin].vertex; ++end)
        shortest = std::min(shortest, shortest_edge_at(corners[end].corner));
      const Index first_fan = corners[begin].fan;
      while (begin < end && corners[begin].fan == first_fan) ++begin;
      while (begin < end) begin = copy_fan(corners, begin, end, parted, shortest, moves);
    }
    for (const auto& [corner, vertex] : new_corners_) mesh_.triangles[triangle_of(corner)][corner_of(corner)] = vertex;
    for (const auto& [vertex, step] : moves) mesh_.positions[vertex] = place(mesh_.positions[vertex], step);
  }

  /// Gives the fan at `begin` its own vertex, to be moved into its sheet when it touches a bad edge; returns its end.
  std::size_t copy_fan(const std::vector<FansAround::Corner>& corners, std::size_t begin, std::size_t end,
                       const std::vector<Index>& parted, double shortest, std::vector<std::pair<Index, Vec3>>& moves) {
    const auto [v, fan, first] = corners[begin];
    const Index copy = static_cast<Index>(mesh_.positions.size());
    mesh_.positions.push_back(Vec3{mesh_.positions[v]});
    ++result_.added_vertices;
    Vec3 inward{}, outward{};
    bool at_bad_edge = false, is_double = true;
    for (; begin < end && corners[begin].fan == fan; ++begin) {
      const Index corner = corners[begin].corner;
      new_corners_.emplace_back(corner, copy);
      inward = inward + towards_opposite_side(corner);
      outward = outward + normalized(area_vector_at(corner));
      is_double = is_double && is_double_[triangle_of(corner)];
      at_bad_edge = at_bad_edge || std::binary_search(parted.begin(), parted.end(), corner);
    }
    // Either side of a double sheet goes to where it is seen from, so that neither hides the other.
    const Vec3 way = is_double ? outward : norm(inward) < k_least_inward ? -outward : inward;
    if (at_bad_edge) moves.emplace_back(copy, std::min(gap_, k_largest_move * shortest) * normalized(way));
    return begin;
  }

  /// Corners at the ends of bad edges, ascending.
  std::vector<Index> corners_at_bad_edges() const {
    std::vector<Index> corners;
    for (const std::size_t e : bad_edges_)
      for (const Index h : edges_.halfedges(e)) {
        corners.push_back(h);
        corners.push_back(next_halfedge(h));
      }
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  double shortest_edge_at(Index corner) const {
    const Vec3 v = mesh_.positions[from_vertex(mesh_.triangles, corner)];
    return std::min(norm(mesh_.positions[to_vertex(mesh_.triangles, corner)] - v),
                    norm(mesh_.positions[from_vertex(mesh_.triangles, previous_halfedge(corner))] - v));
  }

  Vec3 area_vector_at(Index corner) const {
    const Index t = triangle_of(corner);
    return area_vector(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }

  Vec3 towards_opposite_side(Index corner) const {
    const Index p = from_vertex(mesh_.triangles, next_halfedge(corner));
    const Index q = from_vertex(mesh_.triangles, previous_halfedge(corner));
    const Vec3 v = mesh_.positions[from_vertex(mesh_.triangles, corner)];
    return normalized(0.5 * (mesh_.positions[p] + mesh_.positions[q]) - v);
  }

  /// Sheets whose parted edges still run between the same two vertices, because their fans are one at both ends,
  /// get a vertex in the middle of all but the first.
  void part_edges_between_same_vertices() {
    std::vector<std::uint8_t> changed(mesh_.triangles.size(), 0);
    for (const std::size_t e : bad_edges_) {
      std::map<std::pair<Index, Index>, std::size_t> uses;
      for (const Index h : edges_.halfedges(e)) {
        const Index other = opposite_[h];
        if (other != k_none && other < h) continue;
        if (changed[triangle_of(h)] || (other != k_none && changed[triangle_of(other)])) continue;
        const std::pair<Index, Index> ends =
            std::minmax({from_vertex(mesh_.triangles, h), to_vertex(mesh_.triangles, h)});
        if (uses[ends]++ == 0) continue;
        split_in_the_middle(h);
        changed[triangle_of(h)] = 1;
        if (other != k_none) changed[triangle_of(other)] = 1;
      }
    }
  }

  void split_in_the_middle(Index h) {
    const Vec3 a = mesh_.positions[from_vertex(mesh_.triangles, h)], b = mesh_.positions[to_vertex(mesh_.triangles, h)];
    const Vec3 middle = 0.5 * (a + b);
    const auto apex = [&](Index halfedge) {
      return mesh_.positions[from_vertex(mesh_.triangles, previous_halfedge(halfedge))];
    };
    Vec3 inward = normalized(apex(h) - middle);
    if (opposite_[h] != k_none) inward = inward + normalized(apex(opposite_[h]) - middle);
    const Index vertex = static_cast<Index>(mesh_.positions.size());
    mesh_.positions.push_back(place(middle, std::min(gap_, k_largest_move * norm(b - a)) * normalized(inward)));
    ++result_.split_edges;
    split_triangle(mesh_, triangle_of(h), corner_of(h), vertex, 0.5);
    if (opposite_[h] != k_none) split_triangle(mesh_, triangle_of(opposite_[h]), corner_of(opposite_[h]), vertex, 0.5);
  }

  TriangleMesh& mesh_;
  const EdgeTable& edges_;
  double gap_;
  ManifoldResult& result_;
  std::vector<Index> opposite_;
  std::vector<std::pair<Index, Index>> new_corners_;  ///< Corner, vertex.
  std::vector<std::size_t> bad_edges_;
  std::vector<std::uint8_t> is_double_;  ///< Per triangle: front or back of a double sheet.
  std::optional<FreePlaces> places_;
};

}  // namespace

namespace detail {

bool has_bad_edges(std::span<const Triangle> triangles, const EdgeTable& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (is_bad(edges.halfedges(e), triangles)) return true;
  return false;
}

bool part_sheets(TriangleMesh& mesh, const EdgeTable& edges, double gap_mm, ManifoldResult& result) {
  Splitter(mesh, edges, gap_mm, result).run();
  return result.parted_edges + result.added_vertices > 0;
}

}  // namespace detail

ManifoldResult split_nonmanifold(TriangleMesh mesh, const ManifoldOptions& options) {
  if (!(options.relative_gap >= 0 && options.relative_gap <= 0.01))
    throw InvalidInput("split_nonmanifold: relative_gap " + std::to_string(options.relative_gap) +
                       " is not in [0, 0.01]");
  check_mesh(mesh, "split_nonmanifold");
  ManifoldResult result;
  part_sheets(mesh, EdgeTable(mesh.triangles, mesh.positions.size()), options.relative_gap * bounds_of(mesh).diagonal(),
              result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
