// SPDX-License-Identifier: MIT
#include "bvh.hpp"

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr int k_bins = 16;
constexpr int k_sah_depth = 48;  // Halving below adds at most 31 levels, which fits a stack of 96.

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

Bvh::Bvh(std::span<BoxedItem> items, std::uint32_t leaf_size) {
  if (items.size() > (std::size_t{1} << 31)) throw InvalidInput("Bvh: more than 2^31 boxes");
  if (items.empty()) return;
  items_ = static_cast<std::uint32_t>(items.size());
  struct Task {
    std::uint32_t node, first, count;
    int depth;
  };
  nodes_.reserve(4 * (items.size() / leaf_size) + 2);
  nodes_.resize(k_root + 1);
  std::vector<Task> tasks{{k_root, 0, items_, 0}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const std::span<BoxedItem> own = items.subspan(task.first, task.count);
    const Extent extent(own);
    nodes_[task.node].box = extent.all;
    if (task.count <= leaf_size) {
      nodes_[task.node].first = task.first;
      nodes_[task.node].count = task.count;
      continue;
    }
    const auto left = static_cast<std::uint32_t>(partition_items(own, extent.centres, task.depth));
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[task.node].first = child;
    nodes_.resize(nodes_.size() + 2);
    tasks.push_back({child + 1, task.first + left, task.count - left, task.depth + 1});
    tasks.push_back({child, task.first, left, task.depth + 1});
  }
  nodes_.shrink_to_fit();
}

std::vector<std::uint32_t> Bvh::number_leaves() {
  std::vector<std::uint32_t> leaves, begins;
  for (std::uint32_t i = k_root; i < nodes_.size(); ++i)
    if (nodes_[i].count > 0) leaves.push_back(i);
  std::sort(leaves.begin(), leaves.end(),
            [this](std::uint32_t a, std::uint32_t b) { return nodes_[a].first < nodes_[b].first; });
  for (const std::uint32_t leaf : leaves) {
    begins.push_back(std::exchange(nodes_[leaf].first, static_cast<std::uint32_t>(begins.size())));
    nodes_[leaf].count = 1;
  }
  begins.push_back(items_);
  return begins;
}

}  // namespace papilla
