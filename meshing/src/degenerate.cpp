// SPDX-License-Identifier: MIT
#include "papilla/meshing/degenerate.hpp"

#include <algorithm>
#include <queue>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "repair_steps.hpp"
#include "triangle_shape.hpp"

namespace papilla {
namespace {

using namespace detail;

/// An apex within this many tolerances of an end of the longest edge makes a needle. More than one, because the
/// split of a cap would leave an edge that short, and with it the next needle.
constexpr double k_needle_tolerances = 4;

/// How far a pushed apex lies from its edge afterwards, and how often one may be pushed.
constexpr double k_push_tolerances = 2;
constexpr int k_most_pushes = 4;

class DegenerateResolver {
 public:
  DegenerateResolver(TriangleMesh& mesh, double tolerance, DegenerateResult& result)
      : mesh_(mesh),
        tolerance_(tolerance),
        result_(result),
        around_(mesh.triangles, mesh.positions.size()),
        alive_(mesh.triangles.size(), 1) {}

  void run(const std::vector<Index>& degenerate) {
    for (const Index t : degenerate) enqueue(t);
    flips_left_ = 16 * degenerate.size() + 256;
    while (!queue_.empty()) {
      const Index t = queue_.top().triangle;
      queue_.pop();
      if (alive_[t]) resolve(t);
    }
    measure_moves();
    keep_triangles(mesh_, alive_);
    drop_unused(mesh_);
  }

 private:
  struct Entry {
    double longest_edge;
    Index triangle;
    bool operator<(const Entry& other) const noexcept {
      return longest_edge != other.longest_edge ? longest_edge < other.longest_edge : triangle > other.triangle;
    }
  };

  TriangleShape shape(Index t) const {
    return triangle_shape(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
  }

  void enqueue(Index t) {
    const TriangleShape s = shape(t);
    if (repeats_corner(mesh_.triangles[t]) || s.altitude < tolerance_) queue_.push({s.longest_edge, t});
  }

  /// The triangles around a vertex, those that no longer touch it included.
  std::vector<Index>& star(Index v) {
    const auto [place, is_new] = stars_.try_emplace(v);
    if (is_new) place->second.assign(around_.of(v).begin(), around_.of(v).end());
    return place->second;
  }

  void kill(Index t) { alive_[t] = 0; }

  bool touches(Index t, Index v) const {
    const Triangle& c = mesh_.triangles[t];
    return alive_[t] && (c[0] == v || c[1] == v || c[2] == v);
  }

  void resolve(Index t) {
    const Triangle corners = mesh_.triangles[t];
    if (repeats_corner(corners)) {
      kill(t);
      return;
    }
    const TriangleShape s = shape(t);
    if (!(s.altitude < tolerance_)) return;
    const Index a = corners[s.longest_corner], b = corners[next_corner(s.longest_corner)],
                apex = corners[previous_corner(s.longest_corner)];
    const double to_a = norm(mesh_.positions[apex] - mesh_.positions[a]);
    const double to_b = norm(mesh_.positions[apex] - mesh_.positions[b]);
    if (std::min(to_a, to_b) <= k_needle_tolerances * tolerance_)
      collapse(to_a <= to_b ? a : b, apex);
    else if (may_flip(a, b))
      replace_long_edge(t, a, b, apex, s.altitude);
    else
      push_off(t, a, b, apex);
  }

  /// An edge that was flipped away and came back sits in a quadrangle that is flat either way round: flipping it again
  /// would go on for ever.
  bool may_flip(Index a, Index b) {
    if (flips_left_ == 0 || !flipped_away_.insert(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)).second)
      return false;
    --flips_left_;
    return true;
  }

  void collapse(Index p, Index q) {
    ++result_.collapsed;
    const Index stays = std::min(p, q), goes = std::max(p, q);
    std::vector<Index>& star_stays = star(stays);
    for (const Index t : star(goes)) {
      if (!touches(t, goes)) continue;
      for (Index& v : mesh_.triangles[t])
        if (v == goes) v = stays;
      if (repeats_corner(mesh_.triangles[t])) {
        kill(t);
        continue;
      }
      star_stays.push_back(t);
      enqueue(t);
    }
    moves_.emplace_back(goes, stays);
  }

  void replace_long_edge(Index cap, Index a, Index b, Index apex, double altitude) {
    ++result_.flipped;
    kill(cap);
    result_.max_deviation_mm = std::max(result_.max_deviation_mm, altitude);
    const Vec3 d = mesh_.positions[b] - mesh_.positions[a];
    const double s = std::clamp(dot(mesh_.positions[apex] - mesh_.positions[a], d) / dot(d, d), 0.0, 1.0);
    const std::vector<Index>& star_a = star(a);
    const std::vector<Index>& star_b = star(b);
    const std::vector<Index> candidates = star_a.size() < star_b.size() ? star_a : star_b;
    for (const Index t : candidates) {
      if (!touches(t, a) || !touches(t, b)) continue;
      if (touches(t, apex))
        kill(t);  // the same three vertices: as flat as the cap
      else
        split_at(t, a, b, apex, s);
    }
  }

  /// Moves the apex of a cap away from its long edge, to the side that the edge's other triangle doesn't lie on.
  void push_off(Index cap, Index a, Index b, Index apex) {
    const auto [place, is_new] = start_of_pushed_.try_emplace(apex, Pushed{mesh_.positions[apex], 0});
    const Vec3 origin = mesh_.positions[a], along = normalized(mesh_.positions[b] - origin);
    Vec3 away{};
    for (const Index t : star(a)) {
      if (t == cap || !touches(t, a) || !touches(t, b)) continue;
      for (const Index v : mesh_.triangles[t]) {
        const Vec3 w = mesh_.positions[v] - origin;
        if (v != a && v != b) away = away - normalized(w - dot(w, along) * along);
      }
    }
    if (norm(away) < 0.5 || place->second.times++ == k_most_pushes) {
      ++result_.left;
      return;
    }
    const Vec3 foot = origin + dot(mesh_.positions[apex] - origin, along) * along;
    mesh_.positions[apex] = foot + k_push_tolerances * tolerance_ * normalized(away);
    ++result_.pushed;
    result_.max_deviation_mm = std::max(result_.max_deviation_mm, norm(mesh_.positions[apex] - place->second.start));
    for (const Index t : star(apex))
      if (touches(t, apex)) enqueue(t);
  }

  void split_at(Index t, Index a, Index b, Index apex, double s) {
    const Triangle corners = mesh_.triangles[t];
    std::size_t k = 0;
    while (corners[previous_corner(k)] == a || corners[previous_corner(k)] == b) ++k;
    const Index second = split_triangle(mesh_, t, k, apex, corners[k] == a ? s : 1 - s);
    alive_.push_back(1);
    star(apex).push_back(t);
    star(apex).push_back(second);
    star(corners[next_corner(k)]).push_back(second);
    star(corners[previous_corner(k)]).push_back(second);
    enqueue(t);
    enqueue(second);
  }

  /// Chains of collapses add up: compares where each vertex was with where it ended.
  void measure_moves() {
    std::unordered_map<Index, Index> target(moves_.begin(), moves_.end());
    for (const auto& [vertex, next] : moves_) {
      Index end = next;
      for (auto place = target.find(end); place != target.end(); place = target.find(end)) end = place->second;
      target[vertex] = end;
      result_.max_deviation_mm =
          std::max(result_.max_deviation_mm, norm(mesh_.positions[vertex] - mesh_.positions[end]));
    }
  }

  struct Pushed {
    Vec3 start;
    int times;
  };

  TriangleMesh& mesh_;
  double tolerance_;
  DegenerateResult& result_;
  VertexTriangles around_;
  std::vector<std::uint8_t> alive_;
  std::unordered_map<Index, std::vector<Index>> stars_;
  std::priority_queue<Entry> queue_;
  std::vector<std::pair<Index, Index>> moves_;
  std::unordered_set<std::uint64_t> flipped_away_;
  std::size_t flips_left_ = 0;
  std::unordered_map<Index, Pushed> start_of_pushed_;
};

std::vector<Index> degenerate_triangles(const TriangleMesh& mesh, double tolerance) {
  std::vector<Index> found;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    if (triangle_shape(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)).altitude < tolerance)
      found.push_back(t);
  return found;
}

}  // namespace

namespace detail {

bool has_degenerate(const TriangleMesh& mesh, double tolerance_mm) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (triangle_shape(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)).altitude < tolerance_mm) return true;
  return false;
}

bool resolve_degenerate(TriangleMesh& mesh, double sought_mm, double least_mm, DegenerateResult& result) {
  result.repeated = drop_repeated_corners(mesh);
  const std::vector<Index> degenerate = degenerate_triangles(mesh, sought_mm);
  result.found = result.repeated + degenerate.size();
  if (!degenerate.empty()) DegenerateResolver(mesh, least_mm, result).run(degenerate);
  return result.found > 0;
}

}  // namespace detail

DegenerateResult remove_degenerate(TriangleMesh mesh, const DegenerateOptions& options) {
  if (!(options.relative_altitude >= 0 && options.relative_altitude <= 0.1))
    throw InvalidInput("remove_degenerate: relative_altitude " + std::to_string(options.relative_altitude) +
                       " is not in [0, 0.1]");
  check_mesh(mesh, "remove_degenerate");
  DegenerateResult result;
  const double tolerance = options.relative_altitude * bounds_of(mesh).diagonal();
  resolve_degenerate(mesh, tolerance, tolerance, result);
  result.mesh = std::move(mesh);
  return result;
}

}  // namespace papilla
