// SPDX-License-Identifier: MIT
#include "surface/surface_texels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "surface/painted_surface.hpp"

namespace papilla {
namespace {

/// A triangle in a scene with z up, with coordinates of its own on both channels.
Scene one_triangle() {
  Part part;
  part.mesh.positions = {{100, 200, 300}, {400, 200, 300}, {100, 700, 300}};
  part.mesh.triangles = {{0, 1, 2}};
  part.mesh.normals.values = {{0, 0, 1}};
  part.mesh.normals.indices = {{0, 0, 0}};
  part.mesh.uv.values = {{0.1, 0.2}, {0.3, 0.4}, {0.5, 0.7}};
  part.mesh.uv1.values = {{0.9, 0.1}, {0.6, 0.2}, {0.8, 0.5}};
  part.mesh.uv.indices = part.mesh.uv1.indices = part.mesh.triangles;
  part.materials = {0};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.up = UpAxis::z;
  scene.materials.resize(1);
  return scene;
}

TEST(SurfaceOf, PlacesAreInMetresWithYUp) {
  const Scene scene = one_triangle();
  const auto surface = surface_of(scene, instances(scene), 0, nullptr);
  ASSERT_EQ(surface.size(), 1U);
  EXPECT_LT(norm(surface[0].position[1] - Vec3{0.4, 0.3, -0.2}), 1e-12);
  EXPECT_LT(norm(surface[0].position[2] - Vec3{0.1, 0.3, -0.7}), 1e-12);
  EXPECT_LT(norm(normalized(surface[0].normal[0]) - Vec3{0, 1, 0}), 1e-12);
  EXPECT_LT(norm(surface[0].uv[1] - Vec2{0.3, 0.6}), 1e-12);
}

TEST(SurfaceOf, CoordinatesAreThoseOfThePicture) {
  const Scene scene = one_triangle();
  const UvTransform transform{{0.25, 0.5}, 0.4, {2, 3}};
  const TextureReference colour{0, 1, 1, transform};
  const auto surface = surface_of(scene, instances(scene), 0, &colour);
  ASSERT_EQ(surface.size(), 1U);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 place = transform_uv(transform, scene.parts[0].mesh.uv1.values[k]);
    EXPECT_LT(norm(surface[0].uv[k] - Vec2{place.x, 1 - place.y}), 1e-12) << k;
  }
}

TEST(SurfaceTexels, AWindowThatRepeatsGoesOnRoundBothItsBorders) {
  const SurfaceTexels texels(2, 3, 5, 7, true);
  EXPECT_EQ(texels.at(2, 3), 0U);
  EXPECT_EQ(texels.at(1, 3), 4U);
  EXPECT_EQ(texels.at(2, 2), 30U) << "the last row";
  EXPECT_EQ(texels.at(2, 3 + 8), 5U) << "the second row again";
}

TEST(Draw, SurfacesThatDifferInOneDirectionAreUnlike) {
  SurfaceTriangle triangle;
  triangle.uv = {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}};
  triangle.position = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  triangle.normal = {Vec3{0, 0, 1}, Vec3{0, 0, 1}, Vec3{0, 0, 1}};
  SurfaceReading reading;
  reading.position = true;
  for (const Vec3 away : {Vec3{0.1, 0, 0}, Vec3{0, 0.1, 0}, Vec3{0, 0, 0.1}}) {
    SurfaceTexels texels(0, 0, 8, 8, false);
    EXPECT_EQ(draw(texels, triangle, 8, reading), 0U);
    SurfaceTriangle other = triangle;
    EXPECT_EQ(draw(texels, other, 8, reading), 0U);
    for (Vec3& p : other.position) p = p + away;
    EXPECT_GT(draw(texels, other, 8, reading), 10U) << away.x << away.y << away.z;
  }
}

TEST(Grow, CoversTheTexelsOnAllFourSides) {
  SurfaceTexels texels(0, 0, 5, 5, false);
  texels.covered[texels.at(2, 2)] = 1;
  texels.positions[3 * texels.at(2, 2)] = 7;
  grow(texels, 1);
  EXPECT_EQ(std::count(texels.covered.begin(), texels.covered.end(), 1), 5);
  for (const auto& [x, y] : {std::pair{1, 2}, std::pair{3, 2}, std::pair{2, 1}, std::pair{2, 3}}) {
    EXPECT_EQ(texels.covered[texels.at(x, y)], 1) << x << ' ' << y;
    EXPECT_EQ(texels.positions[3 * texels.at(x, y)], 7) << x << ' ' << y;
  }
}

/// A column of texels that runs away from a wall: between the blocks whose sky is known it is linear.
TEST(SkyTexels, AreLinearBetweenRowsOfBlocks) {
  Part wall;
  wall.mesh.positions = {{-50000, -100, 0}, {50000, -100, 0}, {50000, 1000, 0}, {-50000, 1000, 0}};
  wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  wall.materials = {0};
  Scene scene = single_part_scene(std::move(wall), "test");
  scene.up = UpAxis::y;
  scene.materials.resize(1);
  const SkyView sky = sky_of(scene, instances(scene), 256);
  SurfaceTexels texels(0, 0, 8, 24, false);
  std::fill(texels.covered.begin(), texels.covered.end(), static_cast<unsigned char>(1));
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 8; ++x) {
      const std::size_t at = 3 * texels.at(x, y);
      texels.positions[at + 2] = 0.1F * static_cast<float>(y + 1);
      texels.normals[at + 1] = 1;
    }
  const std::vector<float> found = sky_texels(texels, sky);
  std::array<double, 3> block{};  // The first texel of those nearest to the middle stands for a block.
  for (std::size_t b = 0; b < 3; ++b) block[b] = sky({0, 0, 100.0 * (8.0 * static_cast<double>(b) + 4)}, {0, 1, 0});
  ASSERT_GT(block[1], block[0] + 0.02);
  for (const int y : {4, 6, 10, 13, 18}) {
    const double v = (y + 0.5) / 8 - 0.5, share = v - std::floor(v);
    const auto b = static_cast<std::size_t>(v);
    EXPECT_NEAR(double{found[texels.at(1, y)]}, (1 - share) * block[b] + share * block[b + 1], 1e-3) << y;
  }
}

/// A tile of three charts beside one of one chart.
TEST(ChannelRange, TilesCountAsOftenAsTheyAreShown) {
  ChannelRange range;
  range.add(0.2, 3);
  range.add(0.6, 1);
  EXPECT_DOUBLE_EQ(range.mean(), 0.3);
  EXPECT_EQ(range.low, 0.2);
  EXPECT_EQ(range.high, 0.6);
}

}  // namespace
}  // namespace papilla
