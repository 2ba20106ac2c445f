// SPDX-License-Identifier: MIT
#include "segmentation_steps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

#include "chart_field.hpp"
#include "papilla/core/units.hpp"
#include "polygon_overlap.hpp"

namespace papilla::detail {
namespace {

/// Angles of a stretch that add up to less unfold exactly.
constexpr double k_flat_rad = 1e-3;
/// Outlines fit where points miss their partners by at most this fraction of the smaller chart's size.
constexpr double k_fit = 1e-3;
/// A union sprawls when its compactness is below this and below that of its parts.
constexpr double k_least_compactness = 0.4;
/// Directions of grain that differ by less count as one.
constexpr double k_grain_deg = 20;
/// A chart whose grain adds up to less than this share has no direction of its own.
constexpr double k_least_grain = 0.3;
constexpr int k_max_rounds = 100;

/// What a stretch must be like for the union to be tried.
struct Trial {
  double cone_rad;       ///< A vertex with more curvature than this ends a stretch.
  double least_joint;    ///< It is at least this fraction of the smaller chart's border.
  double max_log_scale;  ///< The scale that it may bring in, by the estimate that prepares the solve.
  double solve_budget;   ///< All solves together may visit this many times the triangles there are.
};
/// What unfolds easily comes first, then what is curved along the stretch or hangs together by little.
constexpr Trial k_trials[] = {{10 * k_radians_per_degree, 0.15, 0.5, 8}, {90 * k_radians_per_degree, 0.05, 2, 20}};

/// Border half-edges first ... first + size - 1 of chart a, opposite to last ... last - size + 1 of chart b, cyclic.
struct Stretch {
  Index a = 0, b = 0, first = 0, last = 0, size = 0;
  double length = 0, cost = 0;
  double turning = 0;      ///< Sum of |2π - angles| over the vertices inside.
  double worst_scale = 0;  ///< Largest |sum of curvature over a width|.
};

struct Motion {
  double cosine = 1, sine = 0;
  Vec2 shift;
  Vec2 turned(Vec2 p) const { return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y}; }
  Vec2 operator()(Vec2 p) const { return turned(p) + shift; }
};

class Unfolder {
 public:
  Unfolder(const SegmentedMesh& surface, const SeamWeights& weights, const SegmentationOptions& options,
           std::vector<std::uint8_t>& seam, std::vector<ChartOutline> charts)
      : surface_(surface),
        weights_(weights),
        options_(options),
        seam_(seam),
        cutter_(surface, seam),
        charts_(std::move(charts)),
        chart_of_(surface.opposite.size(), k_none),
        place_of_(surface.opposite.size(), k_none) {
    for (Index c = 0; c < charts_.size(); ++c) register_border(c);
  }

  std::vector<ChartOutline> run() {
    for (trial_number_ = 0; trial_number_ < std::size(k_trials); ++trial_number_) {
      trial_ = k_trials[trial_number_];
      budget_ = static_cast<std::size_t>(budget_of(trial_));
      tell();
      rounds();
    }
    std::erase_if(charts_, [](const ChartOutline& c) { return c.triangles.empty(); });
    return std::move(charts_);
  }

 private:
  double budget_of(const Trial& trial) const {
    return options_.union_trials * trial.solve_budget * static_cast<double>(surface_.size());
  }

  /// Whole trials and the solves of this one, each hundredth once.
  void tell() {
    const double begun = budget_of(trial_), used = begun > 0 ? 1 - static_cast<double>(budget_) / begun : 0;
    const double fraction = (static_cast<double>(trial_number_) + used) / std::size(k_trials);
    if (fraction < told_ + 0.01) return;
    told_ = fraction;
    report_progress(options_.progress, "charts", 0.7 + 0.2 * fraction);
  }

  void register_border(Index c) {
    for (Index i = 0; i < charts_[c].border.size(); ++i) {
      chart_of_[charts_[c].border[i]] = c;
      place_of_[charts_[c].border[i]] = i;
    }
  }

  void rounds() {
    std::vector<std::uint8_t> fresh(charts_.size(), 1);  // changed in the last round
    for (int round = 0; round < k_max_rounds; ++round) {
      std::vector<Stretch> stretches;
      for (Index a = 0; a < charts_.size(); ++a) add_stretches(a, fresh, stretches);
      std::stable_sort(stretches.begin(), stretches.end(),
                       [](const Stretch& x, const Stretch& y) { return x.cost > y.cost; });
      std::vector<std::uint8_t> changed(charts_.size(), 0);
      fresh.assign(charts_.size(), 0);
      bool any = false;
      for (const Stretch& s : stretches) {
        if (changed[s.a] || changed[s.b]) {
          fresh[s.a] = 1;
          continue;
        }
        if (!join_if_good(s)) continue;
        changed[s.a] = changed[s.b] = fresh[s.a] = fresh[s.b] = 1;
        any = true;
      }
      if (!any) return;
    }
  }

  std::size_t wrapped(const ChartOutline& chart, std::ptrdiff_t i) const {
    const auto n = static_cast<std::ptrdiff_t>(chart.border.size());
    return static_cast<std::size_t>((i % n + n) % n);
  }

  /// The maximal stretches of chart a with charts of higher number.
  void add_stretches(Index a, const std::vector<std::uint8_t>& fresh, std::vector<Stretch>& stretches) const {
    const ChartOutline& chart = charts_[a];
    const std::size_t n = chart.border.size();
    // Starts behind an edge after which a stretch breaks, or nowhere when all is one.
    std::size_t begin = 0;
    while (begin < n && continues(chart, begin)) ++begin;
    if (begin == n) return;
    for (std::size_t i = begin + 1; i <= begin + n;) {
      std::size_t size = 1;
      while (i + size <= begin + n && continues(chart, (i + size - 1) % n)) ++size;
      const Index other = surface_.opposite[chart.border[i % n]];
      const Index b = other == k_none ? k_none : chart_of_[other];
      if (b != k_none && b > a && (fresh[a] || fresh[b])) {
        const Stretch s = measure(a, b, static_cast<Index>(i % n), static_cast<Index>(size));
        if (s.size < charts_[b].border.size() && unfolds(s)) stretches.push_back(s);
      }
      i += size;
    }
  }

  /// Does the stretch of border half-edge i go on over its end?
  bool continues(const ChartOutline& chart, std::size_t i) const {
    const std::size_t next = (i + 1) % chart.border.size();
    const Index other = surface_.opposite[chart.border[i]], beyond = surface_.opposite[chart.border[next]];
    if (other == k_none || beyond == k_none || chart_of_[other] == k_none || chart_of_[other] != chart_of_[beyond])
      return false;
    const ChartOutline& neighbour = charts_[chart_of_[other]];
    if (&neighbour == &chart || (place_of_[beyond] + 1) % neighbour.border.size() != place_of_[other]) return false;
    return std::abs(chart.turning[next] + neighbour.turning[place_of_[other]]) < trial_.cone_rad;
  }

  Stretch measure(Index a, Index b, Index first, Index size) const {
    Stretch s{a, b, first, place_of_[surface_.opposite[charts_[a].border[first]]], size, 0, 0, 0, 0};
    for (Index i = 0; i < size; ++i) {
      const Index h = half_edge(s, i);
      s.length += surface_.length(h);
      s.cost += weights_.cost(h);
    }
    // Curvature on the stretch scales the map by its sum over the width of the narrower chart.
    const double width = std::min(charts_[a].area, charts_[b].area) / std::max(s.length, 1e-300);
    double sum = 0, behind = 0;
    for (Index i = 1, tail = 1; i < size; ++i) {
      const double q = curvature(s, i);
      s.turning += std::abs(q);
      sum += q;
      behind += surface_.length(half_edge(s, i));
      while (behind > width && tail < i) {
        sum -= curvature(s, tail);
        behind -= surface_.length(half_edge(s, tail++));
      }
      s.worst_scale = std::max(s.worst_scale, std::abs(sum));
    }
    return s;
  }

  Index half_edge(const Stretch& s, Index i) const {
    return charts_[s.a].border[(s.first + i) % charts_[s.a].border.size()];
  }
  std::size_t place_in_b(const Stretch& s, Index i) const {
    return wrapped(charts_[s.b], static_cast<std::ptrdiff_t>(s.last) - static_cast<std::ptrdiff_t>(i));
  }
  /// 2π - angles at the start of the stretch's half-edge i, 0 < i < size.
  double curvature(const Stretch& s, Index i) const {
    return charts_[s.a].turning[(s.first + i) % charts_[s.a].border.size()] +
           charts_[s.b].turning[place_in_b(s, i - 1)];
  }

  double perimeter(const ChartOutline& chart) const {
    double sum = 0;
    for (const Index h : chart.border) sum += surface_.length(h);
    return sum;
  }

  bool unfolds(const Stretch& s) const {
    if (s.worst_scale > trial_.max_log_scale) return false;
    return s.length >= trial_.least_joint * std::min(perimeter(charts_[s.a]), perimeter(charts_[s.b]));
  }

  /// Lays chart b against chart a; nothing when a point misses its partner by more than `tolerance`.
  std::optional<Motion> fit(const Stretch& s, double tolerance) const {
    const ChartOutline &a = charts_[s.a], &b = charts_[s.b];
    const auto pair = [&](Index i) {
      return std::pair(a.place[(s.first + i) % a.border.size()],
                       b.place[wrapped(b, static_cast<std::ptrdiff_t>(place_in_b(s, i)) + 1)]);
    };
    Vec2 p, q;
    for (Index i = 0; i <= s.size; ++i) p = p + pair(i).first, q = q + pair(i).second;
    p = (1.0 / (s.size + 1)) * p, q = (1.0 / (s.size + 1)) * q;
    double along = 0, across = 0;
    for (Index i = 0; i <= s.size; ++i) {
      const auto [x, y] = pair(i);
      along += dot(y - q, x - p);
      across += cross(y - q, x - p);
    }
    const double size = std::hypot(along, across);
    if (!(size > 0)) return std::nullopt;
    Motion motion{along / size, across / size, {}};
    motion.shift = p - motion.turned(q);
    for (Index i = 0; i <= s.size; ++i) {
      const auto [x, y] = pair(i);
      if (norm(motion(y) - x) > tolerance) return std::nullopt;
    }
    return motion;
  }

  /// The outline of the union with chart b moved to chart a.
  ChartOutline stitched(const Stretch& s, const Motion& motion) const {
    const ChartOutline &a = charts_[s.a], &b = charts_[s.b];
    ChartOutline both;
    both.area = a.area + b.area;
    both.distortion = (a.area * a.distortion + b.area * b.distortion) / std::max(both.area, 1e-300);
    const auto append = [&](const ChartOutline& chart, std::size_t start, std::size_t count, double joint, auto place) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = (start + i) % chart.border.size();
        both.border.push_back(chart.border[k]);
        both.place.push_back(place(chart.place[k]));
        both.turning.push_back(i == 0 ? joint : chart.turning[k]);
      }
    };
    const std::size_t after_a = (s.first + s.size) % a.border.size(), after_b = (s.last + 1) % b.border.size();
    const double at_end = a.turning[after_a] + b.turning[place_in_b(s, s.size - 1)] - std::numbers::pi;
    const double at_start = a.turning[s.first] + b.turning[after_b] - std::numbers::pi;
    append(a, after_a, a.border.size() - s.size, at_end, [](Vec2 p) { return p; });
    append(b, after_b, b.border.size() - s.size, at_start, motion);
    return both;
  }

  void set_seam(const Stretch& s, std::uint8_t value) {
    for (Index i = 0; i < s.size; ++i) {
      const Index h = half_edge(s, i);
      seam_[h] = seam_[surface_.opposite[h]] = value;
    }
  }

  /// The outline of the union from a solve of its own.
  ChartOutline solved(const Stretch& s) {
    std::vector<Index> triangles = charts_[s.a].triangles;
    triangles.insert(triangles.end(), charts_[s.b].triangles.begin(), charts_[s.b].triangles.end());
    budget_ -= std::min(budget_, triangles.size());
    tell();
    set_seam(s, 0);
    const Piece piece = cutter_.cut(std::move(triangles));
    set_seam(s, 1);
    return make_outline(piece, ChartField(piece));
  }

  bool join_if_good(const Stretch& s) {
    const ChartOutline &a = charts_[s.a], &b = charts_[s.b];
    if (a.border.size() + b.border.size() <= 2 * std::size_t{s.size}) return false;
    std::optional<ChartOutline> both;
    if (s.turning < k_flat_rad)
      if (const auto motion = fit(s, k_fit * std::sqrt(std::min(a.area, b.area)))) both = stitched(s, *motion);
    if (!both) {
      if (a.triangles.size() + b.triangles.size() > budget_) return false;
      both = solved(s);
      const double added = both->area * both->distortion - a.area * a.distortion - b.area * b.distortion;
      if (added > options_.seam_cost * s.cost * seam_unit(surface_, options_, both->area)) return false;
    }
    if (sprawls(s, *both) || overlaps_itself(both->place) || !grains_agree(s, *both)) return false;
    join(s, std::move(*both));
    return true;
  }

  bool sprawls(const Stretch& s, const ChartOutline& both) const {
    const ChartOutline &a = charts_[s.a], &b = charts_[s.b];
    const double mean = (a.area * compactness(a.place) + b.area * compactness(b.place)) / both.area;
    return compactness(both.place) < std::min(mean, k_least_compactness);
  }

  void join(const Stretch& s, ChartOutline both) {
    set_seam(s, 0);
    ChartOutline &a = charts_[s.a], &b = charts_[s.b];
    // Not only the stretch: around a hole, what was an outer border may be none of the union's.
    for (const ChartOutline* chart : {&a, &b})
      for (const Index h : chart->border) chart_of_[h] = place_of_[h] = k_none;
    if (a.triangles.size() < b.triangles.size()) std::swap(a.triangles, b.triangles);
    both.triangles = std::move(a.triangles);
    both.triangles.insert(both.triangles.end(), b.triangles.begin(), b.triangles.end());
    b = {};
    a = std::move(both);
    register_border(s.a);
  }

  /// Would the grains of both charts run the same way in the union? Each chart's is averaged along its border.
  bool grains_agree(const Stretch& s, const ChartOutline& both) const {
    if (!options_.grain) return true;
    Vec2 grain[2];
    double weight[2] = {0, 0};
    for (std::size_t i = 0; i < both.border.size(); ++i) {
      const Index h = both.border[i];
      const Vec2 edge = both.place[(i + 1) % both.border.size()] - both.place[i];
      const double size = norm(edge), length = surface_.length(h);
      if (!(size > 0) || !(length > 0)) continue;
      const Vec3 normal = surface_.normal[triangle_of(h)], wanted = options_.grain(normal);
      const Vec3 along = (1 / length) * (surface_.positions[to_vertex(surface_.triangles, h)] -
                                         surface_.positions[from_vertex(surface_.triangles, h)]);
      const double x = dot(wanted, along), y = dot(wanted, cross(normal, along));
      const Vec2 d = (1 / size) * edge;
      const std::size_t side = chart_of_[h] == s.a ? 0 : 1;
      grain[side] = grain[side] + length * Vec2{x * d.x - y * d.y, x * d.y + y * d.x};
      weight[side] += length;
    }
    const double p = norm(grain[0]), q = norm(grain[1]);
    if (p < k_least_grain * weight[0] || q < k_least_grain * weight[1]) return true;
    return dot(grain[0], grain[1]) >= std::cos(k_grain_deg * k_radians_per_degree) * p * q;
  }

  const SegmentedMesh& surface_;
  const SeamWeights& weights_;
  const SegmentationOptions& options_;
  std::vector<std::uint8_t>& seam_;
  PieceCutter cutter_;
  std::vector<ChartOutline> charts_;
  std::vector<Index> chart_of_, place_of_;  ///< Per half-edge on an outer border.
  Trial trial_ = k_trials[0];
  std::size_t trial_number_ = 0;
  double told_ = 0;
  std::size_t budget_ = 0;
};

}  // namespace

std::vector<ChartOutline> merge_unfolded(const SegmentedMesh& surface, const SeamWeights& weights,
                                         const SegmentationOptions& options, std::vector<std::uint8_t>& seam,
                                         std::vector<ChartOutline> charts) {
  return Unfolder(surface, weights, options, seam, std::move(charts)).run();
}

}  // namespace papilla::detail
