// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "adjacency.hpp"
#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/pack.hpp"
#include "place_charts.hpp"
#include "tile_phase.hpp"

namespace papilla {
namespace {

using namespace param_detail;

constexpr const char* k_function = "align_phase";

/// One seam edge between charts low < high: uv_low - uv_high at its two ends.
struct Seam {
  std::uint32_t low, high;
  double length;
  Vec2 difference[2];
};

/// All that two charts have in common: the translation of `high` that continues the grain best, and its score.
struct ChartPair {
  std::uint32_t low, high;
  Vec2 translation;
  double score;
};

std::vector<Seam> find_seams(const TriangleMesh& mesh, const Adjacency& across, const Flattening& flattening) {
  std::vector<Seam> seams;
  const auto& chart = flattening.charts.of_triangle;
  for (std::size_t h = 0; h < across.size(); ++h) {
    const std::size_t t = h / 3;
    const Index other = across[h];
    if (other == k_no_triangle || chart[t] >= chart[other]) continue;
    const SeamEdge e = seam_edge(mesh, flattening.uv, t, h % 3, other);
    seams.push_back({chart[t], chart[other], e.length_mm, {e.here[0] - e.there[0], e.here[1] - e.there[1]}});
  }
  std::stable_sort(seams.begin(), seams.end(),
                   [](const Seam& a, const Seam& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  return seams;
}

ChartPair fit_pair(const Seam* begin, const Seam* end, double tolerance) {
  double length = 0;
  Vec2 sum;
  for (const Seam* s = begin; s != end; ++s) {
    length += s->length;
    sum = sum + (0.5 * s->length) * (s->difference[0] + s->difference[1]);
  }
  if (!(length > 0)) return {begin->low, begin->high, begin->difference[0], 0};
  const Vec2 mean = (1 / length) * sum;
  double square = 0;
  for (const Seam* s = begin; s != end; ++s)
    for (const Vec2 d : s->difference) square += 0.5 * s->length * dot(d - mean, d - mean);
  return {begin->low, begin->high, mean, length / (1 + square / length / (tolerance * tolerance))};
}

std::vector<ChartPair> fit_pairs(const std::vector<Seam>& seams, double tolerance) {
  std::vector<ChartPair> pairs;
  for (std::size_t begin = 0; begin < seams.size();) {
    std::size_t end = begin + 1;
    while (end < seams.size() && seams[end].low == seams[begin].low && seams[end].high == seams[begin].high) ++end;
    pairs.push_back(fit_pair(&seams[begin], seams.data() + end, tolerance));
    begin = end;
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const ChartPair& a, const ChartPair& b) { return a.score > b.score; });
  return pairs;
}

/// Charts that are tied to one another; each knows its offset relative to its parent.
class OffsetForest {
 public:
  explicit OffsetForest(std::uint32_t count) : parent_(count), offset_(count) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  /// Joins the trees of both charts so that their offsets differ by `translation`, unless they are one tree already.
  void unite(std::uint32_t low, std::uint32_t high, Vec2 translation) {
    const Vec2 of_low = offset(low), of_high = offset(high);
    const std::uint32_t a = parent_[low], b = parent_[high];  // roots, after offset()
    if (a == b) return;
    const Vec2 b_minus_a = of_low + translation - of_high;
    if (a < b) {
      parent_[b] = a;
      offset_[b] = b_minus_a;
    } else {
      parent_[a] = b;
      offset_[a] = -1.0 * b_minus_a;
    }
  }

  /// The offset relative to the root; afterwards the chart's parent is its root.
  Vec2 offset(std::uint32_t chart) {
    std::vector<std::uint32_t> path;
    while (parent_[chart] != chart) path.push_back(chart), chart = parent_[chart];
    Vec2 sum;
    for (auto p = path.rbegin(); p != path.rend(); ++p) {
      sum = sum + offset_[*p];
      offset_[*p] = sum;
      parent_[*p] = chart;
    }
    return sum;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<Vec2> offset_;
};

void check_options(const PhaseOptions& o) {
  if (!(o.tolerance_mm > 0) || !std::isfinite(o.tolerance_mm))
    throw InvalidInput(std::string(k_function) + ": tolerance_mm is " + std::to_string(o.tolerance_mm) +
                       ", expected above 0");
  if (!(o.tile_mm.x >= 0 && o.tile_mm.y >= 0) || !is_finite(o.tile_mm))
    throw InvalidInput(std::string(k_function) + ": tile_mm is negative or not finite");
}

}  // namespace

AlignedPhase align_phase(const TriangleMesh& mesh, const Flattening& flattening, const PhaseOptions& options) {
  check_options(options);
  check_mesh(mesh, k_function);
  check_charts(mesh, flattening.charts, k_function);
  check_uv(mesh, flattening.uv, k_function);
  const Adjacency across = connect_triangles(mesh);
  const std::vector<Seam> seams = find_seams(mesh, across, flattening);
  OffsetForest forest(flattening.charts.count);
  for (const ChartPair& pair : fit_pairs(seams, options.tolerance_mm))
    if (pair.score > 0) forest.unite(pair.low, pair.high, pair.translation);

  AlignedPhase result;
  for (std::uint32_t c = 0; c < flattening.charts.count; ++c) result.offset.push_back(forest.offset(c));
  result.uv = move_charts(flattening.uv, flattening.charts, result.offset, k_function);
  for (const Seam& s : seams) {
    result.seam_mm += s.length;
    for (const Vec2 d : s.difference) {
      const double jump = norm(wrap_to_tile(d + result.offset[s.low] - result.offset[s.high], options.tile_mm));
      result.mean_jump_mm += 0.5 * s.length * jump;
      if (jump <= options.tolerance_mm) result.continued_mm += 0.5 * s.length;
    }
  }
  if (result.seam_mm > 0) result.mean_jump_mm /= result.seam_mm;
  return result;
}

}  // namespace papilla
