// SPDX-License-Identifier: MIT
#include "papilla/texture/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/texture/feature_matrix.hpp"

namespace papilla {
namespace {

/// A feature matrix as correlation: c(t) = 1 − d²(t) / mean(d²), smoothed by a Gaussian of about one pixel, so that
/// c averages 0 and is 1 at a perfect repetition.
class CorrelationMap {
 public:
  explicit CorrelationMap(const FeatureMatrix& matrix);

  int reach_x() const noexcept { return reach_x_; }
  int reach_y() const noexcept { return reach_y_; }
  /// False when the picture is flat: then there is nothing to correlate.
  bool usable() const noexcept { return usable_; }
  /// Share of the variance that is not white pixel noise, in [0, 1]: c extrapolated to t = 0.
  double attainable() const noexcept { return attainable_; }

  double at(int dx, int dy) const { return values_[index(dx, dy)]; }
  /// Whether a bilinear look-up is possible at t.
  bool contains(Vec2 t) const;
  double sample(Vec2 t) const;  ///< Bilinear. @pre contains(t)
  /// The vertex of the parabola through the 3 × 3 values around a grid point that is a local maximum.
  Vec2 refined_peak(int dx, int dy) const;
  /// Local maxima (3 × 3) of the half plane dy > 0 or (dy = 0, dx > 0), further than 2 pixels from the origin.
  std::vector<Vec2> peaks() const;
  /// The local maximum reached by climbing from t, at most 3 steps, sub-pixel; t itself when there is none.
  Vec2 climb(Vec2 t) const;

 private:
  std::size_t index(int dx, int dy) const {
    return static_cast<std::size_t>(dy + reach_y_) * static_cast<std::size_t>(2 * reach_x_ + 1) +
           static_cast<std::size_t>(dx + reach_x_);
  }
  bool is_peak(int dx, int dy) const;
  void smooth();

  int reach_x_, reach_y_;
  bool usable_ = false;
  double attainable_ = 0;
  std::vector<double> values_;
};

/// Distortion that is left when the shift goes to zero, extrapolated from shifts of one and two pixels.
double noise_distortion(const FeatureMatrix& matrix) {
  if (matrix.reach_x < 2 || matrix.reach_y < 2) return 0;
  const double one = (matrix.at(1, 0) + matrix.at(0, 1)) / 2, two = (matrix.at(2, 0) + matrix.at(0, 2)) / 2;
  return std::clamp(2 * one - two, 0.0, one);
}

CorrelationMap::CorrelationMap(const FeatureMatrix& matrix)
    : reach_x_(matrix.reach_x), reach_y_(matrix.reach_y), values_(matrix.distortion) {
  const double mean = std::accumulate(values_.begin(), values_.end(), 0.0) / static_cast<double>(values_.size());
  if (!(mean > 0) || reach_x_ < 4 || reach_y_ < 4) return;
  usable_ = true;
  const double noise = noise_distortion(matrix);
  attainable_ = std::clamp(1 - noise / mean, 0.0, 1.0);
  values_[index(0, 0)] = noise;  // Pixel noise does not repeat: without this the origin stands out as a spike.
  for (double& value : values_) value = 1 - value / mean;
  smooth();
}

void CorrelationMap::smooth() {
  static constexpr std::array<double, 5> k_binomial = {1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
  const int width = 2 * reach_x_ + 1, height = 2 * reach_y_ + 1;
  const auto blur = [&](int count, int lines, std::size_t step, std::size_t line_step) {
    std::vector<double> line(static_cast<std::size_t>(count));
    for (int l = 0; l < lines; ++l) {
      double* values = values_.data() + static_cast<std::size_t>(l) * line_step;
      for (int i = 0; i < count; ++i) line[static_cast<std::size_t>(i)] = values[static_cast<std::size_t>(i) * step];
      for (int i = 0; i < count; ++i) {
        double sum = 0;
        for (int k = -2; k <= 2; ++k)
          sum += k_binomial[static_cast<std::size_t>(k + 2)] *
                 line[static_cast<std::size_t>(std::clamp(i + k, 0, count - 1))];
        values[static_cast<std::size_t>(i) * step] = sum;
      }
    }
  };
  blur(width, height, 1, static_cast<std::size_t>(width));
  blur(height, width, static_cast<std::size_t>(width), 1);
}

bool CorrelationMap::contains(Vec2 t) const { return std::abs(t.x) <= reach_x_ - 1 && std::abs(t.y) <= reach_y_ - 1; }

double CorrelationMap::sample(Vec2 t) const {
  const int x = static_cast<int>(std::floor(t.x)), y = static_cast<int>(std::floor(t.y));
  const double u = t.x - x, v = t.y - y;
  return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) + v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

bool CorrelationMap::is_peak(int dx, int dy) const {
  const double centre = at(dx, dy);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      const double other = at(dx + x, dy + y);
      const bool earlier = y < 0 || (y == 0 && x < 0);  // Of equal neighbours the first one is the peak.
      if (earlier ? other >= centre : other > centre) return false;
    }
  return true;
}

Vec2 CorrelationMap::refined_peak(int dx, int dy) const {
  double gx = 0, gy = 0, xx = 0, yy = 0;
  for (int k = -1; k <= 1; ++k) {  // Least squares over the 3 × 3 block.
    gx += (at(dx + 1, dy + k) - at(dx - 1, dy + k)) / 6;
    gy += (at(dx + k, dy + 1) - at(dx + k, dy - 1)) / 6;
    xx += (at(dx + 1, dy + k) - 2 * at(dx, dy + k) + at(dx - 1, dy + k)) / 3;
    yy += (at(dx + k, dy + 1) - 2 * at(dx + k, dy) + at(dx + k, dy - 1)) / 3;
  }
  const double xy = (at(dx + 1, dy + 1) - at(dx - 1, dy + 1) - at(dx + 1, dy - 1) + at(dx - 1, dy - 1)) / 4;
  const double determinant = xx * yy - xy * xy;
  Vec2 offset{};
  if (xx < 0 && determinant > 0) offset = {(xy * gy - yy * gx) / determinant, (xy * gx - xx * gy) / determinant};
  return {dx + std::clamp(offset.x, -1.0, 1.0), dy + std::clamp(offset.y, -1.0, 1.0)};
}

std::vector<Vec2> CorrelationMap::peaks() const {
  std::vector<Vec2> found;
  for (int dy = 0; dy < reach_y_; ++dy)
    for (int dx = dy == 0 ? 1 : 1 - reach_x_; dx < reach_x_; ++dx)
      if (dx * dx + dy * dy > 4 && is_peak(dx, dy)) found.push_back(refined_peak(dx, dy));
  return found;
}

Vec2 CorrelationMap::climb(Vec2 t) const {
  int x = static_cast<int>(std::lround(t.x)), y = static_cast<int>(std::lround(t.y));
  for (int step = 0; step <= 3; ++step) {
    if (std::abs(x) >= reach_x_ || std::abs(y) >= reach_y_) return t;
    int best_x = x, best_y = y;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (at(x + dx, y + dy) > at(best_x, best_y)) {
          best_x = x + dx;
          best_y = y + dy;
        }
    if (best_x == x && best_y == y) return refined_peak(x, y);
    x = best_x;
    y = best_y;
  }
  return t;
}

constexpr double k_decay = 0.5;      // λ, per pixel.
constexpr double k_spread_px = 1.5;  // Standard deviation of a distance.
constexpr double k_least_length_px = 4;
constexpr int k_steps_a_degree = 2, k_directions = 180 * k_steps_a_degree;
constexpr int k_least_turn = 10 * k_steps_a_degree;

Vec2 direction(int step) {
  const double angle = step * std::numbers::pi / k_directions;
  return {std::cos(angle), std::sin(angle)};
}

/// Σ_ij exp(−λ |a_i − a_j|) in one pass over the sorted values: each sum to the left decays from value to value.
double concentration(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double left = 0, sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) left = (left + 1) * std::exp(-k_decay * (values[i] - values[i - 1]));
    sum += 1 + 2 * left;
  }
  return sum;
}

/// The most frequent distance of the values; 0 when none is long enough.
double frequent_distance(const std::vector<double>& values) {
  constexpr double k_step_px = 0.1;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto size = static_cast<std::size_t>((*high - *low) / k_step_px) + 1;
  const auto first = static_cast<std::size_t>(k_least_length_px / k_step_px);
  constexpr std::size_t k_most = 100000;
  if (size <= first || size > k_most) return 0;
  std::vector<double> counts(size, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      counts[std::min(size - 1, static_cast<std::size_t>(std::abs(values[i] - values[j]) / k_step_px))] += 1;
  const int reach = static_cast<int>(4 * k_spread_px / k_step_px);
  double best = 0, length = 0;
  for (std::size_t at = first; at < size; ++at) {
    double density = 0;
    for (int k = -reach; k <= reach; ++k) {
      const auto other = static_cast<std::ptrdiff_t>(at) + k;
      // Points of one line have no distance; those nearer than half the least length are such.
      if (static_cast<double>(other) * k_step_px < k_least_length_px / 2 || other >= static_cast<std::ptrdiff_t>(size))
        continue;
      const double deviation = k * k_step_px / k_spread_px;
      density += counts[static_cast<std::size_t>(other)] * std::exp(-deviation * deviation / 2);
    }
    if (density <= best) continue;
    best = density;
    length = (static_cast<double>(at) + 0.5) * k_step_px;
  }
  return length;
}

/// Two vectors that span the lattice of a cloud of points, by Davis' and Peinecke's method: the two directions along
/// which the projected points are most concentrated, (1/n²) Σ_ij exp(−λ |a_i − a_j|), λ = 0.5 per pixel, and along each
/// of them the most frequent distance of the points projected along the other one, every distance counted as a normal
/// distribution of 1.5 pixels. Nothing for fewer than three points or when no distance exceeds 4 pixels.
/// Davis, 1979 (polarograms); Schulze 2005, section 7.2.2.
std::optional<std::array<Vec2, 2>> projection_lattice(const std::vector<Vec2>& points) {
  if (points.size() < 3) return std::nullopt;
  std::vector<double> values(points.size()), concentrations;
  for (int step = 0; step < k_directions; ++step) {
    const Vec2 q = direction(step);
    std::transform(points.begin(), points.end(), values.begin(), [&](Vec2 p) { return cross(q, p); });
    concentrations.push_back(concentration(values));
  }
  const auto first =
      static_cast<int>(std::max_element(concentrations.begin(), concentrations.end()) - concentrations.begin());
  int second = -1;
  for (int step = 0; step < k_directions; ++step) {
    const int turn = std::abs(step - first), apart = std::min(turn, k_directions - turn);
    if (apart >= k_least_turn && (second < 0 || concentrations[static_cast<std::size_t>(step)] >
                                                    concentrations[static_cast<std::size_t>(second)]))
      second = step;
  }
  const std::array<Vec2, 2> q = {direction(first), direction(second)};
  std::array<Vec2, 2> vectors;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec2 along = q[i], other = q[1 - i];
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](Vec2 p) { return cross(p, other) / cross(along, other); });
    const double length = frequent_distance(values);
    if (!(length > 0)) return std::nullopt;
    vectors[i] = length * along;
  }
  return vectors;
}

struct Basis {
  Vec2 a, b;
  double area() const { return std::abs(cross(a, b)); }
};

/// Gauss' reduction: the shortest basis of the same lattice, |a| ≤ |b|.
Basis reduced(Basis basis) {
  Vec2 a = basis.a, b = basis.b;
  if (norm(a) > norm(b)) std::swap(a, b);
  for (int round = 0; round < 64; ++round) {  // Each round shortens b at least by the factor √3.
    b = b - std::round(dot(a, b) / dot(a, a)) * a;
    if (norm(b) >= norm(a)) break;
    std::swap(a, b);
  }
  return {a, b};
}

/// The order and orientation of Lattice::vectors_px.
std::array<Vec2, 2> oriented(Basis basis) {
  const auto flatness = [](Vec2 v) { return std::abs(v.x) / norm(v); };
  if (flatness(basis.b) > flatness(basis.a)) std::swap(basis.a, basis.b);
  if (basis.a.x < 0) basis.a = -1.0 * basis.a;
  if (cross(basis.a, basis.b) < 0) basis.b = -1.0 * basis.b;
  return {basis.a, basis.b};
}

struct Node {
  int m, n;
  Vec2 t;
};

/// The nodes m·a + n·b of the half plane (n > 0, or n = 0 and m > 0) up to `radius`, within the map, nearest first.
std::vector<Node> lattice_nodes(const CorrelationMap& map, const Basis& basis, double radius, std::size_t most) {
  std::vector<Node> nodes;
  // |m a + n b| ≥ |m| · area / |b|, so these bounds miss no node.
  const int reach_m = static_cast<int>(std::min(1e4, radius * norm(basis.b) / basis.area()));
  const int reach_n = static_cast<int>(std::min(1e4, radius * norm(basis.a) / basis.area()));
  for (int n = 0; n <= reach_n; ++n)
    for (int m = n == 0 ? 1 : -reach_m; m <= reach_m; ++m) {
      const Vec2 t = static_cast<double>(m) * basis.a + static_cast<double>(n) * basis.b;
      if (norm(t) <= radius && map.contains(t)) nodes.push_back({m, n, t});
    }
  std::stable_sort(nodes.begin(), nodes.end(), [](const Node& p, const Node& q) { return norm(p.t) < norm(q.t); });
  if (nodes.size() > most) nodes.resize(most);
  return nodes;
}

double whole_radius(const CorrelationMap& map) { return std::hypot(map.reach_x(), map.reach_y()); }

/// How far nodes count.
double node_radius(const CorrelationMap& map, const Basis& basis, const LatticeOptions& options) {
  if (options.reach_cells <= 0) return whole_radius(map);
  // The four nearest nodes always.
  return std::min(whole_radius(map), std::max(options.reach_cells * std::sqrt(basis.area()),
                                              1.01 * std::max(norm(basis.a + basis.b), norm(basis.a - basis.b))));
}

/// Enough to distinguish a repetition from chance; an error of the basis moves near nodes least.
constexpr std::size_t k_scored_nodes = 40;

/// Mean correlation over the nearest nodes; −1 when fewer than three lie within the map.
double score(const CorrelationMap& map, const Basis& basis, const LatticeOptions& options) {
  const double radius = std::min(node_radius(map, basis, options), 6 * std::sqrt(basis.area()) + norm(basis.b));
  const std::vector<Node> nodes = lattice_nodes(map, basis, radius, k_scored_nodes);
  if (nodes.size() < 3) return -1;
  double sum = 0;
  for (const Node& node : nodes) sum += map.sample(node.t);
  return sum / static_cast<double>(nodes.size());
}

bool is_plausible(const Basis& basis) {
  constexpr double k_least_length = 2.5, k_least_sine = 0.15;
  return norm(basis.a) >= k_least_length && basis.area() >= k_least_sine * norm(basis.a) * norm(basis.b);
}

struct Peak {
  Vec2 t;
  double correlation;
};

std::vector<Peak> deepest_first(const CorrelationMap& map) {
  std::vector<Peak> peaks;
  for (const Vec2 t : map.peaks())
    if (map.contains(t)) peaks.push_back({t, map.sample(t)});
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const Peak& p, const Peak& q) { return p.correlation > q.correlation; });
  return peaks;
}

/// Whether the correlation dips on the way to a node.
bool dips_before(const CorrelationMap& map, Vec2 node) {
  constexpr double k_least_dip = 0.1;  // Of the correlation at the node.
  double lowest = map.sample(node);
  for (int k = 1; k < 16; ++k) lowest = std::min(lowest, map.sample((k / 16.0) * node));
  return lowest <= (1 - k_least_dip) * map.sample(node);
}

/// The smallest cell among the pairs of short good peaks whose nodes repeat nearly as well as those of the best pair.
std::optional<Basis> best_pair(const CorrelationMap& map, const std::vector<Peak>& peaks,
                               const LatticeOptions& options) {
  // In a lattice that bends, the two directions may repeat unequally well.
  const double tolerance = std::pow(options.node_tolerance, options.reach_cells > 0 ? 3 : 1);
  std::vector<Peak> good;
  for (const Peak& peak : peaks)
    if (peak.correlation >= tolerance * peaks.front().correlation && dips_before(map, peak.t)) good.push_back(peak);
  std::stable_sort(good.begin(), good.end(), [](const Peak& p, const Peak& q) { return norm(p.t) < norm(q.t); });
  if (good.size() > static_cast<std::size_t>(options.most_candidates))
    good.resize(static_cast<std::size_t>(options.most_candidates));

  std::vector<std::pair<Basis, double>> candidates;
  double best = 0;
  for (std::size_t i = 0; i < good.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Basis basis = reduced({good[i].t, good[j].t});
      if (!is_plausible(basis)) continue;
      candidates.emplace_back(basis, score(map, basis, options));
      best = std::max(best, candidates.back().second);
    }
  std::optional<Basis> chosen;
  for (const auto& [basis, quality] : candidates)
    if (quality > 0 && quality >= options.node_tolerance * best && (!chosen || basis.area() < chosen->area()))
      chosen = basis;
  return chosen;
}

/// Least squares fit of the basis to the peaks next to its nodes, over a growing neighbourhood.
Basis refined(const CorrelationMap& map, Basis basis, const LatticeOptions& options) {
  constexpr double k_growth = 1.6;
  constexpr double k_most_shift = 0.25;  // Of |a|: a peak further from its node belongs to another one.
  constexpr std::size_t k_most_nodes = 2000;
  for (double radius = 1.5 * norm(basis.b);; radius *= k_growth) {
    double mm = 0, mn = 0, nn = 0;
    Vec2 mt{}, nt{};
    for (const Node& node : lattice_nodes(map, basis, radius, k_most_nodes)) {
      const Vec2 peak = map.climb(node.t);
      if (peak == node.t || norm(peak - node.t) > k_most_shift * norm(basis.a)) continue;
      mm += node.m * node.m;
      mn += node.m * node.n;
      nn += node.n * node.n;
      mt = mt + static_cast<double>(node.m) * peak;
      nt = nt + static_cast<double>(node.n) * peak;
    }
    const double determinant = mm * nn - mn * mn;
    if (determinant > 0.5) {  // Integers: singular or at least 1.
      const Basis fitted{(1 / determinant) * (nn * mt - mn * nt), (1 / determinant) * (mm * nt - mn * mt)};
      if (is_plausible(reduced(fitted))) basis = fitted;
    }
    if (radius > node_radius(map, basis, options)) return reduced(basis);
  }
}

/// The lattices that hold `basis` as a sublattice of prime index p.
std::vector<Basis> finer_lattices(const Basis& basis, int p) {
  const double part = 1.0 / p;
  std::vector<Basis> finer = {{part * basis.a, basis.b}};
  for (int k = 0; k < p; ++k) finer.push_back({basis.a, part * (basis.b + static_cast<double>(k) * basis.a)});
  return finer;
}

/// The sublattices of prime index p.
std::vector<Basis> coarser_lattices(const Basis& basis, int p) {
  const double times = p;
  std::vector<Basis> coarser = {{times * basis.a, basis.b}};
  for (int k = 0; k < p; ++k) coarser.push_back({basis.a + static_cast<double>(k) * basis.b, times * basis.b});
  return coarser;
}

/// Sum, sum of squares and number of values.
struct Sample {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  double mean() const { return sum / count; }
  /// Variance of the mean.
  double variance() const { return std::max(0.0, squares / count - mean() * mean()) / std::max(1, count - 1); }
};

/// True when the nodes of `fine` that are no nodes of `coarse` repeat the picture as well as those that are: all but
/// `index_tolerance`, or what their scatter explains. Few near nodes of a bent lattice scatter enough to explain
/// anything.
bool repeats_on_finer(const CorrelationMap& map, const Basis& fine, const Basis& coarse, const LatticeOptions& options,
                      bool allow_scatter) {
  const double area = cross(coarse.a, coarse.b);
  const auto whole = [](double x) { return std::abs(x - std::round(x)) < 0.01; };
  Sample own, other;
  for (const Node& node : lattice_nodes(map, fine, node_radius(map, coarse, options), 400)) {
    const bool shared = whole(cross(node.t, coarse.b) / area) && whole(cross(coarse.a, node.t) / area);
    (shared ? own : other).add(map.sample(node.t));
  }
  // A few nodes of a lattice that bends say nothing about a coarser one.
  const int least = options.reach_cells > 0 && allow_scatter ? 6 : 2;
  if (own.count < least || other.count == 0 || own.sum <= 0) return true;
  constexpr double k_sure = 4;  // Standard errors.
  const double scatter = allow_scatter ? k_sure * std::sqrt(own.variance() + other.variance()) : 0;
  return other.mean() >= own.mean() - std::max((1 - options.index_tolerance) * own.mean(), scatter);
}

/// Replaces the basis by a finer lattice as long as all its new nodes repeat as well, and by a
/// coarser one where only that repeats fully.
Basis with_corrected_index(const CorrelationMap& map, Basis basis, const LatticeOptions& options) {
  constexpr int k_most_rounds = 8;
  const auto finer = [&]() -> std::optional<Basis> {
    for (const int p : {2, 3, 5})
      for (const Basis& candidate : finer_lattices(basis, p))
        if (is_plausible(reduced(candidate)) &&
            repeats_on_finer(map, reduced(candidate), basis, options, options.reach_cells <= 0))
          return refined(map, reduced(candidate), options);
    return std::nullopt;
  };
  const auto coarser = [&]() -> std::optional<Basis> {
    for (const int p : {2, 3, 5})
      for (const Basis& candidate : coarser_lattices(basis, p))
        if (!repeats_on_finer(map, basis, candidate, options, true)) return refined(map, reduced(candidate), options);
    return std::nullopt;
  };
  for (int round = 0; round < k_most_rounds; ++round) {
    const std::optional<Basis> next = finer();
    if (!next) break;
    basis = *next;
  }
  for (int round = 0; round < k_most_rounds; ++round) {
    const std::optional<Basis> next = coarser();
    if (!next) break;
    basis = *next;
  }
  return basis;
}

/// LatticeMethod::projection on the minima whose correlation is at least node_tolerance of the best one's, on both
/// sides of the origin.
std::optional<Basis> projected(const std::vector<Peak>& peaks, const LatticeOptions& options) {
  std::vector<Vec2> points = {{0, 0}};
  for (const Peak& peak : peaks) {
    if (peak.correlation < options.node_tolerance * peaks.front().correlation) continue;
    points.push_back(peak.t);
    points.push_back(-1.0 * peak.t);
  }
  const auto vectors = projection_lattice(points);
  if (!vectors) return std::nullopt;
  const Basis basis = reduced({(*vectors)[0], (*vectors)[1]});
  return is_plausible(basis) ? std::optional(basis) : std::nullopt;
}

std::optional<Basis> fitted(const CorrelationMap& map, const std::vector<Peak>& peaks, const LatticeOptions& options) {
  const std::optional<Basis> pair = best_pair(map, peaks, options);
  if (!pair) return std::nullopt;
  return with_corrected_index(map, refined(map, *pair, options), options);
}

/// Correlation at a node minus its mean over the cell around the node.
double contrast(const CorrelationMap& map, const Basis& basis, Vec2 node) {
  constexpr int k_samples = 8;
  double sum = 0;
  int count = 0;
  for (int j = 0; j < k_samples; ++j)
    for (int i = 0; i < k_samples; ++i) {
      const double u = (i + 0.5) / k_samples - 0.5, v = (j + 0.5) / k_samples - 0.5;
      const Vec2 t = node + u * basis.a + v * basis.b;
      if (!map.contains(t)) continue;
      sum += map.sample(t);
      ++count;
    }
  return count > 0 ? map.sample(node) - sum / count : 0;
}

/// See Lattice::significance. Pictures of more than 90 % pixel noise can't reach 1.
double significance(const CorrelationMap& map, const Basis& basis, const std::vector<Node>& nodes) {
  constexpr double k_least_signal = 0.1;
  if (nodes.empty()) return 0;
  double sum = 0;
  for (const Node& node : nodes) sum += contrast(map, basis, node.t);
  return std::max(0.0, sum / static_cast<double>(nodes.size()) / std::max(map.attainable(), k_least_signal));
}

/// Correlation along stripes: of the two shifts that span the cell, the better one. A lattice may be longer than the
/// map in one direction: that one says nothing.
double stripe_correlation(const CorrelationMap& map, const Basis& basis) {
  double best = 0;
  for (const Vec2 node : {basis.a, basis.b})
    if (map.contains(node)) best = std::max(best, map.sample(node));
  return std::min(best, 1.0);
}

/// True when the correlation does not dip on the way to some neighbouring node.
bool is_striped(const CorrelationMap& map, const Basis& basis) {
  for (const Vec2 node : {basis.a, basis.b, basis.a + basis.b, basis.a - basis.b})
    if (map.contains(node) && !dips_before(map, node)) return true;
  return false;
}

void require_input(const FeatureMatrix& matrix, const LatticeOptions& options) {
  const auto share = [](double value) { return value > 0 && value <= 1; };
  if (!share(options.least_significance) || !share(options.node_tolerance) || !share(options.index_tolerance) ||
      options.most_candidates < 2)
    throw InvalidInput("find_lattice: thresholds must be in (0, 1] and candidates at least 2");
  const std::size_t expected = matrix.reach_x < 0 || matrix.reach_y < 0 ? 0
                                                                        : static_cast<std::size_t>(matrix.width()) *
                                                                              static_cast<std::size_t>(matrix.height());
  const bool finite = std::all_of(matrix.distortion.begin(), matrix.distortion.end(),
                                  [](double value) { return std::isfinite(value) && value >= 0; });
  if (expected == 0 || matrix.distortion.size() != expected || !finite)
    throw InvalidInput("find_lattice: the feature matrix has a wrong size or values that are not finite");
}

}  // namespace

Lattice find_lattice(const FeatureMatrix& matrix, const LatticeOptions& options) {
  require_input(matrix, options);
  Lattice lattice;
  const CorrelationMap map(matrix);
  if (!map.usable()) {
    lattice.reason = "the picture is flat or smaller than 8 pixels";
    return lattice;
  }
  const std::vector<Peak> peaks = deepest_first(map);
  constexpr std::size_t k_reported_minima = 500;
  for (std::size_t i = 0; i < std::min(peaks.size(), k_reported_minima); ++i) lattice.minima.push_back(peaks[i].t);
  std::optional<Basis> found;
  if (!peaks.empty())
    found = options.method == LatticeMethod::projection ? projected(peaks, options) : fitted(map, peaks, options);
  if (!found) {
    lattice.reason = "no two shifts repeat the picture";
    return lattice;
  }
  const Basis basis = *found;
  const std::vector<Node> nodes = lattice_nodes(map, basis, node_radius(map, basis, options), 2000);
  lattice.nodes = static_cast<int>(nodes.size());
  lattice.significance = significance(map, basis, nodes);
  if (lattice.significance < options.least_significance) {
    lattice.reason = "the best lattice is not significant";
    return lattice;
  }
  if (is_striped(map, basis)) {
    lattice.stripes = stripe_correlation(map, basis);
    lattice.reason = "the picture repeats in one direction only";
    return lattice;
  }
  lattice.found = true;
  lattice.vectors_px = oriented(basis);
  lattice.reason = "the picture repeats at " + std::to_string(2 * lattice.nodes) + " shifts";
  return lattice;
}

}  // namespace papilla
