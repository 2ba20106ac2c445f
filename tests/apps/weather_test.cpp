// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "bake/grain_material.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla::app {
namespace {

/// A metre square that looks up over the left half of the uv, and one that looks down over the right half.
Scene two_sides() {
  Part part;
  part.name = "sides";
  part.mesh.positions = {{0, 0, 0},   {1000, 0, 0},   {1000, 1000, 0},   {0, 1000, 0},
                         {0, 0, -50}, {1000, 0, -50}, {1000, 1000, -50}, {0, 1000, -50}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  part.mesh.uv.values = {{0, 0}, {.5, 0}, {.5, 1}, {0, 1}, {.5, 0}, {1, 0}, {1, 1}, {.5, 1}};
  part.mesh.uv.indices = part.mesh.triangles;
  part.materials = {0};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.up = UpAxis::z;
  scene.materials.assign(1, Material{});
  scene.materials[0].name = "paint";
  scene.materials[0].base_color = {0.01, 0.01, 0.01, 1};
  return scene;
}

int red_at(const Scene& scene, double u, double v) {
  const Texture& texture = scene.textures[scene.materials[0].base_color_texture->texture];
  const ColorImage image = decode_color_image(scene.images[*texture.image].bytes, "map");
  const auto x = static_cast<std::size_t>(u * image.width), y = static_cast<std::size_t>(v * image.height);
  return image.pixels[3 * (y * static_cast<std::size_t>(image.width) + x)];
}

TEST(Weather, SnowLiesOnTopAndNotBelow) {
  WeatherConfig config;
  config.size = 64;
  config.layers.push_back({"base|colorfunction=white|alphafunction=clampunit(normaldot)", {"pai*"}});
  const WeatherResult result = weather(two_sides(), config, 1);
  EXPECT_EQ(red_at(result.scene, 0.25, 0.5), 255);
  EXPECT_LT(red_at(result.scene, 0.75, 0.5), 60);
  EXPECT_TRUE(result.materials[0]["normal_dependent"]);
  EXPECT_EQ(result.images, 2);
}

TEST(Weather, LeavesAloneWhatNoLayerFits) {
  WeatherConfig config;
  config.layers.push_back({"dust", {"wood*"}});
  const WeatherResult result = weather(two_sides(), config, 1);
  EXPECT_FALSE(result.scene.materials[0].base_color_texture);
  EXPECT_EQ(result.images, 0);
}

TEST(Weather, ConfigurationErrorsNameTheKey) {
  const auto path =
      std::filesystem::temp_directory_path() / ("papilla-weather-" + std::to_string(::getpid()) + ".json");
  const auto refusal = [&](const std::string& text) {
    std::ofstream(path) << text;
    try {
      read_weather_config(path);
    } catch (const InvalidInput& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal("{\"size\":1}").find("at /size"), std::string::npos);
  EXPECT_NE(refusal("{\"layers\":[{\"recipes\":\"dust\"}]}").find("at /layers/0"), std::string::npos);
  EXPECT_NE(refusal("{").find("no JSON"), std::string::npos);
  EXPECT_EQ(refusal("{\"time\":[0,1],\"layers\":[{\"recipe\":\"dust\"}]}"), "");
  std::filesystem::remove(path);
}

TEST(GrainMaterial, ARecipeStandsWhereAPictureStands) {
  MaterialRule rule;
  rule.name = "seat";
  rule.recipe = "leather|frictionfunction=.42";
  rule.texture = "/nonexistent/leather";
  rule.size_mm[0] = rule.size_mm[1] = 40;
  rule.height.depth_mm = 0.2;
  const Grain grain = make_grain(rule);
  EXPECT_TRUE(grain.relief.periodic);
  EXPECT_NEAR(grain.tag.dynamic_friction, 0.42, 1e-6);
  EXPECT_EQ(grain.report["height"]["method"], "recipe");
  rule.recipe = "leather|seed=x";
  EXPECT_THROW(make_grain(rule), InvalidInput);
}

}  // namespace
}  // namespace papilla::app
