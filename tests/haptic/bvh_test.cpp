// SPDX-License-Identifier: MIT
#include "bvh.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace papilla {
namespace {

std::vector<Box3f> random_boxes(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1), size(0, 0.05F);
  std::vector<Box3f> boxes(count);
  for (Box3f& box : boxes)
    for (std::size_t i = 0; i < 3; ++i) {
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

TEST(Bvh, HoldsEveryBoxOnce) {
  for (const std::size_t count : {0U, 1U, 4U, 5U, 1000U}) {
    const Bvh tree(random_boxes(count, 1));
    EXPECT_EQ(std::set<std::uint32_t>(tree.leaf_order().begin(), tree.leaf_order().end()).size(), count);
    EXPECT_EQ(tree.empty(), count == 0);
  }
}

TEST(Bvh, WithinFindsWhatBruteForceFinds) {
  const auto boxes = random_boxes(2000, 2);
  const Bvh tree(boxes);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.2, 1.2), radius(0, 0.3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p{place(random), place(random), place(random)};
    double r = radius(random);
    std::set<std::uint32_t> found;
    tree.within(p, r, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t k = begin; k < end; ++k) found.insert(tree.leaf_order()[k]);
    });
    for (std::uint32_t b = 0; b < boxes.size(); ++b)
      if (distance(boxes[b], p) <= r) {
        EXPECT_TRUE(found.count(b));
      }
  }
}

TEST(Bvh, AlongFindsEveryBoxNearTheSegment) {
  const auto boxes = random_boxes(2000, 4);
  const Bvh tree(boxes);
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
      for (std::uint32_t k = begin; k < end; ++k) found.insert(tree.leaf_order()[k]);
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
  const Bvh tree(boxes);
  std::size_t seen = 0;
  double radius = 1;
  tree.within({0.5, 0.5, 0.5}, radius, [&](std::uint32_t begin, std::uint32_t end) { seen += end - begin; });
  EXPECT_EQ(seen, boxes.size());
}

}  // namespace
}  // namespace papilla
