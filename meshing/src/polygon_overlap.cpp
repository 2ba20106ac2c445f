// SPDX-License-Identifier: MIT
#include "polygon_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "papilla/core/bounds.hpp"

namespace papilla::detail {
namespace {

constexpr int k_rows = 384;
constexpr double k_max_fraction = 1e-3;
constexpr double k_depth = 1e-5;

struct Crossing {
  int row;
  double x;
  int turn;  ///< Change of the winding number from left to right.
};

/// The area covered more than once or backwards as a fraction of the area: sampled on rows, exact along the row.
double overlap_fraction(std::span<const Vec2> polygon) {
  if (polygon.size() < 3) return 0;
  const auto [lowest, highest] =
      std::minmax_element(polygon.begin(), polygon.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
  const double low = lowest->y, step = (highest->y - low) / k_rows;
  if (!(step > 0) || !std::isfinite(step)) return 0;
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const int turn = a.y < b.y ? -1 : 1;
    if (turn > 0) std::swap(a, b);
    // Rows at the middles low + (r + 1/2) step with a.y <= y < b.y.
    const int first = std::max(0, static_cast<int>(std::ceil((a.y - low) / step - 0.5)));
    for (int r = first; r < k_rows && low + (r + 0.5) * step < b.y; ++r)
      crossings.push_back({r, a.x + (low + (r + 0.5) * step - a.y) / (b.y - a.y) * (b.x - a.x), turn});
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.row != b.row ? a.row < b.row : a.x != b.x ? a.x < b.x : a.turn < b.turn;
  });
  double area = 0, again = 0;
  for (std::size_t i = 0, winding = 0; i + 1 < crossings.size(); ++i) {
    // Counter-clockwise: the left border runs down, which raises the number.
    winding += static_cast<std::size_t>(crossings[i].turn);
    if (crossings[i].row != crossings[i + 1].row) {
      winding = 0;
      continue;
    }
    const auto number = static_cast<std::ptrdiff_t>(winding);
    const double width = crossings[i + 1].x - crossings[i].x;
    area += static_cast<double>(number) * width;
    again += static_cast<double>(number > 0 ? number - 1 : -2 * number) * width;
  }
  return area > 0 ? again / area : again > 0 ? 1 : 0;
}

/// Edges in the cells of a grid that their boxes touch.
class EdgeGrid {
 public:
  explicit EdgeGrid(std::span<const Vec2> polygon) : polygon_(polygon) {
    for (const Vec2 p : polygon) bounds_.add(p);
    const double n = static_cast<double>(polygon.size()), width = bounds_.size().x, height = bounds_.size().y;
    cell_ = std::max({std::sqrt(width * height / n), width / n, height / n});
    if (!(cell_ > 0)) cell_ = 1;
    columns_ = static_cast<std::size_t>(width / cell_) + 1;
    rows_ = static_cast<std::size_t>(height / cell_) + 1;
    cells_.resize(columns_ * rows_);
    for (std::size_t i = 0; i < polygon.size(); ++i)
      visit(i, [&](std::vector<std::size_t>& cell) { cell.push_back(i); });
  }

  /// Calls visit(cell) for the cells that edge i may pass.
  template <class Visit>
  void visit(std::size_t i, const Visit& visit) {
    const Vec2 a = polygon_[i], b = polygon_[(i + 1) % polygon_.size()];
    const std::size_t first_row = row(std::min(a.y, b.y)), last_row = row(std::max(a.y, b.y));
    for (std::size_t r = first_row; r <= last_row; ++r) {
      // The part of the edge within the row.
      double from = std::min(a.x, b.x), to = std::max(a.x, b.x);
      if (a.y != b.y && first_row != last_row) {
        const double y0 = bounds_.low.y + static_cast<double>(r) * cell_, slope = (b.x - a.x) / (b.y - a.y);
        const double x0 = a.x + (y0 - a.y) * slope, x1 = x0 + cell_ * slope;
        from = std::max(from, std::min(x0, x1) - 1e-9 * cell_);
        to = std::min(to, std::max(x0, x1) + 1e-9 * cell_);
      }
      for (std::size_t c = column(from); c <= column(to); ++c) visit(cells_[r * columns_ + c]);
    }
  }

 private:
  std::size_t row(double y) const { return place(y - bounds_.low.y, rows_); }
  std::size_t column(double x) const { return place(x - bounds_.low.x, columns_); }
  std::size_t place(double offset, std::size_t count) const {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, offset / cell_)));
  }

  std::span<const Vec2> polygon_;
  Bounds2 bounds_;
  double cell_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::size_t>> cells_;
};

/// How far p lies to the left of the line from a to b.
double left_of(Vec2 p, Vec2 a, Vec2 b) {
  const double length = norm(b - a);
  return length > 0 ? cross(b - a, p - a) / length : 0;
}

bool cross_deeper(Vec2 a, Vec2 b, Vec2 c, Vec2 d, double depth) {
  const auto parted = [depth](double s, double t) { return (s > depth && t < -depth) || (s < -depth && t > depth); };
  return parted(left_of(c, a, b), left_of(d, a, b)) && parted(left_of(a, c, d), left_of(b, c, d));
}

double depth_of(std::span<const Vec2> polygon) { return k_depth * std::sqrt(std::abs(polygon_area(polygon))); }

/// Calls visit(i, k) for edges i < k that cross deeper than `depth` until it returns true, which is then returned;
/// pairs may come more than once.
template <class Visit>
bool visit_crossings(std::span<const Vec2> polygon, double depth, const Visit& visit) {
  EdgeGrid grid(polygon);
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    bool done = false;
    grid.visit(i, [&](const std::vector<std::size_t>& cell) {
      for (const std::size_t k : cell)
        done =
            done || (k > i && cross_deeper(polygon[i], polygon[(i + 1) % n], polygon[k], polygon[(k + 1) % n], depth) &&
                     visit(i, k));
    });
    if (done) return true;
  }
  return false;
}

double hull_area(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end());
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {  // lower, then upper hull
    const std::size_t start = hull.size();
    for (const Vec2 p : points) {
      while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return polygon_area(hull);
}

}  // namespace

double polygon_area(std::span<const Vec2> polygon) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    area += 0.5 * cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return area;
}

bool overlaps_itself(std::span<const Vec2> polygon) {
  if (polygon.size() < 4) return false;
  return overlap_fraction(polygon) > k_max_fraction ||
         visit_crossings(polygon, depth_of(polygon), [](std::size_t, std::size_t) { return true; });
}

std::optional<std::pair<std::size_t, std::size_t>> widest_crossing(std::span<const Vec2> polygon) {
  std::optional<std::pair<std::size_t, std::size_t>> widest;
  std::size_t most = 0;
  if (polygon.size() >= 4)
    visit_crossings(polygon, depth_of(polygon), [&](std::size_t i, std::size_t k) {
      const std::size_t apart = std::min(k - i, polygon.size() - (k - i));
      if (apart > most) most = apart, widest = {i, k};
      return false;
    });
  return widest;
}

double compactness(std::span<const Vec2> polygon) {
  if (polygon.size() < 3) return 0;
  const double hull = hull_area({polygon.begin(), polygon.end()});
  return hull > 0 ? std::max(0.0, polygon_area(polygon)) / hull : 0;
}

}  // namespace papilla::detail
