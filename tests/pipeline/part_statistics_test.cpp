// SPDX-License-Identifier: MIT
#include "papilla/pipeline/part_statistics.hpp"

#include <gtest/gtest.h>

#include "io/scene_fixtures.hpp"

namespace papilla {
namespace {

/// The cube stands there twice; one of its twelve triangles is of the second material.
TEST(PartStatistics, TrianglesCountAsOftenAsTheirPartIsUsed) {
  const Scene scene = test::rich_scene();
  EXPECT_EQ(uses_of_parts(scene), (std::vector<std::size_t>{2}));
  EXPECT_EQ(triangles_of_materials(scene), (std::vector<std::size_t>{22, 2}));
}

}  // namespace
}  // namespace papilla
