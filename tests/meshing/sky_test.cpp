// SPDX-License-Identifier: MIT
#include "papilla/meshing/sky.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

/// A disc of n triangles that looks up.
TriangleMesh disc(double radius, double height, int n = 256) {
  TriangleMesh mesh;
  mesh.positions.push_back({0, height, 0});
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    mesh.positions.push_back({radius * std::cos(a), height, radius * std::sin(a)});
    mesh.triangles.push_back({0, static_cast<Index>(1 + (i + 1) % n), static_cast<Index>(1 + i)});
  }
  return mesh;
}

SkyOptions many_rays() {
  SkyOptions options;
  options.rays = 4096;
  return options;
}

TEST(Sky, ATiltedPlaneSeesHalfOfOnePlusItsCosine) {
  const TriangleMesh far = disc(10, -1000);
  const PlacedMesh part{&far};
  const SkyView sky({&part, 1}, many_rays());
  for (const double tilt : {0.0, 30.0, 60.0, 90.0, 120.0, 180.0}) {
    const double b = tilt * std::numbers::pi / 180;
    EXPECT_NEAR(sky({0, 0, 0}, {std::sin(b), std::cos(b), 0}), (1 + std::cos(b)) / 2, 0.005) << tilt;
  }
}

TEST(Sky, ARoundRoofHidesItsShareOfTheHalfSphere) {
  for (const double radius : {200.0, 500.0, 2000.0}) {
    const TriangleMesh roof = disc(radius, 500);
    const PlacedMesh part{&roof};
    const SkyView sky({&part, 1}, many_rays());
    EXPECT_NEAR(sky({0, 0, 0}, {0, 1, 0}), 1 - radius * radius / (radius * radius + 500 * 500), 0.005) << radius;
    EXPECT_DOUBLE_EQ(sky({0, 500, 0}, {0, 1, 0}), 1) << "the roof itself";
    EXPECT_DOUBLE_EQ(sky({0, 500, 0}, {0, -1, 0}), 0) << "its underside";
  }
}

TEST(Sky, PartsThatAreNotOpaqueHideNothing) {
  const TriangleMesh roof = disc(500, 500);
  PlacedMesh part{&roof};
  part.opaque = false;
  EXPECT_DOUBLE_EQ(SkyView({&part, 1})({0, 0, 0}, {0, 1, 0}), 1);
}

TEST(Sky, UpIsWhereTheCallerSaysItIs) {
  const TriangleMesh roof = disc(500, 500);
  const PlacedMesh part{&roof};
  SkyOptions options;
  EXPECT_NEAR(SkyView({&part, 1}, options)({0, 0, 0}, {0, 1, 0}), 0.5, 0.05);
  options.up = {0, -3, 0};
  EXPECT_DOUBLE_EQ(SkyView({&part, 1}, options)({0, 0, 0}, {0, -1, 0}), 1);
  options.up = {};
  EXPECT_THROW(SkyView({&part, 1}, options), InvalidInput);
}

}  // namespace
}  // namespace papilla
