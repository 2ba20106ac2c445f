// SPDX-License-Identifier: MIT
#include "triangle_bvh.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace papilla::detail {
namespace {

constexpr Index k_leaf_size = 4;
constexpr int k_bins = 16;
constexpr int k_sah_depth = 40;  ///< Deeper levels split in the middle, so that the depth stays below 40 + 32.
constexpr std::size_t k_stack = 80;
constexpr Index k_serial_size = 1u << 13;

struct Box {
  float low[3] = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                  std::numeric_limits<float>::infinity()};
  float high[3] = {-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity()};

  void add(const Box& other) noexcept {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  double half_area() const noexcept {
    const double x = double(high[0]) - double(low[0]), y = double(high[1]) - double(low[1]),
                 z = double(high[2]) - double(low[2]);
    return x >= 0 ? x * y + y * z + z * x : 0;
  }
};

struct Reference {
  Box box;
  Index triangle;
  float centre(int axis) const noexcept { return 0.5f * box.low[axis] + 0.5f * box.high[axis]; }
};

double component(const Vec3& v, int axis) noexcept { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

float rounded_down(double x) noexcept {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float rounded_up(double x) noexcept {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

Reference make_reference(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& centre, Index triangle) noexcept {
  Reference reference;
  reference.triangle = triangle;
  for (int k = 0; k < 3; ++k) {
    const double x = component(a, k), y = component(b, k), z = component(c, k), o = component(centre, k);
    reference.box.low[k] = rounded_down(std::min({x, y, z}) - o);
    reference.box.high[k] = rounded_up(std::max({x, y, z}) - o);
  }
  return reference;
}

}  // namespace

/// Splits references top down. A subtree over [begin, end) writes its nodes to slots begin ... end - 2, which no
/// other subtree uses, and compaction afterwards closes the gaps.
class BvhBuilder {
 public:
  using Node = TriangleBvh::Node;

  BvhBuilder(std::vector<Reference>& references) : references_(references), sparse_(references.size()) {}

  std::vector<Node> run() {
    const auto count = static_cast<Index>(references_.size());
    std::vector<Node> nodes;
    if (count == 0) return nodes;
    const Subtree root = build(0, count, 0);
    nodes.reserve(count / 2 + 1);
    if (root.child >= 0) {
      compact(root.child, nodes);
    } else {  // a lone leaf beside an empty one
      nodes.push_back(make_node(root, {{}, leaf(0, 0)}));
    }
    return nodes;
  }

 private:
  struct Subtree {
    Box box;
    std::int64_t child;
  };
  struct Split {
    double cost;
    int axis = -1;
    float low = 0, scale = 0;
    int bin = 0;
    int bin_of(const Reference& r) const noexcept {
      return std::clamp(static_cast<int>((r.centre(axis) - low) * scale), 0, k_bins - 1);
    }
  };

  static std::int64_t leaf(Index begin, Index count) noexcept {
    return ~((static_cast<std::int64_t>(begin) << 3) | static_cast<std::int64_t>(count));
  }

  static Node make_node(const Subtree& left, const Subtree& right) noexcept {
    Node node;
    for (int k = 0; k < 3; ++k) {
      node.low[k][0] = left.box.low[k];
      node.low[k][1] = right.box.low[k];
      node.high[k][0] = left.box.high[k];
      node.high[k][1] = right.box.high[k];
    }
    node.child[0] = left.child;
    node.child[1] = right.child;
    return node;
  }

  Box bounds(Index begin, Index end) const noexcept {
    Box box;
    for (Index i = begin; i < end; ++i) box.add(references_[i].box);
    return box;
  }

  Subtree build(Index begin, Index end, int depth) {
    if (end - begin <= k_leaf_size) return {bounds(begin, end), leaf(begin, end - begin)};
    const Index middle = partition(begin, end, depth);
    Subtree left, right;
    if (end - begin > k_serial_size)
      oneapi::tbb::parallel_invoke([&] { left = build(begin, middle, depth + 1); },
                                   [&] { right = build(middle, end, depth + 1); });
    else {
      left = build(begin, middle, depth + 1);
      right = build(middle, end, depth + 1);
    }
    sparse_[begin + (middle - begin) - 1] = make_node(left, right);
    Subtree tree{left.box, static_cast<std::int64_t>(middle) - 1};
    tree.box.add(right.box);
    return tree;
  }

  Index partition(Index begin, Index end, int depth) {
    float low[3], high[3];
    for (int k = 0; k < 3; ++k) low[k] = high[k] = references_[begin].centre(k);
    for (Index i = begin + 1; i < end; ++i)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], references_[i].centre(k));
        high[k] = std::max(high[k], references_[i].centre(k));
      }
    Split best{std::numeric_limits<double>::infinity()};
    if (depth < k_sah_depth)
      for (int axis = 0; axis < 3; ++axis)
        if (high[axis] > low[axis]) consider(begin, end, axis, low[axis], high[axis], best);
    const auto first = references_.begin() + begin, last = references_.begin() + end;
    if (best.axis >= 0)
      return static_cast<Index>(
          std::partition(first, last, [&](const Reference& r) { return best.bin_of(r) <= best.bin; }) -
          references_.begin());
    return split_in_the_middle(begin, end, low, high);
  }

  Index split_in_the_middle(Index begin, Index end, const float (&low)[3], const float (&high)[3]) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    const Index middle = begin + (end - begin) / 2;
    std::nth_element(references_.begin() + begin, references_.begin() + middle, references_.begin() + end,
                     [axis](const Reference& a, const Reference& b) {
                       const float x = a.centre(axis), y = b.centre(axis);
                       return x < y || (x <= y && a.triangle < b.triangle);
                     });
    return middle;
  }

  void consider(Index begin, Index end, int axis, float low, float high, Split& best) const {
    Split split{0, axis, low, static_cast<float>(k_bins) / (high - low)};
    if (!std::isfinite(split.scale)) return;
    std::array<Box, k_bins> box;
    std::array<Index, k_bins> count{};
    for (Index i = begin; i < end; ++i) {
      const auto bin = static_cast<std::size_t>(split.bin_of(references_[i]));
      box[bin].add(references_[i].box);
      ++count[bin];
    }
    std::array<double, k_bins> right_cost{};
    Box sweep;
    Index sum = 0;
    for (std::size_t bin = k_bins - 1; bin > 0; --bin) {
      sweep.add(box[bin]);
      sum += count[bin];
      right_cost[bin] = sweep.half_area() * sum;
    }
    sweep = {};
    sum = 0;
    for (std::size_t bin = 0; bin + 1 < k_bins; ++bin) {
      sweep.add(box[bin]);
      sum += count[bin];
      const double cost = sweep.half_area() * sum + right_cost[bin + 1];
      if (sum == 0 || sum == end - begin || !(cost < best.cost)) continue;
      best = split;
      best.cost = cost;
      best.bin = static_cast<int>(bin);
    }
  }

  std::int64_t compact(std::int64_t slot, std::vector<Node>& nodes) const {
    const auto place = nodes.size();
    nodes.push_back(sparse_[static_cast<std::size_t>(slot)]);
    for (std::size_t side = 0; side < 2; ++side) {
      const std::int64_t child = nodes[place].child[side];
      if (child < 0) continue;
      const std::int64_t moved = compact(child, nodes);
      nodes[place].child[side] = moved;
    }
    return static_cast<std::int64_t>(place);
  }

  std::vector<Reference>& references_;
  std::vector<Node> sparse_;
};

TriangleBvh::TriangleBvh(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  constexpr double k_inf = std::numeric_limits<double>::infinity();
  Vec3 low{k_inf, k_inf, k_inf}, high{-k_inf, -k_inf, -k_inf};
  for (const Triangle& t : triangles)
    for (const Index v : t) {
      const Vec3& p = positions[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  if (triangles.empty()) return;
  centre_ = 0.5 * (low + high);

  std::vector<Reference> references(triangles.size());
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, triangles.size(), k_serial_size), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Triangle& t = triangles[i];
      references[i] = make_reference(positions[t[0]], positions[t[1]], positions[t[2]], centre_, static_cast<Index>(i));
    }
  });
  nodes_ = BvhBuilder(references).run();

  prims_.resize(references.size());
  slot_of_.resize(references.size());
  oneapi::tbb::parallel_for(Range(0, references.size(), k_serial_size), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Index index = references[i].triangle;
      const Triangle& t = triangles[index];
      prims_[i] = {TriangleFrame(positions[t[0]], positions[t[1]], positions[t[2]]), index};
      slot_of_[index] = static_cast<Index>(i);
    }
  });
}

ClosestPoint TriangleBvh::closest(const Vec3& p, ClosestPoint best) const noexcept {
  if (nodes_.empty()) return best;
  struct Entry {
    double distance;
    std::int64_t child;
  };
  Entry stack[k_stack];
  std::size_t depth = 0;
  const double q[3] = {p.x - centre_.x, p.y - centre_.y, p.z - centre_.z};

  const auto visit_leaf = [&](std::int64_t code) {
    const auto bits = static_cast<std::size_t>(~code);
    for (std::size_t i = bits >> 3, end = i + (bits & 7); i < end; ++i) {
      const double d = squared_distance(p, prims_[i].frame);
      if (d < best.squared_distance) best = {d, prims_[i].triangle};
    }
  };
  stack[depth++] = {0, 0};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.distance >= best.squared_distance) continue;
    if (entry.child < 0) {
      visit_leaf(entry.child);
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(entry.child)];
    double d[2] = {0, 0};
    for (int k = 0; k < 3; ++k)
      for (int side = 0; side < 2; ++side) {
        const double below = static_cast<double>(node.low[k][side]) - q[k];
        const double above = q[k] - static_cast<double>(node.high[k][side]);
        const double outside = std::max(std::max(below, above), 0.0);
        d[side] += outside * outside;
      }
    const std::size_t near = d[1] < d[0] ? 1 : 0, far = 1 - near;
    if (d[far] < best.squared_distance) stack[depth++] = {d[far], node.child[far]};
    if (d[near] < best.squared_distance) stack[depth++] = {d[near], node.child[near]};
  }
  return best;
}

namespace {

/// Does the open segment a + t d, 0 < t < 1, cut the triangle? [Möller & Trumbore 1997]; parallel ones don't.
bool cuts(const Vec3& a, const Vec3& d, const TriangleFrame& t) noexcept {
  const Vec3 h = cross(d, t.ac);
  const double det = dot(t.ab, h);
  if (!(std::abs(det) > 0)) return false;
  const double inverse = 1 / det;
  const Vec3 s = a - t.a;
  const double u = inverse * dot(s, h);
  if (!(u >= 0 && u <= 1)) return false;
  const Vec3 q = cross(s, t.ab);
  const double v = inverse * dot(d, q);
  if (!(v >= 0 && u + v <= 1)) return false;
  const double along = inverse * dot(t.ac, q);
  return along > 0 && along < 1;
}

}  // namespace

bool TriangleBvh::blocks(const Vec3& a, const Vec3& b, Index ignored) const noexcept {
  if (nodes_.empty()) return false;
  const Vec3 d = b - a;
  const Vec3 start = a - centre_;
  const double origin[3] = {start.x, start.y, start.z};
  // A zero component becomes a huge slope, which the slab test below handles like an infinite one without NaN.
  const auto slope = [](double x) { return std::abs(x) > 1e-300 ? 1 / x : std::copysign(1e300, x); };
  const double inverse[3] = {slope(d.x), slope(d.y), slope(d.z)};

  std::int64_t stack[k_stack];
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int64_t child = stack[--depth];
    if (child < 0) {
      const auto bits = static_cast<std::size_t>(~child);
      for (std::size_t i = bits >> 3, end = i + (bits & 7); i < end; ++i)
        if (prims_[i].triangle != ignored && cuts(a, d, prims_[i].frame)) return true;
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(child)];
    for (int side = 0; side < 2; ++side) {
      double enter = 0, leave = 1;
      for (int k = 0; k < 3; ++k) {
        const double t0 = (static_cast<double>(node.low[k][side]) - origin[k]) * inverse[k];
        const double t1 = (static_cast<double>(node.high[k][side]) - origin[k]) * inverse[k];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
      }
      // The relative slack covers the rounding of the slab products.
      if (enter <= leave * (1 + 1e-12) + 1e-15) stack[depth++] = node.child[side];
    }
  }
  return false;
}

}  // namespace papilla::detail
