// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "evaluator.hpp"
#include "noise.hpp"
#include "papilla/core/cpu_clones.hpp"
#include "patterns.hpp"

namespace papilla::procedural_detail {

PAPILLA_CPU_CLONES("avx2")
static void root_row(double* row, int n) {
  for (int i = 0; i < n; ++i) row[i] = std::sqrt(row[i] > 0 ? row[i] : 0);
}

namespace {

/// Most points that a cell may hold.
constexpr int k_most_cell_points = 16;

enum class CellDistance { squared, manhattan, minkowski };

struct CellOptions {
  CellDistance distance = CellDistance::squared;
  double power_a = 1, power_b = 1;         ///< Of minkowski.
  int wanted = 1;                          ///< How many distances, 1 to 4.
  std::array<std::uint8_t, 256> counts{};  ///< Points of a cell by the low byte of its hash.
  double smooth = 0;                       ///< 1: all points in the middle of their cells.
  int displace_mode = 0;
  double displace = 0;
  double period_x = 0, period_y = 0;  ///< In cells, whole numbers; 0: does not repeat.
  std::uint32_t seed = 0;
};

/// A point near a texel.
struct CellHit {
  double x, y, dx, dy, id;
};

constexpr double k_beyond = 1e300;

struct Feature {
  double x, y, id;
};

double wrapped(double cell, double period) noexcept {
  return period > 0 ? cell - period * std::floor(cell / period) : cell;
}
std::uint32_t lattice(double cell) noexcept { return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell)); }

/// Shift of a whole cell's points, for honeycombs and the like.
void displacement(const CellOptions& o, std::uint32_t cx, std::uint32_t cy, std::uint32_t hash, double& dx,
                  double& dy) {
  const double odd_row = cy & 1U, odd_column = cx & 1U, chequer = (cx ^ cy) & 1U;
  switch (o.displace_mode) {
    case 1: dx = odd_row * o.displace; break;
    case 2: dy = odd_column * o.displace; break;
    case 3: dx = odd_row * o.displace, dy = odd_column * o.displace; break;
    case 4: dx = chequer * o.displace; break;
    case 5: dy = chequer * o.displace; break;
    case 6:
      dx = (unit_number(mix_bits(hash, 11, 7)) - 0.5) * o.displace;
      dy = (unit_number(mix_bits(hash, 13, 7)) - 0.5) * o.displace;
      break;
    default: break;
  }
}

int add_features(const CellOptions& o, double cell_x, double cell_y, Feature* out) {
  const std::uint32_t cx = lattice(wrapped(cell_x, o.period_x)), cy = lattice(wrapped(cell_y, o.period_y));
  const std::uint32_t hash = mix_bits(cx, cy, o.seed);
  const int count = o.counts[hash & 255U];
  double dx = 0, dy = 0;
  if (o.displace_mode != 0) displacement(o, cx, cy, hash, dx, dy);
  for (int k = 0; k < count; ++k) {
    const std::uint32_t a = mix_bits(hash, static_cast<std::uint32_t>(2 * k + 1), 0x51ED270BU);
    const std::uint32_t b = mix_bits(hash, static_cast<std::uint32_t>(2 * k + 2), 0x51ED270BU);
    const double px = unit_number(a), py = unit_number(b);
    out[k] = {cell_x + px + (0.5 - px) * o.smooth + dx, cell_y + py + (0.5 - py) * o.smooth + dy,
              unit_number(mix_bits(a, b, 3))};
  }
  return count;
}

template <CellDistance metric>
inline double distance_of(double dx, double dy, double a, double b) noexcept {
  if constexpr (metric == CellDistance::squared) return dx * dx + dy * dy;
  if constexpr (metric == CellDistance::manhattan) return std::abs(dx) + std::abs(dy);
  return std::pow(std::abs(dx), a) + std::pow(std::abs(dy), b);
}

/// Only for squared distances: a feature farther from the run's box than the wanted-th nearest can be is left out.
int prune(Feature* features, int count, double x0, double x1, double y0, double y1, int wanted) {
  if (count <= wanted) return count;
  double nearest[4] = {k_beyond, k_beyond, k_beyond, k_beyond};
  for (int k = 0; k < count; ++k) {
    const double dx = std::max(std::abs(features[k].x - x0), std::abs(features[k].x - x1));
    const double dy = std::max(std::abs(features[k].y - y0), std::abs(features[k].y - y1));
    const double farthest = dx * dx + dy * dy;
    if (farthest >= nearest[wanted - 1]) continue;
    int place = wanted - 1;
    for (; place > 0 && farthest < nearest[place - 1]; --place) nearest[place] = nearest[place - 1];
    nearest[place] = farthest;
  }
  const double reach = nearest[wanted - 1];
  int kept = 0;
  for (int k = 0; k < count; ++k) {
    const double dx = std::max({x0 - features[k].x, features[k].x - x1, 0.0});
    const double dy = std::max({y0 - features[k].y, features[k].y - y1, 0.0});
    if (dx * dx + dy * dy <= reach) features[kept++] = features[k];
  }
  return kept;
}

}  // namespace

// The two commonest cases, without branches so that they vectorise.
PAPILLA_CPU_CLONES("avx2")
static void nearest_run(const double* x, const double* y, int n, const double* fx, const double* fy, int count,
                        double* f1) {
  for (int k = 0; k < count; ++k) {
    const double px = fx[k], py = fy[k];
    for (int i = 0; i < n; ++i) {
      const double dx = px - x[i], dy = py - y[i], d = dx * dx + dy * dy;
      f1[i] = d < f1[i] ? d : f1[i];
    }
  }
}

PAPILLA_CPU_CLONES("avx2")
static void two_nearest_run(const double* x, const double* y, int n, const double* fx, const double* fy, int count,
                            double* f1, double* f2) {
  for (int k = 0; k < count; ++k) {
    const double px = fx[k], py = fy[k];
    for (int i = 0; i < n; ++i) {
      const double dx = px - x[i], dy = py - y[i], d = dx * dx + dy * dy;
      const double least = f1[i], larger = d > least ? d : least;
      f1[i] = d < least ? d : least;
      f2[i] = larger < f2[i] ? larger : f2[i];
    }
  }
}

namespace {

template <CellDistance metric>
void insert_run(const double* x, const double* y, int first, int last, int n, const CellOptions& o,
                const Feature* features, int count, double* const* distance, CellHit* hits) {
  for (int k = 0; k < count; ++k) {
    for (int i = first; i < last; ++i) {
      const double dx = features[k].x - x[i], dy = features[k].y - y[i];
      const double d = distance_of<metric>(dx, dy, o.power_a, o.power_b);
      int place = o.wanted;
      while (place > 0 && d < distance[place - 1][i]) --place;
      for (int j = o.wanted - 1; j > place; --j) {
        distance[j][i] = distance[j - 1][i];
        if (hits) hits[j * n + i] = hits[(j - 1) * n + i];
      }
      if (place == o.wanted) continue;
      distance[place][i] = d;
      if (hits) hits[place * n + i] = {features[k].x, features[k].y, dx, dy, features[k].id};
    }
  }
}

void visit_run(const double* x, const double* y, int first, int last, int n, const CellOptions& o, Feature* features,
               int count, double* const* distance, CellHit* hits) {
  if (o.distance == CellDistance::squared) {
    const auto [x0, x1] = std::minmax_element(x + first, x + last);
    const auto [y0, y1] = std::minmax_element(y + first, y + last);
    count = prune(features, count, *x0, *x1, *y0, *y1, o.wanted);
    if (!hits && o.wanted <= 2) {
      std::array<double, 25 * k_most_cell_points> fx, fy;
      for (int k = 0; k < count; ++k) {
        fx[static_cast<std::size_t>(k)] = features[k].x;
        fy[static_cast<std::size_t>(k)] = features[k].y;
      }
      if (o.wanted == 1)
        nearest_run(x + first, y + first, last - first, fx.data(), fy.data(), count, distance[0] + first);
      else
        two_nearest_run(x + first, y + first, last - first, fx.data(), fy.data(), count, distance[0] + first,
                        distance[1] + first);
      return;
    }
    insert_run<CellDistance::squared>(x, y, first, last, n, o, features, count, distance, hits);
  } else if (o.distance == CellDistance::manhattan) {
    insert_run<CellDistance::manhattan>(x, y, first, last, n, o, features, count, distance, hits);
  } else {
    insert_run<CellDistance::minkowski>(x, y, first, last, n, o, features, count, distance, hits);
  }
}

/// The points of the cells around one, five columns of five cells. Along a row only the next column is new.
class CellColumns {
 public:
  explicit CellColumns(const CellOptions& options) : options_(options) {}

  void move_to(double cx, double cy) {
    if (filled_ && cx == cx_ && cy == cy_) return;
    const bool next = filled_ && cx == cx_ + 1 && cy == cy_;
    cx_ = cx, cy_ = cy, filled_ = true;
    if (next) {
      first_ = (first_ + 1) % 5;
      fill(4);
    } else {
      for (int column = 0; column < 5; ++column) fill(column);
    }
  }

  int collect(Feature* out) const {
    int count = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      std::copy_n(points_[k].begin(), counts_[k], out + count);
      count += counts_[k];
    }
    return count;
  }

 private:
  void fill(int column) {
    const auto slot = static_cast<std::size_t>((first_ + column) % 5);
    int count = 0;
    for (int row = -2; row <= 2; ++row)
      count += add_features(options_, cx_ + column - 2, cy_ + row, points_[slot].data() + count);
    counts_[slot] = count;
  }

  const CellOptions& options_;
  std::array<std::array<Feature, 5 * k_most_cell_points>, 5> points_;
  std::array<int, 5> counts_{};
  int first_ = 0;  ///< The slot of the leftmost column.
  double cx_ = 0, cy_ = 0;
  bool filled_ = false;
};

/// Distances to the nearest points of Worley's cells of side 1.
/// distance[k][i], k < wanted, ascending in k, no larger than on entry.
/// @param hits  null, or wanted x n entries for the nearest points, hits[k * n + i].
/// Looks at the cell and its two rings, and so finds all points up to one cell away plus the part within the cell.
/// Cost: points are made once a cell and run, then wanted comparisons a point and texel.
void cell_row(const double* raw_x, const double* raw_y, int n, const CellOptions& o, double* const* distance,
              CellHit* hits) {
  std::vector<double> coordinates(static_cast<std::size_t>(2 * n));
  double* const x = coordinates.data();
  double* const y = x + n;
  for (int i = 0; i < n; ++i) x[i] = clamp_coordinate(raw_x[i]), y[i] = clamp_coordinate(raw_y[i]);
  CellColumns columns(o);
  std::array<Feature, 25 * k_most_cell_points> features;
  for (int first = 0, last = 0; first < n; first = last) {
    const double cx = std::floor(x[first]), cy = std::floor(y[first]);
    for (last = first + 1; last < n && x[last] >= cx && x[last] < cx + 1 && y[last] >= cy && y[last] < cy + 1;) ++last;
    columns.move_to(cx, cy);
    const int count = columns.collect(features.data());
    visit_run(x, y, first, last, n, o, features.data(), count, distance, hits);
  }
}

constexpr int k_most_distances = 4;
constexpr double k_infinite = 1e30;
/// Information numbers that each of the nearest points gets.
constexpr int k_infos_of_point = 6;

/// Poisson's distribution with mean 4, as Worley's table of 256 entries has it, in shuffled order.
double worley_count(int index) {
  const double share = (((index * 167 + 13) & 255) + 0.5) / 256;
  double term = std::exp(-4.0), sum = term;
  int count = 0;
  while (sum < share) sum += term *= 4.0 / ++count;
  return std::max(1, count);
}

int distances_wanted(const TypeArguments& arguments) {
  int wanted = 1;
  if (arguments.mentions("f2")) wanted = 2;
  if (arguments.mentions("f3")) wanted = 3;
  if (arguments.mentions("f4") || arguments.mentions("get") || arguments.flag("random")) wanted = 4;
  return wanted;
}

/// Applied to the distances of the metric: root, inverse, func or a random combination.
class Combination {
 public:
  Combination(TypeArguments& arguments, bool random)
      : rooted_(arguments.flag("rooted")),
        inverse_(arguments.flag("inversedistance")),
        func_(arguments.formula("func")),
        random_(random) {
    for (std::uint32_t k = 0; k < k_most_distances; ++k)
      share_[k] = 2 * unit_number(mix_bits(k, arguments.seed(), 77)) - 1;
    const std::string text = arguments.text("func");
    if (text == "f1") plain_ = true;
  }

  void apply(const PatternRow& row, double (*distance)[k_row], int wanted) const {
    for (int k = 0; k < wanted; ++k) {
      for (int i = 0; i < row.n; ++i) distance[k][i] = std::min(distance[k][i], k_infinite);
      if (rooted_) root_row(distance[k], row.n);
      if (!inverse_) continue;
      for (int i = 0; i < row.n; ++i) distance[k][i] = 1 / (1 + std::max(0.0, distance[k][i]));
    }
    if (random_) {
      for (int i = 0; i < row.n; ++i) {
        row.out[i] = 0;
        for (int k = 0; k < wanted; ++k) row.out[i] += share_[static_cast<std::size_t>(k)] * distance[k][i];
      }
    } else if (plain_) {
      std::copy_n(distance[0], row.n, row.out);
    } else {
      std::array<const double*, k_most_distances> f{};
      for (int k = 0; k < wanted; ++k) f[static_cast<std::size_t>(k)] = distance[k];
      row.evaluator->run_on_distances(func_, f.data(), wanted, row.n, row.out);
    }
  }

  /// apply() to the variables d0, d1, … of a shader.
  void write_shader(PatternShader& shader, int wanted) const {
    std::vector<std::string> distances;
    for (int k = 0; k < wanted; ++k) {
      distances.push_back("d" + std::to_string(k));
      const ShaderValues values{{"d", distances.back()}};
      shader.add("$d = min($d, 1.0e30);\n", values);
      if (rooted_) shader.add("$d = sqrt(max($d, 0.0));\n", values);
      if (inverse_) shader.add("$d = 1.0 / (1.0 + max(0.0, $d));\n", values);
    }
    if (random_) {
      shader.add("$out = 0.0;\n");
      for (std::size_t k = 0; k < distances.size(); ++k)
        shader.add("$out = $out + $share * $d;\n", {{"share", share_[k]}, {"d", distances[k]}});
    } else {
      shader.add("$out = $value;\n", {{"value", plain_ ? distances[0] : shader.formula(func_, distances)}});
    }
  }

 private:
  bool rooted_, inverse_;
  Program func_;
  bool random_, plain_ = false;
  std::array<double, k_most_distances> share_{};
};

/// An expression of dx and dy.
std::string metric_shader(CellDistance metric, double a, double b, const std::string& dx, const std::string& dy) {
  const auto power = [](const std::string& d, double p) {
    return "k_power(abs(" + d + "), " + ShaderValue(p).text + ")";
  };
  switch (metric) {
    case CellDistance::squared: return dx + " * " + dx + " + " + dy + " * " + dy;
    case CellDistance::manhattan: return "abs(" + dx + ") + abs(" + dy + ")";
    case CellDistance::minkowski: break;
  }
  return power(dx, a) + " + " + power(dy, b);
}

/// The nearest of the points that were met, in order of their distances, in private variables of the texture: distance,
/// place, difference and number of the point, four each.
constexpr std::string_view k_met_points = R"(
float $tdistance[4];
float $tplace_x[4];
float $tplace_y[4];
float $tdiffer_x[4];
float $tdiffer_y[4];
float $tnumber[4];
void $tmeet(float d, float px, float py, float dx, float dy, float number) {
int place = $wanted;
for (int k = $wanted - 1; k >= 0; --k) {
if (d < $tdistance[k]) {
place = k;
}
}
for (int j = $wanted - 1; j > place; --j) {
$tdistance[j] = $tdistance[j - 1];
$tplace_x[j] = $tplace_x[j - 1];
$tplace_y[j] = $tplace_y[j - 1];
$tdiffer_x[j] = $tdiffer_x[j - 1];
$tdiffer_y[j] = $tdiffer_y[j - 1];
$tnumber[j] = $tnumber[j - 1];
}
if (place < $wanted) {
$tdistance[place] = d;
$tplace_x[place] = px;
$tplace_y[place] = py;
$tdiffer_x[place] = dx;
$tdiffer_y[place] = dy;
$tnumber[place] = number;
}
}
)";

/// Meets all points of the cells about a place, as cell_row() does.
constexpr std::string_view k_meet_cells = R"(
void $tcells(float px, float py, float period_x, float period_y, uint seed) {
float home_x = floor(px);
float home_y = floor(py);
for (int q = -2; q <= 2; ++q) {
for (int p = -2; p <= 2; ++p) {
float cell_x = home_x + float(p);
float cell_y = home_y + float(q);
uint cx = lattice(wrap(cell_x, period_x));
uint cy = lattice(wrap(cell_y, period_y));
uint hash = mix_bits(cx, cy, seed);
float move_x = 0.0;
float move_y = 0.0;
$displacement
int count = int(($tcounts[int((hash & 255u) >> 2u)] >> ((hash & 3u) * 8u)) & 255u);
for (int k = 0; k < count; ++k) {
uint a = mix_bits(hash, uint(2 * k + 1), 0x51ED270Bu);
uint b = mix_bits(hash, uint(2 * k + 2), 0x51ED270Bu);
float sx = unit_number(a);
float sy = unit_number(b);
float fx = sx + (0.5 - sx) * $smooth + move_x;
float fy = sy + (0.5 - sy) * $smooth + move_y;
float dx = float(p) + fx - (px - home_x);
float dy = float(q) + fy - (py - home_y);
$tmeet($metric, cell_x + fx, cell_y + fy, dx, dy, unit_number(mix_bits(a, b, 3u)));
}
}
}
}
)";

constexpr std::string_view k_displacements[] = {
    "",
    "move_x = float(cy & 1u) * $displace;",
    "move_y = float(cx & 1u) * $displace;",
    "move_x = float(cy & 1u) * $displace;\nmove_y = float(cx & 1u) * $displace;",
    "move_x = float((cx ^ cy) & 1u) * $displace;",
    "move_y = float((cx ^ cy) & 1u) * $displace;",
    "move_x = (unit_number(mix_bits(hash, 11u, 7u)) - 0.5) * $displace;\n"
    "move_y = (unit_number(mix_bits(hash, 13u, 7u)) - 0.5) * $displace;"};

CellDistance metric_of(const TypeArguments& arguments) {
  constexpr CellDistance metrics[] = {CellDistance::squared, CellDistance::manhattan, CellDistance::minkowski};
  return metrics[arguments.integer("distmode")];
}

void keep_point(const PatternRow& row, int rank, int i, double x, double y, double dx, double dy, double distance,
                double id) {
  if (rank == 0) row.id[i] = id;
  if ((rank + 1) * k_infos_of_point > k_infos) return;
  const double infos[k_infos_of_point] = {x, y, dx, dy, distance, id};
  for (int k = 0; k < k_infos_of_point; ++k) row.info[(rank * k_infos_of_point + k) * k_row + i] = infos[k];
}

class Voronoi final : public Pattern {
 public:
  explicit Voronoi(TypeArguments& arguments)
      : combination_(arguments, arguments.flag("random")),
        octaves_(arguments.integer("octaves")),
        lacunarity_(arguments.number("lacunarity")),
        sponge_(arguments.integer("cell_initmode")),
        sponge_power_(arguments.number("initpower")),
        seed_(arguments.seed()),
        needs_points_(arguments.mentions("get") || arguments.mentions("get0") || arguments.mentions("get1") ||
                      arguments.mentions("id")) {
    cells_.distance = metric_of(arguments);
    cells_.power_a = arguments.number("distmodea"), cells_.power_b = arguments.number("distmodeb");
    cells_.wanted = distances_wanted(arguments);
    cells_.smooth = arguments.number("smooth");
    cells_.displace_mode = arguments.integer("displacemode"),
    cells_.displace = std::clamp(arguments.number("displace"), -1.0, 1.0);
    weights_ = numbers_of(arguments, "weights");
    for (int k = static_cast<int>(weights_.size()); k < octaves_; ++k) weights_.push_back(std::pow(lacunarity_, -k));
    fill_counts(arguments);
  }

  void evaluate(const PatternRow& row) const override {
    double sum[k_most_distances][k_row], distance[k_most_distances][k_row], x[k_row], y[k_row];
    double* rows[k_most_distances] = {distance[0], distance[1], distance[2], distance[3]};
    std::vector<CellHit> hits(needs_points_ ? static_cast<std::size_t>(cells_.wanted * row.n) : 0);
    CellOptions cells = cells_;
    for (int k = 0; k < cells.wanted; ++k) std::fill_n(sum[k], row.n, 0.0);
    for (int octave = 0; octave < octaves_; ++octave) {
      const double wanted = k_cells * std::pow(lacunarity_, octave);
      const double fx = fitted(wanted, row.period_x), fy = fitted(wanted, row.period_y);
      cells.period_x = std::round(fx * row.period_x), cells.period_y = std::round(fy * row.period_y);
      cells.seed = mix_bits(seed_, static_cast<std::uint32_t>(octave), 53);
      for (int i = 0; i < row.n; ++i) x[i] = row.x[i] * fx, y[i] = row.y[i] * fy;
      for (int k = 0; k < cells.wanted; ++k)
        for (int i = 0; i < row.n; ++i) distance[k][i] = octave == 0 ? k_infinite : first_distance(distance[k][i]);
      cell_row(x, y, row.n, cells, rows, needs_points_ && octave == 0 ? hits.data() : nullptr);
      for (int k = 0; k < cells.wanted; ++k)
        for (int i = 0; i < row.n; ++i)
          sum[k][i] += weights_[static_cast<std::size_t>(octave)] * std::min(distance[k][i], k_infinite);
    }
    if (needs_points_)
      for (int k = 0; k < cells.wanted; ++k)
        for (int i = 0; i < row.n; ++i) {
          const CellHit& hit = hits[static_cast<std::size_t>(k * row.n + i)];
          keep_point(row, k, i, hit.x / k_cells, hit.y / k_cells, hit.dx / k_cells, hit.dy / k_cells, sum[k][i],
                     hit.id);
        }
    combination_.apply(row, sum, cells.wanted);
  }

  void write_shader(PatternShader& shader) const override {
    std::vector<ShaderValue> counts;
    for (std::size_t k = 0; k < cells_.counts.size(); k += 4)
      counts.emplace_back(static_cast<std::uint32_t>(cells_.counts[k] | cells_.counts[k + 1] << 8 |
                                                     cells_.counts[k + 2] << 16 | cells_.counts[k + 3] << 24));
    shader.add_array("$tcounts", "uint", counts);
    const ShaderValues values{
        {"displacement", std::string(k_displacements[static_cast<std::size_t>(cells_.displace_mode)])},
        {"displace", cells_.displace},
        {"wanted", cells_.wanted},
        {"smooth", cells_.smooth},
        {"metric", metric_shader(cells_.distance, cells_.power_a, cells_.power_b, "dx", "dy")}};
    shader.add_function(k_met_points, values);
    shader.add_function(k_meet_cells, values);
    for (int octave = 0; octave < octaves_; ++octave) {
      const double wanted = k_cells * std::pow(lacunarity_, octave);
      const double fx = fitted(wanted, shader.period_x), fy = fitted(wanted, shader.period_y);
      for (int k = 0; k < cells_.wanted; ++k)
        shader.add(octave == 0 ? "$tdistance[$k] = 1.0e30;\n" : "$tdistance[$k] = $first;\n",
                   {{"k", k}, {"first", first_distance_shader("$tdistance[" + std::to_string(k) + "]")}});
      shader.add("$tcells($x * $fx, $y * $fy, $period_x, $period_y, $seed);\n",
                 {{"fx", fx},
                  {"fy", fy},
                  {"period_x", std::round(fx * shader.period_x)},
                  {"period_y", std::round(fy * shader.period_y)},
                  {"seed", mix_bits(seed_, static_cast<std::uint32_t>(octave), 53)}});
      for (int k = 0; k < cells_.wanted; ++k) {
        const ShaderValues sum{
            {"d", "d" + std::to_string(k)}, {"k", k}, {"w", weights_[static_cast<std::size_t>(octave)]}};
        shader.add(octave == 0 ? "float $d = $w * min($tdistance[$k], 1.0e30);\n"
                               : "$d = $d + $w * min($tdistance[$k], 1.0e30);\n",
                   sum);
        if (octave == 0 && needs_points_) write_point(shader, k);
      }
    }
    if (needs_points_)
      for (int k = 0; k < cells_.wanted; ++k) shader.set_info(k * k_infos_of_point + 4, "d" + std::to_string(k));
    combination_.write_shader(shader, cells_.wanted);
  }

 private:
  /// keep_point() but the distance.
  static void write_point(PatternShader& shader, int k) {
    const std::string index = "[" + std::to_string(k) + "]";
    if (k == 0) shader.add("$id = $tnumber[0];\n");
    const char* names[] = {"$tplace_x", "$tplace_y", "$tdiffer_x", "$tdiffer_y"};
    for (int n = 0; n < 4; ++n)
      shader.set_info(k * k_infos_of_point + n, names[n] + index + " / " + ShaderValue(k_cells).text);
    shader.set_info(k * k_infos_of_point + 5, "$tnumber" + index);
  }

  std::string first_distance_shader(const std::string& last) const {
    const std::string p = ShaderValue(sponge_power_).text;
    switch (sponge_) {
      case 1: return "k_power(max(0.0, " + last + "), " + p + ")";
      case 2: return last + " * " + p;
      case 3: return last + " + " + p;
      case 4: return p;
      default: return "1.0e30";
    }
  }

  double first_distance(double last) const {
    switch (sponge_) {
      case 1: return std::pow(std::max(0.0, last), sponge_power_);
      case 2: return last * sponge_power_;
      case 3: return last + sponge_power_;
      case 4: return sponge_power_;
      default: return k_infinite;
    }
  }

  void fill_counts(TypeArguments& arguments) {
    const Program density = arguments.formula("densityfunc");
    double orig[k_row], index[k_row], out[k_row];
    for (int i = 0; i < k_row; ++i) orig[i] = worley_count(i), index[i] = i;
    const double* f[2] = {orig, index};
    Evaluator(arguments.graph()).run_on_distances(density, f, 2, k_row, out);
    for (std::size_t i = 0; i < k_row; ++i)
      cells_.counts[i] =
          static_cast<std::uint8_t>(std::clamp(std::round(out[i]), 0.0, static_cast<double>(k_most_cell_points)));
  }

  Combination combination_;
  int octaves_;
  double lacunarity_;
  int sponge_;
  double sponge_power_;
  std::uint32_t seed_;
  bool needs_points_;
  CellOptions cells_;
  std::vector<double> weights_;
};

struct Site {
  double x, y, id;
};

double wrapped_difference(double d) { return d - std::round(d); }

/// Points in the unit square that repel each other like equal charges on the torus.
std::vector<Site> repelled_points(int count, int iterations, std::uint32_t seed) {
  std::vector<Site> sites(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < sites.size(); ++k) {
    const auto n = static_cast<std::uint32_t>(k);
    sites[k] = {unit_number(mix_bits(n, 1, seed)), unit_number(mix_bits(n, 2, seed)),
                unit_number(mix_bits(n, 3, seed))};
  }
  const double stride = 0.1 / count;
  for (int step = 0; step < iterations; ++step) {
    std::vector<Site> moved = sites;
    for (std::size_t i = 0; i < sites.size(); ++i) {
      double fx = 0, fy = 0;
      for (std::size_t j = 0; j < sites.size(); ++j) {
        if (i == j) continue;
        const double dx = wrapped_difference(sites[i].x - sites[j].x), dy = wrapped_difference(sites[i].y - sites[j].y);
        const double r2 = dx * dx + dy * dy + 1e-6, force = 1 / (r2 * std::sqrt(r2));
        fx += dx * force, fy += dy * force;
      }
      const double length = std::hypot(fx, fy);
      if (length <= 0) continue;
      const double reach = std::min(stride, length * stride * stride);
      moved[i].x += fx / length * reach, moved[i].y += fy / length * reach;
      moved[i].x -= std::floor(moved[i].x), moved[i].y -= std::floor(moved[i].y);
    }
    sites = std::move(moved);
  }
  return sites;
}

class SeamlessVoronoi final : public Pattern {
 public:
  explicit SeamlessVoronoi(TypeArguments& arguments)
      : combination_(arguments, false),
        metric_(metric_of(arguments)),
        a_(arguments.number("distmodea")),
        b_(arguments.number("distmodeb")),
        wanted_(arguments.mentions("f4") || arguments.mentions("get") ? 4
                : arguments.mentions("f3")                            ? 3
                : arguments.mentions("f2")                            ? 2
                                                                      : 1),
        sites_(repelled_points(arguments.integer("points"), arguments.integer("smoothiterations"), arguments.seed())) {}

  void evaluate(const PatternRow& row) const override {
    double distance[k_most_distances][k_row];
    // Distances in mean spacings, so that the number of points does not change the range.
    const double spacing = std::sqrt(static_cast<double>(sites_.size()));
    const double fx = fitted(1, row.period_x), fy = fitted(1, row.period_y);
    for (int i = 0; i < row.n; ++i) {
      const double x = row.x[i] * fx - std::floor(row.x[i] * fx), y = row.y[i] * fy - std::floor(row.y[i] * fy);
      for (int k = 0; k < wanted_; ++k) distance[k][i] = k_infinite;
      for (const Site& site : sites_) {
        const double dx = wrapped_difference(site.x - x), dy = wrapped_difference(site.y - y);
        const double d = measure(dx * spacing, dy * spacing);
        int place = wanted_;
        while (place > 0 && d < distance[place - 1][i]) --place;
        if (place == wanted_) continue;
        for (int j = wanted_ - 1; j > place; --j) {
          distance[j][i] = distance[j - 1][i];
          for (int m = 0; m < k_infos_of_point; ++m)
            row.info[(j * 6 + m) * k_row + i] = row.info[((j - 1) * 6 + m) * k_row + i];
        }
        distance[place][i] = d;
        keep_point(row, place, i, site.x, site.y, dx, dy, d, site.id);
      }
    }
    combination_.apply(row, distance, wanted_);
  }

  void write_shader(PatternShader& shader) const override {
    std::vector<ShaderValue> sites;
    for (const Site& site : sites_)
      for (const double v : {site.x, site.y, site.id}) sites.emplace_back(v);
    shader.add_array("$tsites", "float", sites);
    const double spacing = std::sqrt(static_cast<double>(sites_.size()));
    const std::string scale = ShaderValue(spacing).text;
    const ShaderValues values{
        {"wanted", wanted_},
        {"count", static_cast<int>(sites_.size())},
        {"fx", fitted(1, shader.period_x)},
        {"fy", fitted(1, shader.period_y)},
        {"metric", metric_shader(metric_, a_, b_, "(dx * " + scale + ")", "(dy * " + scale + ")")}};
    shader.add_function(k_met_points, values);
    for (int k = 0; k < wanted_; ++k) shader.add("$tdistance[$k] = 1.0e30;\n", {{"k", k}});
    shader.add(R"(
float px = fract_of($x * $fx);
float py = fract_of($y * $fy);
for (int k = 0; k < $count; ++k) {
float site_x = $tsites[3 * k];
float site_y = $tsites[3 * k + 1];
float dx = site_x - px;
float dy = site_y - py;
dx = dx - floor(dx + 0.5);
dy = dy - floor(dy + 0.5);
$tmeet($metric, site_x, site_y, dx, dy, $tsites[3 * k + 2]);
}
$id = $tnumber[0];
)",
               values);
    for (int k = 0; k < wanted_; ++k) {
      const char* names[] = {"$tplace_x", "$tplace_y", "$tdiffer_x", "$tdiffer_y", "$tdistance", "$tnumber"};
      for (int n = 0; n < k_infos_of_point; ++n)
        shader.set_info(k * k_infos_of_point + n, names[n] + ("[" + std::to_string(k) + "]"));
      shader.add("float d$k = $tdistance[$k];\n", {{"k", k}});
    }
    combination_.write_shader(shader, wanted_);
  }

 private:
  double measure(double dx, double dy) const {
    switch (metric_) {
      case CellDistance::squared: return dx * dx + dy * dy;
      case CellDistance::manhattan: return std::abs(dx) + std::abs(dy);
      case CellDistance::minkowski: break;
    }
    return std::pow(std::abs(dx), a_) + std::pow(std::abs(dy), b_);
  }

  Combination combination_;
  CellDistance metric_;
  double a_, b_;
  int wanted_;
  std::vector<Site> sites_;
};

}  // namespace

std::unique_ptr<Pattern> make_cell_pattern(std::string_view type, TypeArguments& arguments) {
  if (type == "voronoi") return std::make_unique<Voronoi>(arguments);
  if (type == "voronoiseamless") return std::make_unique<SeamlessVoronoi>(arguments);
  return nullptr;
}

}  // namespace papilla::procedural_detail
