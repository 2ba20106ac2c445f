// SPDX-License-Identifier: MIT
#include "papilla/io/vertex_welder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

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

TEST(VertexWelder, HasNoToleranceButOneZero) {
  VertexWelder welder;
  EXPECT_EQ(welder.add({1, 0.0, 0}), 0U);
  EXPECT_EQ(welder.add({1, -0.0, 0}), 0U);
  EXPECT_EQ(welder.add({std::nextafter(1.0, 2.0), 0, 0}), 1U);
}

}  // namespace
}  // namespace papilla
