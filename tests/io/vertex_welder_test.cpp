// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_welder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace papilla {
namespace {

TEST(VertexWelder, AgreesWithAnOrderedMap) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> small(0, 9);
  std::map<Vec3, Index> expected;
  VertexWelder welder;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p{double(small(random)), double(small(random)), double(small(random))};
    const Index wanted = expected.try_emplace(p, static_cast<Index>(expected.size())).first->second;
    ASSERT_EQ(welder.add(p), wanted);
  }
  for (const auto& [point, number] : expected) EXPECT_EQ(welder.points()[number], point);
}

TEST(VertexWelder, ManyAtOnceAreAsOneByOne) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> small(-20, 20);
  std::vector<Vec3> points(20000);
  for (Vec3& p : points) p = {small(random) * 0.1, small(random) * 1e9, small(random) * -0.0};
  VertexWelder one_by_one, at_once;
  std::vector<Index> numbers(points.size());
  at_once.add(points, numbers);
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(numbers[i], one_by_one.add(points[i]));
  EXPECT_EQ(at_once.points(), one_by_one.points());
}

TEST(VertexWelder, HasNoToleranceButOneZero) {
  VertexWelder welder;
  EXPECT_EQ(welder.add({1, 0.0, 0}), 0U);
  EXPECT_EQ(welder.add({1, -0.0, 0}), 0U);
  EXPECT_EQ(welder.add({std::nextafter(1.0, 2.0), 0, 0}), 1U);
}

}  // namespace
}  // namespace papilla
