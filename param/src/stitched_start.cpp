// SPDX-License-Identifier: MIT
#include "stitched_start.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "corners_of_vertices.hpp"
#include "mend_map.hpp"
#include "papilla/core/union_find.hpp"
#include "place_rigidly.hpp"

namespace papilla::param_detail {
namespace {

/// Vertices around closed seams of n that are placed anew: as far as half their length on both sides, and some.
constexpr std::size_t k_around = 1, k_least_around = 100;

/// More pieces are not laid one by one: all triangles are put together anew.
constexpr Index k_most_pieces = 64;

/// Lays points against others: p -> to + turn (p - from), the turn as a complex number of length 1.
struct Placement {
  Vec2 from, to, turn{1, 0};
  Vec2 operator()(Vec2 p) const { return to + turned(p - from, turn); }
};

/// @param pairs (where it is, where it should be). @return nothing where no turn is best.
std::optional<Placement> placement(const std::vector<std::pair<Vec2, Vec2>>& pairs) {
  Placement result;
  const double weight = 1 / static_cast<double>(pairs.size());
  for (const auto& [from, to] : pairs) result.from = result.from + weight * from, result.to = result.to + weight * to;
  Vec2 turn;
  for (const auto& [from, to] : pairs) {
    const Vec2 p = from - result.from, q = to - result.to;
    turn = turn + Vec2{dot(p, q), cross(p, q)};
  }
  if (!(norm(turn) > 0)) return {};
  result.turn = (1 / norm(turn)) * turn;
  return result;
}

class Stitcher {
 public:
  explicit Stitcher(const ChartSurface& chart) : chart_(chart), corners_(chart.triangles, chart.positions.size()) {
    connect();
  }

  std::optional<std::vector<Vec2>> run() {
    if (pieces_ > k_most_pieces) return from_shapes();
    if (!lay_pieces()) return {};
    std::vector<Vec2> uv = means();
    if (!merged_.empty()) place_rigidly(chart_, corners_, shapes_before(), around_merged(), uv);
    if (!mend_map(chart_, corners_, uv)) return {};
    return uv;
  }

 private:
  std::optional<std::vector<Vec2>> from_shapes() {
    std::vector<Vec2> uv = means();
    std::vector<Index> all(uv.size());
    std::iota(all.begin(), all.end(), Index{0});
    place_rigidly(chart_, corners_, shapes_before(), all, uv);
    if (!mend_map(chart_, corners_, uv)) return {};
    return uv;
  }

  /// An edge between two triangles that was a seam.
  struct Joint {
    std::array<Index, 2> first, second;  ///< Corners at its ends on either side.
    Index piece(const std::vector<Index>& pieces, bool of_second) const {
      return pieces[(of_second ? second : first)[0] / 3];
    }
  };

  Vec2 given(Index corner) const { return chart_.nearby[corner / 3][corner % 3]; }

  /// Finds the vertices that the other map had, its pieces, and the edges that are joined now.
  void connect() {
    const auto triangles = static_cast<Index>(chart_.triangles.size());
    UnionFind corners(3 * triangles), pieces(triangles);
    for (Index t = 0; t < triangles; ++t)
      for (Index k = 0; k < 3; ++k) {
        const Index other = chart_.across[t][k];
        if (other == k_no_triangle || other < t) continue;
        const Index end_k = (k + 1) % 3, from = chart_.triangles[t][k], to = chart_.triangles[t][end_k];
        for (Index m = 0; m < 3; ++m) {
          const Index start_m = (m + 1) % 3;
          if (chart_.triangles[other][start_m] != from || chart_.triangles[other][m] != to) continue;
          const Joint joint{{3 * t + k, 3 * t + end_k}, {3 * other + start_m, 3 * other + m}};
          const auto same = [&](std::size_t end) {
            const Vec2 a = given(joint.first[end]), b = given(joint.second[end]);
            return a.x == b.x && a.y == b.y;
          };
          if (!same(0) || !same(1)) {
            joints_.push_back(joint);
            continue;
          }
          for (const std::size_t end : {0, 1}) corners.unite(joint.first[end], joint.second[end]);
          pieces.unite(t, other);
        }
      }
    Index vertices = 0;
    before_ = corners.labels(vertices);
    piece_ = pieces.labels(pieces_);
    place_.resize(vertices);
    now_.resize(vertices);
    for (Index c = 0; c < before_.size(); ++c)
      place_[before_[c]] = given(c), now_[before_[c]] = chart_.triangles[c / 3][c % 3];
  }

  /// Moves pieces to the largest one, each time that with most edges in common with what is laid.
  bool lay_pieces() {
    if (pieces_ == 1) return true;
    std::vector<Index> size(pieces_, 0);
    for (const Index p : piece_) ++size[p];
    std::vector<char> laid(pieces_, 0);
    laid[static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin())] = 1;
    for (Index left = pieces_ - 1; left > 0; --left) {
      std::vector<Index> common(pieces_, 0);
      for (const Joint& joint : joints_)
        for (const bool second : {false, true})
          if (laid[joint.piece(piece_, !second)] && !laid[joint.piece(piece_, second)])
            ++common[joint.piece(piece_, second)];
      const auto most = std::max_element(common.begin(), common.end());
      if (*most == 0) return false;
      const auto next = static_cast<Index>(most - common.begin());
      if (!lay(next, laid)) return false;
      laid[next] = 1;
    }
    return true;
  }

  bool lay(Index piece, const std::vector<char>& laid) {
    std::vector<std::pair<Vec2, Vec2>> pairs;
    for (const Joint& joint : joints_)
      for (const bool second : {false, true}) {
        if (joint.piece(piece_, second) != piece || !laid[joint.piece(piece_, !second)]) continue;
        const auto& moved = second ? joint.second : joint.first;
        const auto& fixed = second ? joint.first : joint.second;
        for (const std::size_t end : {0, 1})
          pairs.emplace_back(place_[before_[moved[end]]], place_[before_[fixed[end]]]);
      }
    const std::optional<Placement> to = placement(pairs);
    if (!to) return false;
    std::vector<char> moved(place_.size(), 0);
    for (Index c = 0; c < before_.size(); ++c)
      if (piece_[c / 3] == piece && !std::exchange(moved[before_[c]], 1))
        place_[before_[c]] = (*to)(place_[before_[c]]);
    return true;
  }

  /// Of what each vertex was before.
  std::vector<Vec2> means() {
    std::vector<Vec2> uv(chart_.positions.size());
    std::vector<Index> count(uv.size(), 0);
    for (std::size_t o = 0; o < place_.size(); ++o) uv[now_[o]] = uv[now_[o]] + place_[o], ++count[now_[o]];
    for (Index v = 0; v < uv.size(); ++v) {
      uv[v] = (1.0 / count[v]) * uv[v];
      if (count[v] > 1) merged_.push_back(v);
    }
    return uv;
  }

  /// Where the corners of each triangle are in its piece.
  std::vector<std::array<Vec2, 3>> shapes_before() const {
    std::vector<std::array<Vec2, 3>> shapes(chart_.triangles.size());
    for (Index c = 0; c < before_.size(); ++c) shapes[c / 3][c % 3] = place_[before_[c]];
    return shapes;
  }

  /// Vertices around those that were several, these first.
  std::vector<Index> around_merged() const {
    std::vector<Index> found = merged_;
    std::vector<char> seen(chart_.positions.size(), 0);
    for (const Index v : found) seen[v] = 1;
    const std::size_t enough = k_around * merged_.size() * merged_.size() + k_least_around;
    for (std::size_t i = 0; i < found.size() && found.size() < enough; ++i)
      for (const Index c : corners_.of(found[i]))
        for (const Index v : chart_.triangles[c / 3])
          if (!std::exchange(seen[v], 1)) found.push_back(v);
    return found;
  }

  const ChartSurface& chart_;
  CornersOfVertices corners_;
  std::vector<Joint> joints_;
  std::vector<Index> before_, piece_;  ///< Of each corner: its vertex in the other map; of each triangle.
  Index pieces_ = 0;
  std::vector<Vec2> place_;    ///< Of the vertices of the other map.
  std::vector<Index> now_;     ///< The vertex that they belong to.
  std::vector<Index> merged_;  ///< Vertices that were several.
};

}  // namespace

std::optional<std::vector<Vec2>> stitched_start(const ChartSurface& chart) { return Stitcher(chart).run(); }

}  // namespace papilla::param_detail
