// SPDX-License-Identifier: MIT
#include "uv_overlap.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace papilla::param_detail {
namespace {

/// Fraction of the longer edge by which triangles may run into one another and still count as touching.
constexpr double k_touching = 1e-9;
constexpr std::uint32_t k_leaf_size = 8;
/// Row segments held at a time; more rows are given up before memory is.
constexpr double k_most_segments = 3e7;

struct Rectangle {
  double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0;
  void include(const Rectangle& r) {
    x0 = std::min(x0, r.x0), y0 = std::min(y0, r.y0), x1 = std::max(x1, r.x1), y1 = std::max(y1, r.y1);
  }
  bool meets(const Rectangle& r) const { return x0 < r.x1 && r.x0 < x1 && y0 < r.y1 && r.y0 < y1; }
};

Rectangle bounds(const UvTriangle& t) {
  const auto& [a, b, c] = t.corners;
  return {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
}

double area(const UvTriangle& t) { return 0.5 * cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]); }

/// How deep b reaches over the line through each edge of a at most, taken over the edge where it reaches least.
double depth(const UvTriangle& a, const UvTriangle& b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 p = a.corners[k], d = a.corners[(k + 1) % 3] - p;
    const double reach = std::max({cross(d, b.corners[0] - p), cross(d, b.corners[1] - p), cross(d, b.corners[2] - p)});
    least = std::min(least, reach / norm(d));
  }
  return least;
}

bool overlap(const UvTriangle& a, const UvTriangle& b) {
  const Vec2 p = a.corners[1] - a.corners[0], q = a.corners[2] - a.corners[0];
  const double touching = k_touching * std::sqrt(std::max(dot(p, p), dot(q, q)));
  return depth(a, b) > touching && depth(b, a) > touching;
}

/// Bounding volume hierarchy over some of the triangles, split at the median of the longer side.
class Hierarchy {
 public:
  struct Member {
    Rectangle box;
    std::uint32_t triangle = 0;
  };

  Hierarchy(const std::vector<UvTriangle>& triangles, const std::vector<std::uint32_t>& members)
      : triangles_(&triangles) {
    members_.reserve(members.size());
    for (const std::uint32_t t : members) members_.push_back({bounds(triangles[t]), t});
    build(0, static_cast<std::uint32_t>(members_.size()));
  }

  std::span<const Member> members() const { return members_; }

  bool anything_over(const Member& member) const {
    std::uint32_t stack[64];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!node.box.meets(member.box)) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Member& other = members_[i];
        if (other.triangle != member.triangle && other.box.meets(member.box) &&
            overlap((*triangles_)[member.triangle], (*triangles_)[other.triangle]))
          return true;
      }
    }
    return false;
  }

 private:
  /// A leaf has its members from `first`; an inner node has its left child next to it and its right one at `first`.
  struct Node {
    Rectangle box;
    std::uint32_t first = 0, count = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end) {
    const auto self = nodes_.size();
    nodes_.emplace_back();
    Rectangle box;
    for (std::uint32_t i = begin; i < end; ++i) box.include(members_[i].box);
    nodes_[self].box = box;
    if (end - begin <= k_leaf_size) {
      nodes_[self].first = begin;
      nodes_[self].count = end - begin;
      return;
    }
    const bool split_x = box.x1 - box.x0 > box.y1 - box.y0;
    const auto key = [split_x](const Member& m) {
      return std::pair(split_x ? m.box.x0 + m.box.x1 : m.box.y0 + m.box.y1, m.triangle);
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(members_.begin() + begin, members_.begin() + middle, members_.begin() + end,
                     [&](const Member& a, const Member& b) { return key(a) < key(b); });
    build(begin, middle);
    nodes_[self].first = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
  }

  const std::vector<UvTriangle>* triangles_;
  std::vector<Member> members_;
  std::vector<Node> nodes_;
};

/// The triangle numbers of each group.
std::vector<std::vector<std::uint32_t>> groups_of(const std::vector<UvTriangle>& triangles) {
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::size_t group = triangles[t].group;
    if (group >= groups.size()) groups.resize(group + 1);
    groups[group].push_back(t);
  }
  return groups;
}

/// The part of a row that a triangle covers.
struct Segment {
  std::uint32_t group;
  double x0, x1;
};

Segment cut_row(const UvTriangle& t, double y) {
  Segment s{t.group, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < 3; ++k) {
    Vec2 a = t.corners[k], b = t.corners[(k + 1) % 3];
    if (b < a) std::swap(a, b);  // the neighbour across this edge computes the same crossing
    if ((a.y <= y) == (b.y <= y)) continue;
    const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
    s.x0 = std::min(s.x0, x), s.x1 = std::max(s.x1, x);
  }
  return s;
}

struct Covered {
  double once = 0, twice = 0;  ///< Length or area covered at least so often.
};

Covered cover(std::vector<Segment>& segments) {
  std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) {
    return a.group != b.group ? a.group < b.group : a.x0 != b.x0 ? a.x0 < b.x0 : a.x1 < b.x1;
  });
  Covered result;
  constexpr double nowhere = -std::numeric_limits<double>::infinity();
  double end_once = nowhere, end_twice = nowhere;  // covered up to here at least once, twice
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    if (i == 0 || segments[i - 1].group != s.group) end_once = end_twice = nowhere;
    result.once += std::max(0.0, s.x1 - std::max(s.x0, end_once));
    const double second_end = std::min(s.x1, end_once);
    result.twice += std::max(0.0, second_end - std::max(s.x0, end_twice));
    end_twice = std::max(end_twice, second_end);
    end_once = std::max(end_once, s.x1);
  }
  return result;
}

/// Sums, row by row, the area that the chosen triangles cover once and more than once.
Covered cover_rows(const std::vector<UvTriangle>& triangles, const std::vector<std::uint32_t>& chosen,
                   int wanted_rows) {
  Rectangle box;
  double heights = 0;
  for (const std::uint32_t t : chosen) {
    const Rectangle r = bounds(triangles[t]);
    box.include(r);
    heights += r.y1 - r.y0;
  }
  const double height = box.y1 - box.y0;
  const int rows =
      static_cast<int>(std::clamp(k_most_segments * height / heights, 64.0, static_cast<double>(wanted_rows)));
  const double step = height / rows;
  const auto row_after = [&](double y) {  // the first row whose middle is at y or above
    return static_cast<std::size_t>(std::clamp(std::ceil((y - box.y0) / step - 0.5), 0.0, static_cast<double>(rows)));
  };
  std::vector<std::size_t> first(static_cast<std::size_t>(rows) + 2, 0);
  const auto each_row = [&](std::uint32_t t, auto visit) {
    const Rectangle r = bounds(triangles[t]);
    const std::size_t end = row_after(r.y1);
    for (std::size_t row = row_after(r.y0); row < end; ++row) visit(row);
  };
  for (const std::uint32_t t : chosen) each_row(t, [&](std::size_t row) { ++first[row + 2]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> in_row(first.back());
  for (const std::uint32_t t : chosen) each_row(t, [&](std::size_t row) { in_row[first[row + 1]++] = t; });

  std::vector<Covered> of_row(static_cast<std::size_t>(rows));
  oneapi::tbb::parallel_for(std::size_t{0}, of_row.size(), [&](std::size_t row) {
    const double y = box.y0 + (static_cast<double>(row) + 0.5) * step;
    std::vector<Segment> segments;
    for (std::size_t i = first[row]; i < first[row + 1]; ++i) segments.push_back(cut_row(triangles[in_row[i]], y));
    of_row[row] = cover(segments);
  });
  Covered total;
  for (const Covered& row : of_row) total.once += step * row.once, total.twice += step * row.twice;
  return total;
}

}  // namespace

UvOverlap find_uv_overlap(const std::vector<UvTriangle>& triangles, int rows) {
  UvOverlap result;
  result.overlaps.assign(triangles.size(), 0);
  const auto groups = groups_of(triangles);
  oneapi::tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    const Hierarchy hierarchy(triangles, groups[g]);
    const auto members = hierarchy.members();
    oneapi::tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t i) {
      result.overlaps[members[i].triangle] = hierarchy.anything_over(members[i]);
    });
  });
  std::vector<std::uint32_t> chosen;
  double alone = 0;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (result.overlaps[t])
      chosen.push_back(t);
    else
      alone += area(triangles[t]);
  }
  if (chosen.empty()) return result;
  const Covered covered = cover_rows(triangles, chosen, rows);
  result.fraction = covered.twice / (alone + covered.once);
  return result;
}

}  // namespace papilla::param_detail
