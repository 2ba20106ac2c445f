// SPDX-License-Identifier: MIT
#include "papilla/param/edge_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "check_mesh.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "edge_loop_near";

using Edge = std::array<Index, 2>;

double cosine_of(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

Vec3 normal_of(const TriangleMesh& mesh, std::size_t t) {
  return normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
}

/// Border edges, edges of three triangles or more, and those bent by more than the angle; each once, in order.
std::vector<Edge> seen_edges(const TriangleMesh& mesh, double feature_angle_deg) {
  struct Side {
    Index low, high, triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      if (a != b) sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(sides.begin(), sides.end());
  const double least_cosine = cosine_of(feature_angle_deg);
  std::vector<Edge> edges;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    const bool is_flat = end - begin == 2 && dot(normal_of(mesh, sides[begin].triangle),
                                                 normal_of(mesh, sides[begin + 1].triangle)) >= least_cosine;
    const Vec3 along = mesh.positions[sides[begin].high] - mesh.positions[sides[begin].low];
    if (!is_flat && norm(along) > 0) edges.push_back({sides[begin].low, sides[begin].high});
  }
  return edges;
}

Vec3 nearest_on_segment(Vec3 a, Vec3 b, Vec3 p) {
  const Vec3 d = b - a;
  const double square = dot(d, d), s = square > 0 ? std::clamp(dot(p - a, d) / square, 0.0, 1.0) : 0;
  return a + s * d;
}

/// Follows edges that are seen.
class Walker {
 public:
  Walker(const TriangleMesh& mesh, const std::vector<Edge>& edges, double most_turn_deg)
      : mesh_(mesh), least_cosine_(cosine_of(most_turn_deg)), used_(edges.size(), 0) {
    for (std::size_t e = 0; e < edges.size(); ++e)
      for (std::size_t k = 0; k < 2; ++k) ends_.push_back({edges[e][k], edges[e][1 - k], e});
    std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) {
      return std::array{a.from, a.to} < std::array{b.from, b.to};
    });
  }

  void use(std::size_t edge) { used_[edge] = 1; }

  /// The vertices after `to`, which is reached from `from`, until the line ends or comes to `home`.
  std::vector<Index> follow(Index from, Index to, Index home) {
    std::vector<Index> line;
    while (to != home) {
      const std::optional<End> next = straightest(from, to);
      if (!next) break;
      used_[next->edge] = 1;
      from = to, to = next->to;
      line.push_back(to);
    }
    return line;
  }

 private:
  struct End {
    Index from, to;
    std::size_t edge;
  };

  std::optional<End> straightest(Index from, Index at) const {
    const Vec3 ahead = normalized(mesh_.positions[at] - mesh_.positions[from]);
    double best = least_cosine_ - 1e-12;
    std::optional<End> next;
    auto end = std::lower_bound(ends_.begin(), ends_.end(), at, [](const End& e, Index v) { return e.from < v; });
    for (; end != ends_.end() && end->from == at; ++end) {
      if (used_[end->edge]) continue;
      const double cosine = dot(ahead, normalized(mesh_.positions[end->to] - mesh_.positions[at]));
      if (cosine > best) best = cosine, next = *end;
    }
    return next;
  }

  const TriangleMesh& mesh_;
  double least_cosine_;
  std::vector<End> ends_;
  std::vector<char> used_;
};

/// An open line runs to where its largest component grows.
void orient(EdgeLoop& loop) {
  const Vec3 d = loop.points.back() - loop.points.front();
  double largest = d.x;
  for (const double c : {d.y, d.z})
    if (std::abs(c) > std::abs(largest)) largest = c;
  if (largest < 0) std::reverse(loop.points.begin(), loop.points.end());
}

}  // namespace

EdgeLoop edge_loop_near(const TriangleMesh& mesh, Vec3 place, const EdgeLoopOptions& options) {
  check_mesh(mesh, k_function);
  const auto refuse = [](const std::string& what) { throw InvalidInput(std::string(k_function) + ": " + what); };
  if (!is_finite(place)) refuse("the place is not finite");
  for (const double angle : {options.feature_angle_deg, options.most_turn_deg})
    if (!(angle >= 0 && angle <= 180)) refuse("an angle is " + std::to_string(angle) + ", it must lie in [0, 180]");
  const std::vector<Edge> edges = seen_edges(mesh, options.feature_angle_deg);
  if (edges.empty()) refuse("the surface neither ends nor bends anywhere: there is no edge to pick");
  std::size_t picked = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double distance =
        norm(nearest_on_segment(mesh.positions[edges[e][0]], mesh.positions[edges[e][1]], place) - place);
    if (distance < least) least = distance, picked = e;
  }
  const auto [first, second] = edges[picked];
  Walker walker(mesh, edges, options.most_turn_deg);
  walker.use(picked);
  const std::vector<Index> ahead = walker.follow(first, second, first);
  EdgeLoop loop;
  loop.is_closed = !ahead.empty() && ahead.back() == first;
  if (!loop.is_closed) {
    const std::vector<Index> behind = walker.follow(second, first, second);
    for (auto v = behind.rbegin(); v != behind.rend(); ++v) loop.points.push_back(mesh.positions[*v]);
  }
  loop.points.push_back(mesh.positions[first]);
  loop.points.push_back(mesh.positions[second]);
  for (const Index v : ahead)
    if (v != first) loop.points.push_back(mesh.positions[v]);
  if (!loop.is_closed) orient(loop);
  return loop;
}

Vec3 direction_near(const EdgeLoop& loop, Vec3 p) {
  const std::size_t count = loop.points.size();
  Vec3 direction;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + (loop.is_closed ? 0 : 1) < count; ++i) {
    const Vec3 a = loop.points[i], b = loop.points[(i + 1) % count];
    const double distance = norm(nearest_on_segment(a, b, p) - p);
    if (distance < least) least = distance, direction = normalized(b - a);
  }
  return direction;
}

}  // namespace papilla
