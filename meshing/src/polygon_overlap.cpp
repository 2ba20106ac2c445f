// SPDX-License-Identifier: MIT
#include "polygon_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace papilla::detail {
namespace {

constexpr int k_rows = 384;

struct Crossing {
  int row;
  double x;
  int turn;  ///< Change of the winding number from left to right.
};

}  // namespace

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

}  // namespace papilla::detail
