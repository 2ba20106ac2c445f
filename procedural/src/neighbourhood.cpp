// SPDX-License-Identifier: MIT
#include "evaluator.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace papilla::procedural_detail {
namespace {

/// Cells of the grid in a radius, at most.
constexpr double k_cells_of_radius = 8;
constexpr float k_unknown = std::numeric_limits<float>::quiet_NaN();

/// Statistics of the known values in a block of texels.
struct Cell {
  double weight = 0, mean = 0, square = 0, least = 0, most = 0;
};

struct Tap {
  int x, y;
  double weight, dx, dy;  ///< In texels.
};

class Grid {
 public:
  Grid(std::span<const float> values, const NearRaster& raster, double radius)
      : raster_(raster), radius_(std::min(radius, static_cast<double>(std::max(raster.width, raster.height)))) {
    const int block = std::max(1, static_cast<int>(std::ceil(radius_ / k_cells_of_radius)));
    columns_ = (raster.width + block - 1) / block, rows_ = (raster.height + block - 1) / block;
    pitch_x_ = static_cast<double>(raster.width) / columns_, pitch_y_ = static_cast<double>(raster.height) / rows_;
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    tbb::parallel_for(0, rows_, [&](int row) {
      for (int column = 0; column < columns_; ++column) cell(column, row) = cell_of(values, column, row);
    });
    make_taps();
  }

  std::vector<float> statistic(NearStatistic kind) const {
    std::vector<double> of_cells(cells_.size());
    tbb::parallel_for(0, rows_, [&](int row) {
      for (int column = 0; column < columns_; ++column) of_cells[index(column, row)] = at(kind, column, row);
    });
    std::vector<float> out(raster_.texels());
    tbb::parallel_for(0, raster_.height, [&](int y) {
      for (int x = 0; x < raster_.width; ++x)
        out[static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width) + static_cast<std::size_t>(x)] =
            static_cast<float>(between(of_cells, (x + 0.5) / pitch_x_ - 0.5, (y + 0.5) / pitch_y_ - 0.5));
    });
    return out;
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  Cell& cell(int column, int row) { return cells_[index(column, row)]; }
  const Cell& cell(int column, int row) const { return cells_[index(column, row)]; }

  Cell cell_of(std::span<const float> values, int column, int row) const {
    const auto border = [](int k, int of, int size) {
      return static_cast<int>(static_cast<std::int64_t>(k) * size / of);
    };
    Cell c;
    for (int y = border(row, rows_, raster_.height); y < border(row + 1, rows_, raster_.height); ++y)
      for (int x = border(column, columns_, raster_.width); x < border(column + 1, columns_, raster_.width); ++x) {
        const double v =
            static_cast<double>(values[static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width) +
                                       static_cast<std::size_t>(x)]);
        if (!std::isfinite(v)) continue;
        c.least = c.weight > 0 ? std::min(c.least, v) : v;
        c.most = c.weight > 0 ? std::max(c.most, v) : v;
        c.weight += 1, c.mean += v, c.square += v * v;
      }
    if (c.weight > 0) c.mean /= c.weight, c.square /= c.weight;
    return c;
  }

  void make_taps() {
    const double pitch = std::max(pitch_x_, pitch_y_);
    const int reach_x = static_cast<int>(std::ceil(radius_ / pitch_x_ + 0.5)),
              reach_y = static_cast<int>(std::ceil(radius_ / pitch_y_ + 0.5));
    for (int y = -reach_y; y <= reach_y; ++y)
      for (int x = -reach_x; x <= reach_x; ++x) {
        const double dx = x * pitch_x_, dy = y * pitch_y_;
        const double weight = std::clamp((radius_ - std::hypot(dx, dy)) / pitch + 0.5, 0.0, 1.0);
        if (weight > 0 || (x == 0 && y == 0)) taps_.push_back({x, y, std::max(weight, 1e-9), dx, dy});
      }
  }

  /// The cell that a tap meets, or null.
  const Cell* met(int column, int row, const Tap& tap) const {
    int x = column + tap.x, y = row + tap.y;
    if (raster_.repeats) {
      x = (x % columns_ + columns_) % columns_, y = (y % rows_ + rows_) % rows_;
    } else if (x < 0 || y < 0 || x >= columns_ || y >= rows_) {
      return nullptr;
    }
    const Cell& c = cell(x, y);
    return c.weight > 0 ? &c : nullptr;
  }

  double at(NearStatistic kind, int column, int row) const {
    if (kind == NearStatistic::least || kind == NearStatistic::most) return extreme(kind, column, row);
    double weight = 0, mean = 0, square = 0, mx = 0, my = 0, xx = 0, xy = 0, yy = 0, xv = 0, yv = 0;
    for (const Tap& tap : taps_) {
      const Cell* c = met(column, row, tap);
      if (!c) continue;
      const double w = tap.weight * c->weight;
      weight += w, mean += w * c->mean, square += w * c->square;
      if (kind != NearStatistic::slope) continue;
      mx += w * tap.dx, my += w * tap.dy;
      xx += w * tap.dx * tap.dx, xy += w * tap.dx * tap.dy, yy += w * tap.dy * tap.dy;
      xv += w * tap.dx * c->mean, yv += w * tap.dy * c->mean;
    }
    if (weight <= 0) return 0;
    mean /= weight;
    if (kind == NearStatistic::mean) return mean;
    if (kind == NearStatistic::deviation) return std::sqrt(std::max(0.0, square / weight - mean * mean));
    mx /= weight, my /= weight;
    xx = xx / weight - mx * mx, xy = xy / weight - mx * my, yy = yy / weight - my * my;
    xv = xv / weight - mx * mean, yv = yv / weight - my * mean;
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-9)) return 0;
    return std::hypot((yy * xv - xy * yv) / determinant, (xx * yv - xy * xv) / determinant);
  }

  double extreme(NearStatistic kind, int column, int row) const {
    bool any = false;
    double best = 0;
    for (const Tap& tap : taps_) {
      const Cell* c = met(column, row, tap);
      if (!c || (tap.dx * tap.dx + tap.dy * tap.dy > radius_ * radius_ && any)) continue;
      const double v = kind == NearStatistic::least ? c->least : c->most;
      best = !any ? v : kind == NearStatistic::least ? std::min(best, v) : std::max(best, v);
      any = true;
    }
    return best;
  }

  double between(const std::vector<double>& of_cells, double x, double y) const {
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    const auto value = [&](int column, int row) {
      if (raster_.repeats)
        column = (column + columns_) % columns_, row = (row + rows_) % rows_;
      else
        column = std::clamp(column, 0, columns_ - 1), row = std::clamp(row, 0, rows_ - 1);
      return of_cells[index(column, row)];
    };
    const double s = x - left, t = y - top;
    const double upper = s == 0 ? value(left, top) : value(left, top) * (1 - s) + value(left + 1, top) * s;
    if (t == 0) return upper;
    return upper * (1 - t) + (value(left, top + 1) * (1 - s) + value(left + 1, top + 1) * s) * t;
  }

  NearRaster raster_;
  double radius_;
  int columns_ = 0, rows_ = 0;
  double pitch_x_ = 1, pitch_y_ = 1;
  std::vector<Cell> cells_;
  std::vector<Tap> taps_;
};

}  // namespace

std::vector<float> near_statistic(NearStatistic kind, std::span<const float> values, const NearRaster& raster,
                                  double radius) {
  return Grid(values, raster, radius).statistic(kind);
}

void without_neighbours(NearStatistic kind, const double* in, int n, double* out) {
  if (kind == NearStatistic::deviation || kind == NearStatistic::slope)
    std::fill_n(out, n, 0.0);
  else
    std::copy_n(in, n, out);
}

Neighbourhoods::Neighbourhoods(const Graph& graph, const NearRaster& raster)
    : graph_(graph), raster_(raster), requests_(graph.near.size()) {}

bool Neighbourhoods::next() {
  for (std::size_t k = 0; k < requests_.size(); ++k) {
    Request& r = requests_[k];
    const NearRequest& asked = graph_.near[k];
    if (asked.level == pass_ && r.texel > 0) {
      const double texel = r.texel;
      r.found = near_statistic(asked.kind, r.values, raster_, asked.radius / texel);
      if (asked.kind == NearStatistic::slope)
        for (float& v : r.found) v /= static_cast<float>(texel);
    }
    if (asked.level == pass_) r.values = {};
    if (asked.level == pass_ + 1) r.values.assign(raster_.texels(), k_unknown);
  }
  return pass_++ <= graph_.deepest_near();
}

void Neighbourhoods::evaluate(int request, const std::uint32_t* texels, int n, double texel, const double* in,
                              double* out) {
  Request& r = requests_[static_cast<std::size_t>(request)];
  if (!r.found.empty()) {
    for (int i = 0; i < n; ++i) out[i] = static_cast<double>(r.found[texels[i]]);
    return;
  }
  without_neighbours(graph_.near[static_cast<std::size_t>(request)].kind, in, n, out);
  if (r.values.empty()) return;
  r.texel.store(texel, std::memory_order_relaxed);
  for (int i = 0; i < n; ++i)
    r.values[texels[i]] = std::isfinite(in[i]) ? static_cast<float>(std::clamp(in[i], -1e30, 1e30)) : 0.0F;
}

}  // namespace papilla::procedural_detail
