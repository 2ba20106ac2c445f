// SPDX-License-Identifier: MIT
#include "cell_points.hpp"

#include <algorithm>
#include <vector>

#include "evaluator.hpp"
#include "noise.hpp"
#include "papilla/core/cpu_clones.hpp"

namespace papilla::procedural_detail {
namespace {

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

}  // namespace

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

}  // namespace papilla::procedural_detail
