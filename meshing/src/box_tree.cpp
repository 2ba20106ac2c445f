// SPDX-License-Identifier: MIT
#include "box_tree.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <limits>

#include "papilla/core/bounds.hpp"

namespace papilla::detail {
namespace {

constexpr int k_bins = 16;
/// Boxes grow by this fraction of the list's extent: what the search in single precision may lose.
constexpr double k_margin = 1e-6;
constexpr Index k_serial_size = 1u << 13;

/// A slanted sliver's box is nearly empty, and those of a fan of slivers all overlap. Where a box is so many times
/// larger than what the triangle covers of its sides, it is replaced by a row of smaller ones [Ernst and Greiner, Early
/// split clipping for bounding volume hierarchies, RT 2007].
constexpr double k_wasteful = 8;
constexpr std::size_t k_most_boxes = 64;  ///< Of one triangle.

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

using Corners = BoxTree::Corners;

/// The box of the part of a triangle with low <= axis <= high, around `centre`.
Reference make_reference(const Corners& corners, int axis, double low, double high, const Vec3& centre, double margin,
                         Index triangle) noexcept {
  constexpr double k_inf = std::numeric_limits<double>::infinity();
  double least[3] = {k_inf, k_inf, k_inf}, most[3] = {-k_inf, -k_inf, -k_inf};
  const auto add = [&](const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], component(p, k));
      most[k] = std::max(most[k], component(p, k));
    }
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % 3];
    const double from = component(a, axis), to = component(b, axis);
    if (from >= low && from <= high) add(a);
    for (const double cut : {low, high})
      if ((from < cut && cut < to) || (to < cut && cut < from)) add(a + ((cut - from) / (to - from)) * (b - a));
  }
  Reference reference;
  reference.triangle = triangle;
  for (int k = 0; k < 3; ++k) {
    const double o = component(centre, k);
    reference.box.low[k] = static_cast<float>(least[k] - o - margin);
    reference.box.high[k] = static_cast<float>(most[k] - o + margin);
  }
  return reference;
}

struct Extent {
  double low[3], high[3];
  explicit Extent(const Corners& c) noexcept {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min({component(c[0], k), component(c[1], k), component(c[2], k)});
      high[k] = std::max({component(c[0], k), component(c[1], k), component(c[2], k)});
    }
  }
  double size(int axis) const noexcept { return high[axis] - low[axis]; }
  int longest_axis() const noexcept {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
      if (size(k) > size(axis)) axis = k;
    return axis;
  }
};

/// Number of boxes to cover a triangle with: as many as still reduce the empty space in them.
std::size_t wanted_boxes(const Corners& c) noexcept {
  const Extent e(c);
  const double box = e.size(0) * e.size(1) + e.size(1) * e.size(2) + e.size(2) * e.size(0);
  const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
  const double covered = 0.5 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  if (!(box > k_wasteful * covered)) return 1;
  const double boxes = box / (k_wasteful * covered);
  return boxes < static_cast<double>(k_most_boxes) ? static_cast<std::size_t>(std::ceil(boxes)) : k_most_boxes;
}

}  // namespace

/// Splits references in two, top down. A subtree over [begin, end) writes its nodes to slots begin ... end - 2, which
/// no other subtree uses; afterwards pairs of levels are folded into nodes of four.
class BoxTreeBuilder {
 public:
  using Node = BoxTree::Node;

  BoxTreeBuilder(std::vector<Reference>& references, Index leaf_size)
      : references_(references), pairs_(references.size()), leaf_size_(leaf_size) {}

  std::vector<Node> run() {
    std::vector<Node> nodes;
    const auto count = static_cast<Index>(references_.size());
    if (count == 0) return nodes;
    nodes.reserve(count / 3 + 1);
    fold(build(0, count, 0), nodes);
    return nodes;
  }

 private:
  struct Subtree {
    Box box;
    std::int64_t child;  ///< Number of a pair, or as in Node a leaf.
  };
  using Pair = std::array<Subtree, 2>;
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

  Box bounds(Index begin, Index end) const noexcept {
    Box box;
    for (Index i = begin; i < end; ++i) box.add(references_[i].box);
    return box;
  }

  Subtree build(Index begin, Index end, int depth) {
    if (end - begin <= leaf_size_) return {bounds(begin, end), leaf(begin, end - begin)};
    const Index middle = partition(begin, end, depth);
    Pair& pair = pairs_[middle - 1];
    const auto build_left = [&] { pair[0] = build(begin, middle, depth + 1); };
    const auto build_right = [&] { pair[1] = build(middle, end, depth + 1); };
    if (end - begin > k_serial_size) {
      oneapi::tbb::parallel_invoke(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
    Subtree tree{pair[0].box, static_cast<std::int64_t>(middle) - 1};
    tree.box.add(pair[1].box);
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
    if (depth < BoxTree::k_sah_depth)
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

  /// Opens the largest inner children until there are four; returns the node's number.
  std::int64_t fold(const Subtree& tree, std::vector<Node>& nodes) const {
    std::array<Subtree, 4> child;
    child[0] = tree;
    std::size_t count = 1;
    while (count < 4) {
      std::size_t widest = count;
      for (std::size_t i = 0; i < count; ++i)
        if (child[i].child >= 0 && (widest == count || child[i].box.half_area() > child[widest].box.half_area()))
          widest = i;
      if (widest == count) break;
      const Pair& pair = pairs_[static_cast<std::size_t>(child[widest].child)];
      child[widest] = pair[0];
      child[count++] = pair[1];
    }
    for (std::size_t i = count; i < 4; ++i) child[i] = {Box{}, leaf(0, 0)};
    const std::size_t place = nodes.size();
    nodes.emplace_back();
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int64_t code = child[i].child < 0 ? child[i].child : fold(child[i], nodes);
      nodes[place].child[i] = code;
      for (int k = 0; k < 3; ++k) {
        nodes[place].low[k][i] = child[i].box.low[k];
        nodes[place].high[k][i] = child[i].box.high[k];
      }
    }
    return static_cast<std::int64_t>(place);
  }

  std::vector<Reference>& references_;
  std::vector<Pair> pairs_;
  Index leaf_size_;
};

BoxTree::BoxTree(std::size_t count, const std::function<Corners(std::size_t)>& corners_of, const Options& options,
                 std::vector<Index>& order) {
  order.clear();
  if (count == 0) return;
  Bounds3 bounds;
  for (std::size_t i = 0; i < count; ++i)
    for (const Vec3& p : corners_of(i)) bounds.add(p);
  centre_ = bounds.middle();
  const Vec3 extent = bounds.size();
  const double margin = k_margin * std::max({extent.x, extent.y, extent.z});

  using Range = oneapi::tbb::blocked_range<std::size_t>;
  std::vector<Index> first(count + 1, 0);  // reference of each triangle
  oneapi::tbb::parallel_for(Range(0, count, k_serial_size), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      first[i + 1] = static_cast<Index>(wanted_boxes(corners_of(i)));
  });
  std::size_t wanted = 0;
  for (const Index boxes : first) wanted += boxes;
  const double share = wanted > count + options.extra_boxes
                           ? static_cast<double>(options.extra_boxes) / static_cast<double>(wanted - count)
                           : 1;
  for (std::size_t i = 1; i < first.size(); ++i)
    first[i] = first[i - 1] + 1 + static_cast<Index>(share * static_cast<double>(first[i] - 1));

  std::vector<Reference> references(first.back());
  oneapi::tbb::parallel_for(Range(0, count, k_serial_size), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Corners corners = corners_of(i);
      const Extent e(corners);
      const int axis = e.longest_axis();
      const Index boxes = first[i + 1] - first[i];
      for (Index b = 0; b < boxes; ++b) {
        const double begin = b == 0 ? e.low[axis] : e.low[axis] + e.size(axis) * b / boxes;
        const double end = b + 1 == boxes ? e.high[axis] : e.low[axis] + e.size(axis) * (b + 1) / boxes;
        references[first[i] + b] = make_reference(corners, axis, begin, end, centre_, margin, static_cast<Index>(i));
      }
    }
  });
  first = {};
  nodes_ = BoxTreeBuilder(references, options.leaf_size).run();
  nodes_.shrink_to_fit();  // With the builder's memory gone.
  order.reserve(references.size());
  for (const Reference& reference : references) order.push_back(reference.triangle);
}

}  // namespace papilla::detail
