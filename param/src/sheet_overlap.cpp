// SPDX-License-Identifier: MIT
#include "sheet_overlap.hpp"

#include <algorithm>
#include <cmath>

#include "adjacency.hpp"
#include "papilla/core/bounds.hpp"

namespace papilla::param_detail {
namespace {

/// Fraction of the sheet's extent below which contact is not overlap: above the rounding of cross products of
/// coordinates, which are taken as exact, and far below anything that can be seen.
constexpr double k_contact = 1e-13;

struct Box : Bounds2 {
  double width() const { return high.x - low.x; }
  double height() const { return high.y - low.y; }
  double extent() const { return std::max(width(), height()); }
};

Box box_of(const std::array<Vec2, 3>& t) {
  Box box;
  for (const Vec2 p : t) box.add(p);
  return box;
}

Box box_of(const BorderEdge& e) {
  Box box;
  box.add(e.a);
  box.add(e.b);
  return box;
}

Box box_of(const PlaneSheet& sheet) {
  Box box;
  for (const auto& t : sheet.triangles)
    for (const Vec2 p : t) box.add(p);
  return box;
}

/// Has an interior that can overlap.
bool has_interior(const std::array<Vec2, 3>& t, double tolerance) {
  const Vec2 p = t[1] - t[0], q = t[2] - t[0], r = t[2] - t[1];
  return cross(p, q) > tolerance * std::sqrt(std::max({dot(p, p), dot(q, q), dot(r, r)}));
}

/// Uniform grid of item numbers, singly linked lists in two arrays.
class Grid {
 public:
  /// @param items how many items of mean size `item_width` × `item_height` it will hold.
  Grid(const Box& box, std::size_t items, double item_width, double item_height) : low_(box.low) {
    const double per_axis = std::sqrt(static_cast<double>(items) + 1);
    const double aspect = std::sqrt(std::clamp(box.width() / std::max(box.height(), 1e-300), 1e-4, 1e4));
    columns_ = cells(box.width(), item_width, per_axis * aspect);
    rows_ = cells(box.height(), item_height, per_axis / aspect);
    scale_x_ = box.width() > 0 ? columns_ / box.width() : 0;
    scale_y_ = box.height() > 0 ? rows_ / box.height() : 0;
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), k_no_triangle);
  }

  void insert(Index item, const Box& box) {
    visit_cells(box, [&](std::size_t cell) {
      entries_.push_back({item, first_[cell]});
      first_[cell] = static_cast<Index>(entries_.size() - 1);
      return false;
    });
  }

  /// Calls `test(item)` for the items near the box, perhaps repeatedly, until it says true; then so does this.
  template <class Test>
  bool any(const Box& box, Test test) const {
    return visit_cells(box, [&](std::size_t cell) {
      for (Index e = first_[cell]; e != k_no_triangle; e = entries_[e].next)
        if (test(entries_[e].item)) return true;
      return false;
    });
  }

 private:
  struct Entry {
    Index item, next;
  };

  static int cells(double size, double item_size, double wanted) {
    const double by_item = item_size > 0 ? size / item_size : wanted;
    return static_cast<int>(std::clamp(std::min(wanted, by_item), 1.0, 8192.0));
  }
  int column(double x) const { return std::clamp(static_cast<int>((x - low_.x) * scale_x_), 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>((y - low_.y) * scale_y_), 0, rows_ - 1); }

  template <class Visit>
  bool visit_cells(const Box& box, Visit visit) const {
    const int x0 = column(box.low.x), x1 = column(box.high.x), y0 = row(box.low.y), y1 = row(box.high.y);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        if (visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)))
          return true;
    return false;
  }

  Vec2 low_;
  int columns_ = 1, rows_ = 1;
  double scale_x_ = 0, scale_y_ = 0;
  std::vector<Index> first_;
  std::vector<Entry> entries_;
};

/// An empty grid over the sheet with cells of about one average item.
template <class Items>
Grid grid_for(const Box& box, const Items& items) {
  double width = 0, height = 0;
  for (const auto& item : items) {
    const Box b = box_of(item);
    width += b.width();
    height += b.height();
  }
  const double n = std::max<double>(1, static_cast<double>(items.size()));
  return Grid(box, items.size(), width / n, height / n);
}

/// All three corners of b lie right of, or within `tolerance` of, the edge p -> q.
bool edge_separates(Vec2 p, Vec2 q, const std::array<Vec2, 3>& b, double tolerance) {
  const Vec2 d = q - p;
  const double limit = tolerance * std::sqrt(dot(d, d));
  return cross(d, b[0] - p) <= limit && cross(d, b[1] - p) <= limit && cross(d, b[2] - p) <= limit;
}

/// The border visits no named point twice and has exactly one counter-clockwise loop.
bool has_one_outer_loop(const std::vector<BorderEdge>& border) {
  std::vector<std::pair<Index, Index>> start;  // (from, edge)
  start.reserve(border.size());
  for (Index i = 0; i < border.size(); ++i) start.push_back({border[i].from, i});
  std::sort(start.begin(), start.end());
  for (std::size_t i = 1; i < start.size(); ++i)
    if (start[i].first == start[i - 1].first) return false;
  std::vector<char> seen(border.size(), 0);
  int outer = 0;
  for (Index first = 0; first < border.size(); ++first) {
    if (seen[first]) continue;
    double doubled_area = 0;
    const Vec2 origin = border[first].a;
    for (Index i = first; !seen[i];) {
      seen[i] = 1;
      doubled_area += cross(border[i].a - origin, border[i].b - origin);
      const auto next = std::lower_bound(start.begin(), start.end(), std::pair<Index, Index>{border[i].to, 0});
      if (next == start.end() || next->first != border[i].to) return false;
      i = next->second;
    }
    outer += doubled_area > 0;
  }
  return outer == 1;
}

bool is_border_triangle(const PlaneSheet& sheet, Index t) {
  const auto& across = sheet.across[t];
  return across[0] == k_no_triangle || across[1] == k_no_triangle || across[2] == k_no_triangle;
}

}  // namespace

bool edges_conflict(const BorderEdge& e, const BorderEdge& f, double tolerance) {
  const Vec2 d = e.b - e.a, g = f.b - f.a;
  const bool shares_start = e.from == f.from || e.from == f.to, shares_end = e.to == f.from || e.to == f.to;
  if (shares_start && shares_end) return true;
  if (shares_start || shares_end) {
    const Vec2 along_e = shares_start ? d : -1.0 * d;
    const bool f_leaves = f.from == (shares_start ? e.from : e.to);
    const Vec2 along_f = f_leaves ? g : -1.0 * g;
    return dot(along_e, along_f) > 0 &&
           std::abs(cross(along_e, along_f)) <= tolerance * std::sqrt(std::max(dot(d, d), dot(g, g)));
  }
  if (edges_apart(e, f, tolerance)) return false;
  const auto one_side = [](double s, double t, double limit) {
    return (s > limit && t > limit) || (s < -limit && t < -limit);
  };
  return !one_side(cross(d, f.a - e.a), cross(d, f.b - e.a), tolerance * std::sqrt(dot(d, d))) &&
         !one_side(cross(g, e.a - f.a), cross(g, e.b - f.a), tolerance * std::sqrt(dot(g, g)));
}

bool interiors_meet(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (edge_separates(a[k], a[(k + 1) % 3], b, tolerance)) return false;
    if (edge_separates(b[k], b[(k + 1) % 3], a, tolerance)) return false;
  }
  return true;
}

bool border_proves_injective(const std::vector<BorderEdge>& border) {
  if (!has_one_outer_loop(border)) return false;
  Box box;
  for (const BorderEdge& e : border) box.add(e.a);
  const double tolerance = k_contact * box.extent();
  Grid grid = grid_for(box, border);
  for (Index i = 0; i < border.size(); ++i) {
    const Box b = box_of(border[i]);
    if (grid.any(b, [&](Index j) { return edges_conflict(border[i], border[j], tolerance); })) return false;
    grid.insert(i, b);
  }
  return true;
}

std::vector<std::array<Index, 2>> edges_that_meet(const std::vector<BorderEdge>& border) {
  Box box;
  for (const BorderEdge& e : border) box.add(e.a);
  const double tolerance = k_contact * box.extent();
  Grid grid = grid_for(box, border);
  std::vector<std::array<Index, 2>> pairs;
  for (Index i = 0; i < border.size(); ++i) {
    const Box b = box_of(border[i]);
    grid.any(b, [&](Index j) {
      if (edges_conflict(border[i], border[j], tolerance)) pairs.push_back({j, i});
      return false;
    });
    grid.insert(i, b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

bool overlaps_itself(const PlaneSheet& sheet) {
  const Box box = box_of(sheet);
  const double tolerance = k_contact * box.extent();
  Grid grid = grid_for(box, sheet.triangles);
  for (Index t = 0; t < sheet.triangles.size(); ++t)
    if (is_border_triangle(sheet, t) && has_interior(sheet.triangles[t], tolerance))
      grid.insert(t, box_of(sheet.triangles[t]));
  for (Index t = 0; t < sheet.triangles.size(); ++t) {
    const auto& triangle = sheet.triangles[t];
    const auto meets = [&](Index other) {
      return other != t && interiors_meet(triangle, sheet.triangles[other], tolerance);
    };
    if (has_interior(triangle, tolerance) && grid.any(box_of(triangle), meets)) return true;
  }
  return false;
}

std::vector<std::uint32_t> split_overlaps(const PlaneSheet& sheet) {
  constexpr std::uint32_t unplaced = ~std::uint32_t{0};
  const Box box = box_of(sheet);
  const double tolerance = k_contact * box.extent();
  std::vector<std::uint32_t> piece(sheet.triangles.size(), unplaced), asked(sheet.triangles.size(), unplaced);
  std::uint32_t count = 0;
  Grid grid = grid_for(box, sheet.triangles);
  std::vector<Index> queue;
  for (Index seed = 0; seed < sheet.triangles.size(); ++seed) {
    if (piece[seed] != unplaced) continue;
    queue.assign(1, seed);
    asked[seed] = count;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Index t = queue[i];
      const auto& triangle = sheet.triangles[t];
      if (has_interior(triangle, tolerance)) {
        const Box b = box_of(triangle);
        const auto meets = [&](Index other) {
          return piece[other] == count && interiors_meet(triangle, sheet.triangles[other], tolerance);
        };
        if (grid.any(b, meets)) continue;
        grid.insert(t, b);
      }
      piece[t] = count;
      for (const Index other : sheet.across[t])
        if (other != k_no_triangle && piece[other] == unplaced && asked[other] != count)
          asked[other] = count, queue.push_back(other);
    }
    ++count;
  }
  return piece;
}

}  // namespace papilla::param_detail
