// SPDX-License-Identifier: MIT
#include "neighbourhood.hpp"

#include <gtest/gtest.h>

#include <random>

#include "contact_triangles.hpp"
#include "haptic/contact_shapes.hpp"

namespace papilla {
namespace {

/// Triangles of all shapes around the origin: big and small ones, slivers, near needles.
ContactMesh random_soup(std::uint64_t seed, std::uint32_t triangles) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vec = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  ContactMesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Vec3 a = 0.02 * vec(), b = a + 0.01 * vec();
    const Vec3 c = i % 3 == 0 ? a + 0.01 * vec() : a + 0.7 * (b - a) + (i % 3 == 1 ? 1e-5 : 1e-8) * vec();
    for (const Vec3& p : {a, b, c}) mesh.positions.push_back(p);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

struct Near : ::testing::TestWithParam<double> {
  /// Compares sweeps of up to `longest_m` in a gathered ball of `gathered_m` with those of the tree.
  static void compare(std::uint32_t triangles, double gathered_m, double longest_m) {
    const ContactTriangles surface(random_soup(7, triangles), {ContactMaterial{}}, {}, GetParam());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto vec = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
    auto near = std::make_unique<Neighbourhood>();
    ContactTriangles::KnownFaces known;
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 from = 0.02 * vec(), to = from + (i % 2 == 0 ? 0.1 : 1) * longest_m * vec();
      if (i % 10 == 0) {
        ASSERT_TRUE(surface.gather(from, gathered_m, *near));
      }
      const auto expected = surface.sweep(from, to), found = surface.sweep(from, to, *near, known);
      ASSERT_EQ(expected.has_value(), found.has_value()) << i;
      if (!expected) continue;
      ++hits;
      EXPECT_EQ(expected->t, found->t) << i;
      EXPECT_EQ(expected->penetration_m, found->penetration_m) << i;
      EXPECT_EQ(expected->triangle, found->triangle) << i;
      EXPECT_EQ(expected->normal, found->normal) << i;
      ASSERT_EQ(expected->crease.has_value(), found->crease.has_value()) << i;
      if (!expected->crease) continue;
      EXPECT_EQ(expected->crease->t, found->crease->t) << i;
      EXPECT_EQ(expected->crease->triangle, found->crease->triangle) << i;
    }
    EXPECT_GT(hits, 200);
  }
};

TEST_P(Near, SweepsAsTheTreeDoes) { compare(300, 3e-3, 1e-2); }

TEST_P(Near, SweepsAsTheTreeDoesWhenPrismsAreReplaced) { compare(4000, 0.1, 2e-2); }

TEST_P(Near, SweepsInPiecesAsTheTreeDoesAtOnce) {
  const ContactTriangles surface(random_soup(5, 300), {ContactMaterial{}}, {}, GetParam());
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-0.02, 0.02);
  const auto place = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  auto near = std::make_unique<Neighbourhood>();
  ContactTriangles::KnownFaces known;
  int hits = 0, pieces = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 from = place(), to = place();
    std::optional<SweepHit> found;
    double seen = 0;
    while (!found && seen < 1) {
      ASSERT_TRUE(surface.gather(from + seen * (to - from), 3e-3, *near));
      const double before = seen;
      found = surface.sweep(from, to, *near, known, seen);
      if (!found) {
        ASSERT_GT(seen, before);
      }
      ++pieces;
    }
    const auto expected = surface.sweep(from, to);
    ASSERT_EQ(expected.has_value(), found.has_value()) << i;
    if (!expected) continue;
    ++hits;
    EXPECT_EQ(expected->t, found->t) << i;
    EXPECT_EQ(expected->triangle, found->triangle) << i;
    EXPECT_EQ(expected->normal, found->normal) << i;
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(pieces, 2000);
}

INSTANTIATE_TEST_SUITE_P(Radius, Near, ::testing::Values(0.0, 1e-4, 1e-3));

TEST(Neighbourhood, ReportsWhenItIsFull) {
  const ContactTriangles surface(testing::plate(120, 120, 0.06, 0.06), {ContactMaterial{}}, {}, 0);
  auto near = std::make_unique<Neighbourhood>();
  EXPECT_FALSE(surface.gather({0.03, 0.03, 0}, 0.05, *near));
  EXPECT_EQ(near->blocks(), 0U);
  EXPECT_LT(surface.margin({0.03, 0.03, 0}, *near), 0);
  EXPECT_TRUE(surface.gather({0.03, 0.03, 0}, 0.005, *near));
  EXPECT_GT(near->blocks(), 20U);
  EXPECT_NEAR(surface.margin({0.033, 0.03, 0}, *near), 0.002, 1e-9);
}

}  // namespace
}  // namespace papilla
