// SPDX-License-Identifier: MIT
#include "papilla/pipeline/environment.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;

/// Radiance by direction, at pixel centres.
template <class Radiance>
EnvironmentPicture environment(int width, const Radiance& radiance) {
  LinearImage image{width, width / 2, {}};
  for (int y = 0; y < width / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const double longitude = 2 * k_pi * ((x + 0.5) / width - 0.5), latitude = k_pi * (0.5 - 2 * (y + 0.5) / width);
      const Vec3 d{std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                   std::cos(latitude) * std::sin(longitude)};
      image.pixels.insert(image.pixels.end(), 3, static_cast<float>(radiance(d)));
    }
  return encode_environment(image);
}

TEST(EnvironmentPicture, KeepsValuesOfAnySizeWithinAStep) {
  const LinearImage image{2, 1, {0.1F, 20.0F, 3000.0F, 1e-6F, 0.0F, 0.999F}};
  const LinearImage back = decode_environment(encode_environment(image));
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(double{back.pixels[i]}, double{image.pixels[i]}, (i < 3 ? 3000.0 : 1.0) / 256);
  EXPECT_EQ(decode_environment(encode_environment({1, 1, {0, 0, 0}})).pixels, (Values<float>{0, 0, 0}));
}

TEST(EnvironmentPicture, TravelsInAMaterial) {
  const EnvironmentPicture picture = environment(16, [](Vec3 d) { return 1 + d.x; });
  Material material;
  material.extras_json = "{\"papilla\":{\"environment\":" + environment_json(picture) + "}}";
  EXPECT_EQ(environment_of(material), picture);
  material.extras_json = "{\"environment\":1}";
  EXPECT_FALSE(environment_of(material));
  material.extras_json = R"({"papilla":{"environment":{"encoding":"rgbe","uri":"data:image/png;base64,AAAA"}}})";
  EXPECT_THROW(environment_of(material), InvalidInput);
}

TEST(EnvironmentPicture, IsTwiceAsWideAsHighAndReducedByMeans) {
  const TemporaryFolder folder("papilla-environment");
  const auto path = folder.path() / "e.png";
  write_color_image(path, {12, 12, Values<unsigned char>(3 * 144, 255)});
  EXPECT_THROW(read_environment(path, 8), InvalidInput);
  ColorImage halves{16, 8, Values<unsigned char>(3 * 128, 0)};
  for (std::size_t i = 0; i < halves.pixels.size(); ++i) halves.pixels[i] = (i / 3) % 2 == 0 ? 255 : 0;
  write_color_image(path, halves);
  const LinearImage reduced = decode_environment(read_environment(path, 8));
  ASSERT_EQ(reduced.width, 8);
  ASSERT_EQ(reduced.height, 4);
  for (const float value : reduced.pixels) EXPECT_NEAR(double{value}, 0.5, 1.0 / 256);
}

TEST(EnvironmentLight, LightsMattSurfacesByTheCosine) {
  // ∫ (1 + d·a) max(0, n·d) dd / π = 1 + 2/3 n·a: both terms lie in the harmonics.
  const Vec3 a = normalized({1, 2, -2});
  const EnvironmentLight light(environment(128, [&](Vec3 d) { return 1 + dot(d, a); }));
  for (const Vec3 n : {a, -a, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}})
    EXPECT_NEAR(light.diffuse(n).x, 1 + 2.0 / 3 * dot(n, a), 0.01);
}

TEST(EnvironmentLight, MirrorsWhatIsThere) {
  const EnvironmentLight light(environment(256, [](Vec3 d) { return d.x > 0 ? 2 + d.y : 0.25; }));
  EXPECT_NEAR(light.reflection(normalized({1, 0.5, 0.3}), 0).x, 2 + normalized({1, 0.5, 0.3}).y, 0.03);
  EXPECT_NEAR(light.reflection({-1, 0, 0}, 0).y, 0.25, 0.01);
  const double rough = light.reflection({0.02, 0, 1}, 1).x;  // At the border of both a rough one shows their mean.
  EXPECT_GT(rough, 0.6);
  EXPECT_LT(rough, 1.8);
}

/// Rows whose light grows by one from each to the next: between them mirrors show what lies between.
TEST(EnvironmentLight, MirrorsShowWhatLiesBetweenPixels) {
  const EnvironmentLight light(environment(16, [](Vec3 d) { return 8 * (0.5 - std::asin(d.y) / k_pi); }));
  for (const double row : {0.5, 1.25, 3.5, 4.75, 7.4})
    for (const double longitude : {-2.0, -0.3, 0.7, 2.9}) {
      const double latitude = k_pi * (0.5 - row / 8);
      const Vec3 d{std::cos(latitude) * std::cos(longitude), std::sin(latitude),
                   std::cos(latitude) * std::sin(longitude)};
      EXPECT_NEAR(light.reflection(d, 0).x, row, 1e-3) << longitude;
    }
}

/// A ball of radius 10 in a material of its own.
Scene ball(const Material& material, UpAxis up) {
  Part part;
  const Index rings = 48, around = 96;
  for (Index i = 0; i <= rings; ++i)
    for (Index j = 0; j < around; ++j) {
      const double polar = k_pi * i / rings, azimuth = 2 * k_pi * j / around;
      const Vec3 n{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
      part.mesh.positions.push_back(10 * n);
      part.mesh.normals.values.push_back(n);
    }
  for (Index i = 0; i < rings; ++i)
    for (Index j = 0; j < around; ++j) {
      const Index a = i * around + j, b = i * around + (j + 1) % around;
      part.mesh.triangles.push_back({a, a + around, b + around});
      part.mesh.triangles.push_back({a, b + around, b});
    }
  part.mesh.normals.indices = part.mesh.triangles;
  part.materials = {0};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.up = up;
  scene.materials = {material};
  return scene;
}

/// Where the picture of a ball is brightest, from its middle, in radii; up is positive.
Vec2 brightest(const ColorImage& image) {
  double x_sum = 0, y_sum = 0, weight = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::size_t i =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
      if (image.pixels[i + 1] < 200 || image.pixels[i] > 40) continue;  // The light is green.
      x_sum += x + 0.5, y_sum += y + 0.5, weight += 1;
    }
  EXPECT_GT(weight, 0);
  const double radius = 0.5 * 0.94 * image.height;
  return {(x_sum / weight - 0.5 * image.width) / radius, (0.5 * image.height - y_sum / weight) / radius};
}

class ChromeBall : public testing::TestWithParam<UpAxis> {};

TEST_P(ChromeBall, IsBrightWhereThePictureIs) {
  Material chrome;
  chrome.metallic = 1, chrome.roughness = 0;
  for (const Vec3 light : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0.6, 0, 0.8}}) {
    EnvironmentPicture picture = environment(256, [&](Vec3 d) { return dot(d, light) > 0.97 ? 5 : 0.001; });
    for (std::size_t i = 0; i < picture.rgbe.size(); i += 4) picture.rgbe[i] = picture.rgbe[i + 2] = 0;
    SceneViewOptions view{.width = 300, .height = 300, .towards_camera = {0, 0, 1}};
    view.environment = std::make_shared<EnvironmentLight>(picture);
    const Vec3 half = normalized(light + Vec3{0, 0, 1});  // Where the ball's normal mirrors it to the camera.
    const auto expect_there = [&](const ColorImage& image) {
      const Vec2 found = brightest(image);
      EXPECT_NEAR(found.x, half.x, 0.08);
      EXPECT_NEAR(found.y, half.y, 0.08);
    };
    expect_there(render_scene(ball(chrome, GetParam()), view));
    Material own = chrome;
    own.extras_json = "{\"papilla\":{\"environment\":" + environment_json(picture) + "}}";
    view.environment = std::make_shared<EnvironmentLight>(environment(16, [](Vec3) { return 0.0; }));
    expect_there(render_scene(ball(own, GetParam()), view));  // Its own goes before the scene's.
  }
}

INSTANTIATE_TEST_SUITE_P(AnyUp, ChromeBall, testing::Values(UpAxis::y, UpAxis::z));

}  // namespace
}  // namespace papilla
