// SPDX-License-Identifier: MIT
#include "papilla/meshing/stain_transport.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.positions.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh ball(double radius) {
  constexpr int k_around = 48, k_up = 24;
  TriangleMesh mesh;
  for (int j = 0; j <= k_up; ++j)
    for (int i = 0; i < k_around; ++i) {
      const double a = 2 * std::numbers::pi * i / k_around, b = std::numbers::pi * j / k_up;
      mesh.positions.push_back(
          {radius * std::sin(b) * std::cos(a), radius * std::cos(b), radius * std::sin(b) * std::sin(a)});
    }
  for (int j = 0; j < k_up; ++j)
    for (int i = 0; i < k_around; ++i) {
      const auto at = [&](int di, int dj) { return static_cast<Index>((j + dj) * k_around + (i + di) % k_around); };
      if (j > 0) mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      if (j + 1 < k_up) mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  return mesh;
}

/// Mean over a line of points from -width / 2 to width / 2 along x.
double mean_along_x(const StainField& stains, Vec3 middle, double width, const Vec3& normal) {
  double sum = 0;
  for (int k = 0; k < 41; ++k) sum += stains({middle.x + width * (k / 40.0 - 0.5), middle.y, middle.z}, normal);
  return sum / 41;
}

TEST(Stains, RunDownTheSidesOfABoxFromItsEdgeAndFade) {
  const TriangleMesh mesh = box({-50, -50, -50}, {50, 50, 50});
  const PlacedMesh part{&mesh};
  StainOptions options;
  options.run_mm = 30;
  const StainField stains({&part, 1}, options);
  EXPECT_EQ(stains.balance().carried, options.drops) << "all drops fall on the top, which is the scene from above";
  EXPECT_NEAR(stains.balance().deposited + stains.balance().left, stains.balance().carried, 1e-6 * options.drops);
  EXPECT_GT(stains.balance().left, 0);
  // A level top is washed, and what ran off it is spread over four edges of 100 mm: 25 mm of dirt a millimetre.
  EXPECT_EQ(stains({0, 50, 0}, {0, 1, 0}), 0);
  EXPECT_EQ(stains({20, 50, 30}, {0, 1, 0}), 0);
  for (const double depth : {10.0, 20.0, 40.0, 60.0})
    EXPECT_NEAR(mean_along_x(stains, {0, 50 - depth, 50}, 60, {0, 0, 1}), 25 / 30.0 * std::exp(-depth / 30),
                0.25 * 25 / 30.0 * std::exp(-depth / 30))
        << depth;
}

/// A plate with a ledge on its front. The plate stands in x and y, the ledge reaches out to z = 40.
struct Plate {
  TriangleMesh plate = box({-100, -100, -2}, {100, 100, 2}), ledge = box({-30, 0, 1}, {30, 6, 40});
  std::array<PlacedMesh, 2> parts() const { return {PlacedMesh{&plate}, PlacedMesh{&ledge}}; }
};

TEST(Stains, LieUnderALedgeAndNotAboveIt) {
  const Plate scene;
  StainOptions options;
  options.drops = 8000;
  const StainField stains(scene.parts(), options);
  const auto on_plate = [&](double x, double y) { return mean_along_x(stains, {x, y, 2}, 30, {0, 0, 1}); };
  EXPECT_GT(on_plate(0, -15), 3 * on_plate(0, 30)) << "above the ledge";
  EXPECT_GT(on_plate(0, -15), 3 * on_plate(75, -15)) << "beside it";
  EXPECT_GT(on_plate(0, -15), on_plate(0, -70)) << "fading";
  EXPECT_GT(mean_along_x(stains, {0, 3, 40}, 30, {0, 0, 1}), 0) << "the ledge's front";
  EXPECT_NEAR(stains.balance().deposited + stains.balance().left, stains.balance().carried,
              1e-6 * stains.balance().carried);
}

TEST(Stains, TurnWithTheSceneAndItsGravity) {
  const Plate scene;
  Plate turned;
  for (TriangleMesh* mesh : {&turned.plate, &turned.ledge})
    for (Vec3& p : mesh->positions) p = {p.y, -p.x, p.z};
  StainOptions options;
  options.drops = 8000;
  const StainField before(scene.parts(), options);
  options.gravity = {-1, 0, 0};
  const StainField after(turned.parts(), options);
  EXPECT_NEAR(after.balance().carried, before.balance().carried, 0.01 * before.balance().carried);
  EXPECT_NEAR(after.balance().left, before.balance().left, 0.05 * before.balance().carried);
  for (const double y : {-15.0, -40.0}) {
    double turned_mean = 0;
    for (int k = 0; k < 41; ++k) turned_mean += after({y, -30 * (k / 40.0 - 0.5), 2}, {0, 0, 1}) / 41;
    const double mean = mean_along_x(before, {0, y, 2}, 30, {0, 0, 1});
    EXPECT_NEAR(turned_mean, mean, 0.2 * mean) << y;
  }
}

TEST(Stains, OfABallLieRoundItAndGrowTowardsItsSides) {
  const TriangleMesh mesh = ball(50);
  const PlacedMesh part{&mesh};
  const StainField stains({&part, 1});
  const auto ring = [&](double polar) {
    double sum = 0, most = 0;
    for (int k = 0; k < 12; ++k) {
      const double a = 2 * std::numbers::pi * (k + 0.5) / 12, b = polar * std::numbers::pi / 180;
      const Vec3 n{std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a)};
      const double flow = stains(50 * n, n);
      sum += flow / 12, most = std::max(most, flow);
    }
    EXPECT_LT(most, 3 * sum) << "all round at " << polar;
    return sum;
  };
  EXPECT_LT(ring(10), 0.5 * ring(40));
  EXPECT_LT(ring(40), ring(75));
  EXPECT_NEAR(stains.balance().deposited + stains.balance().left, stains.balance().carried,
              1e-6 * stains.balance().carried);
}

TEST(Stains, AreTheSameEveryTimeAndOtherOnesForAnotherSeed) {
  const Plate scene;
  StainOptions options;
  options.drops = 500;
  const StainField a(scene.parts(), options), b(scene.parts(), options);
  options.seed = 2;
  const StainField c(scene.parts(), options);
  bool differs = false;
  for (int y = -90; y < 0; y += 5) {
    EXPECT_EQ(a({0, static_cast<double>(y), 2}, {0, 0, 1}), b({0, static_cast<double>(y), 2}, {0, 0, 1}));
    differs = differs || a({0, static_cast<double>(y), 2}, {0, 0, 1}) != c({0, static_cast<double>(y), 2}, {0, 0, 1});
  }
  EXPECT_TRUE(differs);
}

TEST(Stains, RefuseOptionsOutOfRange) {
  const TriangleMesh mesh = box({0, 0, 0}, {1, 1, 1});
  const PlacedMesh part{&mesh}, missing{};
  const auto refused = [&](StainOptions options) { EXPECT_THROW(StainField({&part, 1}, options), InvalidInput); };
  StainOptions options;
  options.drops = 0;
  refused(options);
  options = {}, options.gravity = {0, 0, 0};
  refused(options);
  options = {}, options.cling = 1.5;
  refused(options);
  options = {}, options.run_mm = -1;
  refused(options);
  EXPECT_THROW(StainField({&missing, 1}), InvalidInput);
  const StainField nothing(std::span<const PlacedMesh>{});
  EXPECT_EQ(nothing({0, 0, 0}, {0, 1, 0}), 0);
}

}  // namespace
}  // namespace papilla
