// SPDX-License-Identifier: MIT
#include "papilla/texture/slope_limit.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "checks.hpp"
#include "papilla/core/cpu_clones.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

/// Without norm()'s care for overflow, which took a fifth of a grain's time: slopes are far from 1e150.
double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

/// The rows of a relief: what lies next to a sample, and work on all threads.
class Grid {
 public:
  explicit Grid(const HeightMap& map)
      : per_x(1 / map.pitch_mm_x),
        per_y(1 / map.pitch_mm_y),
        columns(static_cast<std::size_t>(map.width)),
        rows(static_cast<std::size_t>(map.height)),
        wraps_x_(map.periodic && map.width > 1),
        wraps_y_(map.periodic && map.height > 1) {}

  /// Bound of the squared norm of the differences.
  double norm2() const { return 4 * (per_x * per_x + per_y * per_y); }

  /// The sample behind the last one of a row: the first, or the last itself, so that there is no slope.
  std::size_t behind_last() const { return wraps_x_ ? 0 : columns - 1; }
  bool wraps_x() const { return wraps_x_; }
  std::size_t below(std::size_t row) const { return row + 1 < rows ? row + 1 : wraps_y_ ? 0 : row; }
  /// `rows` when there is none.
  std::size_t above(std::size_t row) const { return row > 0 ? row - 1 : wraps_y_ ? rows - 1 : rows; }

  /// Calls work(row, its first sample) for every row, on all threads.
  template <class Work>
  void each_row(const Work& work) const {
    oneapi::tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) { work(row, row * columns); });
  }

  const double per_x, per_y;
  const std::size_t columns, rows;

 private:
  bool wraps_x_, wraps_y_;
};

struct Steepness {
  double largest = 0;
  std::size_t above = 0;  ///< Samples that are steeper than the limit.
};

Steepness steepness(const Grid& grid, const std::vector<double>& u, double limit) {
  std::vector<Steepness> rows(grid.rows);
  grid.each_row([&](std::size_t row, std::size_t first) {
    const double *here = &u[first], *below = &u[grid.below(row) * grid.columns];
    for (std::size_t x = 0; x < grid.columns; ++x) {
      const double right = here[x + 1 < grid.columns ? x + 1 : grid.behind_last()];
      const double slope = length_of(grid.per_x * (right - here[x]), grid.per_y * (below[x] - here[x]));
      rows[row].largest = std::max(rows[row].largest, slope);
      rows[row].above += slope > limit;
    }
  });
  Steepness all;
  for (const Steepness& row : rows) all = {std::max(all.largest, row.largest), all.above + row.above};
  return all;
}

/// A vector a sample.
struct Field {
  explicit Field(std::size_t samples) : x(samples), y(samples) {}
  std::vector<double> x, y;
};

struct Rates {
  double per_x, per_y, rate, threshold, ahead;
};

/// Of the first n samples of a row, whose right neighbours are the next samples: shrinks the flow q + rate ∇u to its
/// new p and extrapolates q. @param squares  |∇u|². @param beyond  (q − p′) · (p′ − p), p′ the new flow.
PAPILLA_CPU_CLONES("avx2")
void shrink(std::size_t n, const Rates& by, const double* u, const double* right, const double* below,
            double* __restrict px, double* __restrict py, double* __restrict qx, double* __restrict qy,
            double* __restrict squares, double* __restrict beyond) {
  const Rates r = by;
  for (std::size_t i = 0; i < n; ++i) {
    const double slope_x = r.per_x * (right[i] - u[i]), slope_y = r.per_y * (below[i] - u[i]);
    squares[i] = slope_x * slope_x + slope_y * slope_y;
    const double wanted_x = qx[i] + r.rate * slope_x, wanted_y = qy[i] + r.rate * slope_y;
    const double part = 1 - r.threshold / length_of(wanted_x, wanted_y);  // Minus infinity where nothing is wanted.
    const double kept = part > 0 ? part : 0;
    const double next_x = kept * wanted_x, next_y = kept * wanted_y;
    beyond[i] = (qx[i] - next_x) * (next_x - px[i]) + (qy[i] - next_y) * (next_y - py[i]);
    qx[i] = next_x + r.ahead * (next_x - px[i]);
    qy[i] = next_y + r.ahead * (next_y - py[i]);
    px[i] = next_x;
    py[i] = next_y;
  }
}

/// u = h − div* q of n samples, whose left neighbours are the samples before.
PAPILLA_CPU_CLONES("avx2")
void diverge(std::size_t n, double per_x, double per_y, const double* h, const double* qx, const double* left,
             const double* qy, const double* above, double* __restrict u) {
  for (std::size_t i = 0; i < n; ++i)
    u[i] = h[i] - (-per_x * qx[i] - per_y * qy[i] + per_x * left[i] + per_y * above[i]);
}

/// The state of the iteration: the flow p, its extrapolation q, and u = h − div* q.
class Shrinkage {
 public:
  Shrinkage(const Grid& grid, const std::vector<double>& h, double limit)
      : grid_(grid), h_(h), limit_(limit), p_(h.size()), q_(h.size()), u_(h), nothing_(grid.columns) {}

  /// First half of a step: the flow that follows from u, which stays. @return the largest slope of u.
  double flow() {
    const double rate = 1 / grid_.norm2();
    const double grown = 0.5 * (1 + std::sqrt(1 + 4 * momentum_ * momentum_));
    const Rates rates{grid_.per_x, grid_.per_y, rate, rate * limit_, (momentum_ - 1) / grown};
    std::vector<double> overshoot(grid_.rows), largest(grid_.rows);
    grid_.each_row([&](std::size_t row, std::size_t first) {
      thread_local std::vector<double> squares, beyond;
      squares.resize(grid_.columns);
      beyond.resize(grid_.columns);
      const std::size_t below = grid_.below(row) * grid_.columns, last = grid_.columns - 1;
      const auto part = [&](std::size_t begin, std::size_t count, const double* right) {
        const std::size_t i = first + begin;
        shrink(count, rates, &u_[i], right, &u_[below + begin], &p_.x[i], &p_.y[i], &q_.x[i], &q_.y[i], &squares[begin],
               &beyond[begin]);
      };
      if (last > 0) part(0, last, &u_[first + 1]);
      part(last, 1, &u_[first + grid_.behind_last()]);
      largest[row] = *std::max_element(squares.begin(), squares.end());
      overshoot[row] = std::accumulate(beyond.begin(), beyond.end(), 0.0);
    });
    momentum_ = grown;
    if (std::accumulate(overshoot.begin(), overshoot.end(), 0.0) > 0) {
      momentum_ = 1;
      q_ = p_;
    }
    return std::sqrt(*std::max_element(largest.begin(), largest.end()));
  }

  /// Second half: u of that flow, which is zero where a sample has no neighbour to the right or below.
  void move() {
    grid_.each_row([&](std::size_t row, std::size_t first) {
      const std::size_t above = grid_.above(row);
      const double* flow_above = above < grid_.rows ? &q_.y[above * grid_.columns] : nothing_.data();
      const auto part = [&](std::size_t begin, std::size_t count, const double* left) {
        const std::size_t i = first + begin;
        diverge(count, grid_.per_x, grid_.per_y, &h_[i], &q_.x[i], left, &q_.y[i], flow_above + begin, &u_[i]);
      };
      part(0, 1, grid_.wraps_x() ? &q_.x[first + grid_.columns - 1] : nothing_.data());
      if (grid_.columns > 1) part(1, grid_.columns - 1, &q_.x[first]);
    });
  }

  const std::vector<double>& u() const { return u_; }

 private:
  const Grid& grid_;
  const std::vector<double>& h_;
  double limit_, momentum_ = 1;
  Field p_, q_;
  std::vector<double> u_, nothing_;
};

void require_options(const SlopeLimitOptions& options) {
  if (!is_positive(options.max_slope)) throw InvalidInput("limit_slope: max_slope must be > 0");
  if (!(options.relative_tolerance > 0 && options.relative_tolerance < 1))
    throw InvalidInput("limit_slope: relative_tolerance must be between 0 and 1");
  if (options.iterations < 1) throw InvalidInput("limit_slope: iterations must be at least 1");
}

}  // namespace

SlopeLimitResult limit_slope(const HeightMap& relief, const SlopeLimitOptions& options) {
  require_height_map(relief, "limit_slope", true);
  require_options(options);
  const Stopwatch clock;
  const Grid grid(relief);
  const std::vector<double> h(relief.mm.begin(), relief.mm.end());
  const auto samples = static_cast<double>(h.size());
  // Heights are stored as floats: what rounds up to the limit is not above it.
  const double most = options.max_slope * (1 + 1e-6);
  SlopeLimitResult result;
  result.relief = relief;
  const Steepness before = steepness(grid, h, most);
  result.steepest_before = result.steepest_after = before.largest;
  result.share_before = static_cast<double>(before.above) / samples;
  if (before.above == 0) return result;

  Shrinkage shrinkage(grid, h, options.max_slope / (1 + options.relative_tolerance));
  result.stop = StopReason::iteration_limit;
  for (; result.iterations < options.iterations; ++result.iterations) {
    const double largest = shrinkage.flow();
    result.trace.push_back({clock.seconds(), largest / options.max_slope - 1});
    if (largest <= options.max_slope) {
      result.stop = StopReason::converged;
      break;
    }
    shrinkage.move();
  }
  double squares = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const double change = shrinkage.u()[i] - h[i];
    squares += change * change;
    result.largest_change_mm = std::max(result.largest_change_mm, std::abs(change));
    result.relief.mm[i] = static_cast<float>(shrinkage.u()[i]);
  }
  result.rms_change_mm = std::sqrt(squares / samples);
  const Steepness after = steepness(grid, std::vector<double>(result.relief.mm.begin(), result.relief.mm.end()), most);
  result.steepest_after = after.largest;
  result.share_after = static_cast<double>(after.above) / samples;
  return result;
}

}  // namespace papilla
