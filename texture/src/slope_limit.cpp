// SPDX-License-Identifier: MIT
#include "papilla/texture/slope_limit.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "checks.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace texture_detail;

/// Forward differences of a relief's samples, and their adjoint.
class Grid {
 public:
  explicit Grid(const HeightMap& map)
      : width_(map.width),
        height_(map.height),
        periodic_(map.periodic),
        per_x_(1 / map.pitch_mm_x),
        per_y_(1 / map.pitch_mm_y) {}

  std::size_t size() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  int rows() const { return height_; }
  /// Bound of the squared norm of the differences.
  double norm2() const { return 4 * (per_x_ * per_x_ + per_y_ * per_y_); }

  /// ∇u at sample (x, y).
  Vec2 slope(const std::vector<double>& u, int x, int y) const {
    const std::size_t i = at(x, y);
    const int right = next(x, width_), below = next(y, height_);
    return {right < 0 ? 0 : per_x_ * (u[at(right, y)] - u[i]), below < 0 ? 0 : per_y_ * (u[at(x, below)] - u[i])};
  }

  /// The adjoint of the differences, applied to p at sample (x, y).
  double adjoint(const std::vector<Vec2>& p, int x, int y) const {
    const std::size_t i = at(x, y);
    const int left = previous(x, width_), above = previous(y, height_);
    double sum = 0;
    if (next(x, width_) >= 0) sum -= per_x_ * p[i].x;
    if (next(y, height_) >= 0) sum -= per_y_ * p[i].y;
    if (left >= 0) sum += per_x_ * p[at(left, y)].x;
    if (above >= 0) sum += per_y_ * p[at(x, above)].y;
    return sum;
  }

  /// Calls row(y) for every row, on all threads.
  template <class Row>
  void each_row(const Row& row) const {
    oneapi::tbb::parallel_for(0, height_, [&](int y) { row(y); });
  }

  std::size_t at(int x, int y) const { return pixel_index(x, y, width_); }
  int columns() const { return width_; }

 private:
  int next(int i, int n) const { return i + 1 < n ? i + 1 : periodic_ && n > 1 ? 0 : -1; }
  int previous(int i, int n) const { return i > 0 ? i - 1 : periodic_ && n > 1 ? n - 1 : -1; }

  int width_, height_;
  bool periodic_;
  double per_x_, per_y_;
};

/// Without norm()'s care for overflow, which took a fifth of a grain's time: slopes are far from 1e150.
double length_of(Vec2 slope) { return std::sqrt(dot(slope, slope)); }

struct Steepness {
  double largest = 0;
  std::size_t above = 0;  ///< Samples that are steeper than the limit.
};

Steepness steepness(const Grid& grid, const std::vector<double>& u, double limit) {
  std::vector<Steepness> rows(static_cast<std::size_t>(grid.rows()));
  grid.each_row([&](int y) {
    Steepness& row = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < grid.columns(); ++x) {
      const double slope = length_of(grid.slope(u, x, y));
      row.largest = std::max(row.largest, slope);
      row.above += slope > limit;
    }
  });
  Steepness all;
  for (const Steepness& row : rows) all = {std::max(all.largest, row.largest), all.above + row.above};
  return all;
}

/// The state of the iteration: the flow p, its extrapolation q, and u = h − div* q.
class Shrinkage {
 public:
  Shrinkage(const Grid& grid, const std::vector<double>& h, double limit)
      : grid_(grid), h_(h), limit_(limit), p_(h.size()), q_(h.size()), u_(h) {}

  void step() {
    const double rate = 1 / grid_.norm2(), threshold = rate * limit_;
    const double grown = 0.5 * (1 + std::sqrt(1 + 4 * momentum_ * momentum_));
    const double ahead = (momentum_ - 1) / grown;
    std::vector<double> overshoot(static_cast<std::size_t>(grid_.rows()));
    grid_.each_row([&](int y) {
      double& beyond = overshoot[static_cast<std::size_t>(y)];
      for (int x = 0; x < grid_.columns(); ++x) {
        const std::size_t i = grid_.at(x, y);
        const Vec2 wanted = q_[i] + rate * grid_.slope(u_, x, y);
        const double length = length_of(wanted);
        const Vec2 next = length > threshold ? (1 - threshold / length) * wanted : Vec2{};
        beyond += dot(q_[i] - next, next - p_[i]);
        q_[i] = next + ahead * (next - p_[i]);
        p_[i] = next;
      }
    });
    momentum_ = grown;
    if (std::accumulate(overshoot.begin(), overshoot.end(), 0.0) > 0) {
      momentum_ = 1;
      q_ = p_;
    }
    grid_.each_row([&](int y) {
      for (int x = 0; x < grid_.columns(); ++x) {
        const std::size_t i = grid_.at(x, y);
        u_[i] = h_[i] - grid_.adjoint(q_, x, y);
      }
    });
  }

  /// h − div* q.
  const std::vector<double>& u() const { return u_; }

 private:
  const Grid& grid_;
  const std::vector<double>& h_;
  double limit_, momentum_ = 1;
  std::vector<Vec2> p_, q_;
  std::vector<double> u_;
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
    const double largest = steepness(grid, shrinkage.u(), most).largest;
    result.trace.push_back({clock.seconds(), largest / options.max_slope - 1});
    if (largest <= options.max_slope) {
      result.stop = StopReason::converged;
      break;
    }
    shrinkage.step();
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
