// SPDX-License-Identifier: MIT
#include "bvh.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace papilla {
namespace {

/// Oblong, in a room of 2 × 2 × 0.4.
std::vector<Box3f> random_boxes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> across(-1, 1), size(0, 0.05F);
  std::vector<Box3f> boxes(count);
  for (Box3f& box : boxes)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto place = [&](std::mt19937& r) { return (i == 2 ? 0.2F : 1.0F) * across(r); };
      box.low[i] = place(random);
      box.high[i] = box.low[i] + size(random);
    }
  return boxes;
}

double distance(const Box3f& box, Vec3 p) {
  const double q[3] = {p.x, p.y, p.z};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double low = static_cast<double>(box.low[i]), high = static_cast<double>(box.high[i]);
    const double d = q[i] < low ? low - q[i] : q[i] > high ? q[i] - high : 0;
    sum += d * d;
  }
  return std::sqrt(sum);
}

/// A tree and its items, in the order that queries report.
struct Sorted {
  std::vector<BoxedItem> items;
  Bvh tree;

  explicit Sorted(const std::vector<Box3f>& boxes, std::uint32_t leaf_size = 4) {
    for (const Box3f& box : boxes) items.push_back({box, static_cast<std::uint32_t>(items.size())});
    tree = Bvh(items, leaf_size);
  }
};

TEST(Bvh, HoldsEveryBoxOnce) {
  for (const std::size_t count : {0U, 1U, 4U, 5U, 1000U}) {
    const std::vector<Box3f> boxes = random_boxes(count, 1);
    const Sorted sorted(boxes);
    std::set<std::uint32_t> held;
    for (const auto& [box, item] : sorted.items) {
      held.insert(item);
      EXPECT_EQ(box.low, boxes[item].low);
      EXPECT_EQ(box.high, boxes[item].high);
    }
    EXPECT_EQ(held.size(), count);
    EXPECT_EQ(sorted.tree.empty(), count == 0);
  }
}

TEST(Bvh, LeavesAreNumberedInTheOrderOfTheItems) {
  for (const std::size_t count : {5000U, 300'000U}) {  // The second is built by several threads.
    Sorted sorted(random_boxes(count, 7), 64);
    const std::vector<std::uint32_t> begins = sorted.tree.number_leaves();
    ASSERT_GT(begins.size(), count / 64);
    EXPECT_EQ(begins.front(), 0U);
    EXPECT_EQ(begins.back(), count);
    std::vector<int> visits(begins.size() - 1, 0);
    double radius = 10;
    sorted.tree.within({}, radius, [&](std::uint32_t begin, std::uint32_t end) {
      EXPECT_EQ(end, begin + 1);
      ++visits.at(begin);
    });
    for (std::size_t leaf = 0; leaf < visits.size(); ++leaf) {
      EXPECT_EQ(visits[leaf], 1);
      EXPECT_LT(begins[leaf], begins[leaf + 1]);
      EXPECT_LE(begins[leaf + 1] - begins[leaf], 64U);
    }
  }
}

TEST(Bvh, NeedsLittleMemory) {
  const Sorted sorted(random_boxes(100000, 8), 64);
  EXPECT_LE(sorted.tree.bytes(), 100000U * 2);  // Nodes of 32 bytes, two for each leaf of 32 to 64 items.
}

TEST(Bvh, WithinFindsWhatBruteForceFinds) {
  const auto boxes = random_boxes(2000, 2);
  const auto [items, tree] = Sorted(boxes);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.2, 1.2), radius(0, 0.3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p{place(random), place(random), place(random)};
    double r = radius(random);
    std::set<std::uint32_t> found;
    tree.within(p, r, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) found.insert(items[k].item);
    });
    for (std::uint32_t b = 0; b < boxes.size(); ++b)
      if (distance(boxes[b], p) <= r) {
        EXPECT_TRUE(found.count(b));
      }
  }
}

TEST(Bvh, BoxesThatThreadsShareAreAllFound) {
  const std::vector<Box3f> boxes = random_boxes(300'000, 12);
  const Sorted sorted(boxes, 16);
  const Vec3 centre{0.3, -0.4, 0.1};
  double radius = 0.15;
  std::set<std::uint32_t> found;
  sorted.tree.within(centre, radius, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) found.insert(sorted.items[i].item);
  });
  std::size_t near = 0;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (distance(boxes[i], centre) < radius) {
      ++near;
      EXPECT_TRUE(found.contains(i));
    }
  EXPECT_GT(near, 1000U);
  EXPECT_LT(found.size(), 2 * near);
}

TEST(Bvh, AlongFindsEveryBoxNearTheSegment) {
  const auto boxes = random_boxes(2000, 4);
  const auto [items, tree] = Sorted(boxes);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.2, 1.2);
  for (int i = 0; i < 100; ++i) {
    Vec3 from{place(random), place(random), place(random)}, way{place(random), place(random), place(random)};
    if (i % 4 == 1) way.x = 0;
    if (i % 4 == 2) way.x = way.y = 0;
    if (i % 4 == 3) way = {};
    std::set<std::uint32_t> found;
    double t_max = 1;
    tree.along(from, way, 0.02, t_max, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) found.insert(items[k].item);
    });
    for (std::uint32_t b = 0; b < boxes.size(); ++b)
      for (int s = 0; s <= 50; ++s)
        if (distance(boxes[b], from + (s / 50.0) * way) <= 0.02) {
          EXPECT_TRUE(found.count(b));
        }
  }
}

TEST(Bvh, ThousandsOfEqualBoxesStayWithinTheStack) {
  std::vector<Box3f> boxes(20000);
  for (Box3f& box : boxes) box.low = {0, 0, 0}, box.high = {1, 1, 1};
  const auto [items, tree] = Sorted(boxes);
  std::size_t seen = 0;
  double radius = 1;
  tree.within({0.5, 0.5, 0.5}, radius, [&](std::uint32_t begin, std::uint32_t end) { seen += end - begin; });
  EXPECT_EQ(seen, boxes.size());
}

}  // namespace
}  // namespace papilla
