// SPDX-License-Identifier: MIT
#include "bvh.hpp"

#include <exception>
#include <thread>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr int k_bins = 16;
constexpr int k_sah_depth = 48;         // Halving below adds at most 31 levels, which fits a stack of 96.
constexpr int k_levels_of_threads = 2;  // Up to four threads.
constexpr std::size_t k_least_for_threads = std::size_t{1} << 16;

float centre(const Box3f& box, std::size_t axis) noexcept { return 0.5F * box.low[axis] + 0.5F * box.high[axis]; }

double half_area(const Box3f& box) noexcept {
  const double x = static_cast<double>(box.high[0]) - static_cast<double>(box.low[0]);
  const double y = static_cast<double>(box.high[1]) - static_cast<double>(box.low[1]);
  const double z = static_cast<double>(box.high[2]) - static_cast<double>(box.low[2]);
  return x >= 0 ? x * y + y * z + z * x : 0;
}

struct Split {
  std::size_t axis = 0;
  int bin = 0;
  double cost = std::numeric_limits<double>::infinity();
};

struct Bin {
  Box3f box;
  std::uint32_t count = 0;
};

int bin_of(float c, float low, float scale) noexcept {
  return std::clamp(static_cast<int>((c - low) * scale), 0, k_bins - 1);
}

/// Boxes of the items and of their centres.
struct Extent {
  Box3f all, centres;

  explicit Extent(std::span<const BoxedItem> items) noexcept {
    for (const BoxedItem& item : items) {
      all.add(item.box);
      const std::array<float, 3> c = {centre(item.box, 0), centre(item.box, 1), centre(item.box, 2)};
      centres.add(Box3f{c, c});
    }
  }
};

/// The bins of an axis; none where the centres have no extent.
struct Bins {
  float low = 0, scale = 0;
  std::array<Bin, k_bins> bins{};

  Bins(const Box3f& centres, std::size_t axis) noexcept : low(centres.low[axis]) {
    const float extent = centres.high[axis] - low;
    if (extent > 0 && std::isfinite(static_cast<float>(k_bins) / extent)) scale = static_cast<float>(k_bins) / extent;
  }
  int of(float c) const noexcept { return bin_of(c, low, scale); }
};

/// The cheapest of the 15 planes of one axis by Σ area × count of both sides.
void try_axis(const Bins& axis_bins, std::size_t axis, std::size_t count, Split& best) {
  if (axis_bins.scale == 0) return;
  const auto& bins = axis_bins.bins;
  std::array<double, k_bins> above{};
  Bin sum;
  for (std::size_t i = k_bins - 1; i > 0; --i) {
    sum.box.add(bins[i].box);
    sum.count += bins[i].count;
    above[i] = half_area(sum.box) * sum.count;
  }
  sum = Bin{};
  for (std::size_t i = 0; i + 1 < k_bins; ++i) {
    sum.box.add(bins[i].box);
    sum.count += bins[i].count;
    const double cost = half_area(sum.box) * sum.count + above[i + 1];
    if (sum.count > 0 && sum.count < count && cost < best.cost) best = {axis, static_cast<int>(i), cost};
  }
}

/// Reorders `items` and returns how many belong to the first child.
std::size_t partition_items(std::span<BoxedItem> items, const Box3f& centres, int depth) {
  std::array<Bins, 3> axes = {Bins(centres, 0), Bins(centres, 1), Bins(centres, 2)};
  Split best;
  if (depth < k_sah_depth) {
    for (const BoxedItem& item : items)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Bin& bin = axes[axis].bins[static_cast<std::size_t>(axes[axis].of(centre(item.box, axis)))];
        bin.box.add(item.box);
        ++bin.count;
      }
    for (std::size_t axis = 0; axis < 3; ++axis) try_axis(axes[axis], axis, items.size(), best);
  }
  if (!std::isfinite(best.cost)) return items.size() / 2;
  const Bins& bins = axes[best.axis];
  const auto middle = std::partition(items.begin(), items.end(), [&](const BoxedItem& item) {
    return bins.of(centre(item.box, best.axis)) <= best.bin;
  });
  return static_cast<std::size_t>(middle - items.begin());
}

}  // namespace

/// Nodes of the items, the root first and each first child's nodes before those of the second.
struct Bvh::Build {
  struct Joined {
    std::thread& thread;
    ~Joined() { thread.join(); }
  };
  std::uint32_t leaf_size;
  int most_levels_of_threads;

  /// Appends the children of `node`, and what is below them, for its items from `first` on.
  void branch(LargeArray<Node>& nodes, std::size_t node, std::span<BoxedItem> items, std::uint32_t first,
              int depth) const {
    const Extent extent(items);
    nodes[node].box = extent.all;
    if (items.size() <= leaf_size) {
      nodes[node].first = first;
      nodes[node].count = static_cast<std::uint32_t>(items.size());
      return;
    }
    const std::size_t left = partition_items(items, extent.centres, depth);
    const auto child = nodes.size();
    nodes[node].first = static_cast<std::uint32_t>(child);
    nodes.resize(child + 2);
    const auto middle = static_cast<std::uint32_t>(first + left);
    if (depth >= most_levels_of_threads || items.size() < k_least_for_threads) {
      branch(nodes, child, items.first(left), first, depth + 1);
      branch(nodes, child + 1, items.subspan(left), middle, depth + 1);
      return;
    }
    LargeArray<Node> others(1);
    std::exception_ptr fault;
    {
      std::thread other([&] {
        try {
          branch(others, 0, items.subspan(left), middle, depth + 1);
        } catch (...) {
          fault = std::current_exception();
        }
      });
      const Joined end{other};
      branch(nodes, child, items.first(left), first, depth + 1);
    }
    if (fault) std::rethrow_exception(fault);
    append(nodes, child + 1, others);
  }

  /// The root of `others` becomes `node`, the rest follows.
  static void append(LargeArray<Node>& nodes, std::size_t node, const LargeArray<Node>& others) {
    const std::size_t moved = nodes.size() - 1;
    nodes.resize(moved + others.size());
    for (std::size_t i = 0; i < others.size(); ++i) {
      Node& to = nodes[i == 0 ? node : moved + i];
      to = others[i];
      if (to.count == 0) to.first += static_cast<std::uint32_t>(moved);
    }
  }
};

Bvh::Bvh(std::span<BoxedItem> items, std::uint32_t leaf_size) {
  if (items.size() > (std::size_t{1} << 31)) throw InvalidInput("Bvh: more than 2^31 boxes");
  if (items.empty()) return;
  items_ = static_cast<std::uint32_t>(items.size());
  nodes_.reserve(4 * (items.size() / leaf_size) + 2);
  nodes_.resize(k_root + 1);
  Build{leaf_size, std::thread::hardware_concurrency() > 1 ? k_levels_of_threads : 0}.branch(nodes_, k_root, items, 0,
                                                                                             0);
  nodes_.shrink_to_fit();
}

std::vector<std::uint32_t> Bvh::number_leaves() {
  std::vector<std::uint32_t> begins, open;
  if (!nodes_.empty()) open.push_back(k_root);
  while (!open.empty()) {
    Node& node = nodes_[open.back()];
    open.pop_back();
    if (node.count == 0) {
      open.push_back(node.first + 1);
      open.push_back(node.first);
      continue;
    }
    begins.push_back(std::exchange(node.first, static_cast<std::uint32_t>(begins.size())));
    node.count = 1;
  }
  begins.push_back(items_);
  return begins;
}

}  // namespace papilla
