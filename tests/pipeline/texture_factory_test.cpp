// SPDX-License-Identifier: MIT
// Recipes on scenes and as sets of tiles: words of ageing in a configuration, stains that flow, Wang tiles of a recipe.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/pipeline/texture_files.hpp"
#include "papilla/pipeline/weather_scene.hpp"

namespace papilla {
namespace {

WeatherConfig config_of(const test::TemporaryFolder& folder, const std::string& json) {
  std::ofstream(folder / "weather.json") << json;
  return read_weather_config(folder / "weather.json");
}

TEST(WeatherWords, StandForLayers) {
  const test::TemporaryFolder folder;
  const WeatherConfig config =
      config_of(folder, R"({"layers": [{"age": "very rusty, dusty", "materials": ["steel*"]}, {"recipe": "snow"}]})");
  ASSERT_EQ(config.layers.size(), 3U);
  EXPECT_EQ(config.layers[0].recipe, "rust_on|fixtime=true|time=0.850*globaltime");
  EXPECT_EQ(config.layers[1].recipe, "dust|fixtime=true|time=0.600*globaltime");
  EXPECT_EQ(config.layers[1].materials, std::vector<std::string>{"steel*"});
  EXPECT_EQ(config.layers[2].recipe, "snow");
}

TEST(WeatherWords, AreRefusedWithFileAndKey) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& json) -> std::string {
    try {
      config_of(folder, json);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  const std::string unknown = refusal(R"({"layers": [{"age": "rustty"}]})");
  EXPECT_NE(unknown.find("weather.json"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("/layers/0/age"), std::string::npos) << unknown;
  EXPECT_NE(unknown.find("did you mean 'rusty'?"), std::string::npos) << unknown;
  EXPECT_NE(refusal(R"({"layers": [{"age": "rusty", "recipe": "snow"}]})").find("beside a recipe"), std::string::npos);
}

/// A wall of 1 m in x and y that looks along z, with its uv from 0 to 1, and a ledge of 300 mm before its middle.
Scene wall_with_ledge() {
  Part wall;
  wall.name = "wall";
  wall.mesh.positions = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}};
  wall.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  wall.mesh.uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  wall.mesh.uv.indices = wall.mesh.triangles;
  wall.materials = {0};
  Scene scene = single_part_scene(std::move(wall), "test");
  scene.up = UpAxis::y;
  Part ledge;
  ledge.name = "ledge";
  for (int k = 0; k < 8; ++k)
    ledge.mesh.positions.push_back({k & 1 ? 150.0 : -150.0, k & 2 ? 30.0 : 0.0, k & 4 ? 200.0 : -5.0});
  ledge.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  scene.parts.push_back(std::move(ledge));
  Node node;
  node.part = 1;
  scene.nodes.push_back(node);
  scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size() - 1));
  scene.materials.assign(1, Material{});
  scene.materials[0].name = "plaster";
  scene.materials[0].base_color = {1, 1, 1, 1};
  return scene;
}

TEST(WeatherFlow, StainsTheWallBelowALedge) {
  WeatherConfig config;
  config.size = 64;
  config.layers.push_back({"base|colorfunction=black|alphafunction=clampunit(flow*8)", {"*"}});
  const WeatherResult result = weather_scene(wall_with_ledge(), config, 1);
  ASSERT_TRUE(result.materials[0].painted()) << result.materials[0].skipped;
  const Texture& texture = result.scene.textures[result.scene.materials[0].base_color_texture->texture];
  const ColorImage image = decode_color_image(result.scene.images[*texture.image].bytes, "map");
  // One repeat is the wall; row 0 is its upper end. Mean red over a third of the width about u, at a share of the
  // height.
  const auto red = [&](double u, double down) {
    double sum = 0;
    int count = 0;
    for (int x = static_cast<int>((u - 0.08) * image.width); x < static_cast<int>((u + 0.08) * image.width);
         ++x, ++count)
      sum += image.pixels[3 * (static_cast<std::size_t>(down * image.height) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x))];
    return sum / count;
  };
  EXPECT_LT(red(0.5, 0.58), 0.7 * red(0.5, 0.3)) << "above it";
  EXPECT_LT(red(0.5, 0.58), 0.7 * red(0.12, 0.58)) << "beside it";
}

TEST(WangFiles, HaveEightTilesOfEveryChannel) {
  const test::TemporaryFolder folder;
  TextureFileOptions options;
  options.width = options.height = 128;
  options.channels = {Channel::color, Channel::bump, Channel::friction};
  const WangFiles files = write_wang_files("leather", load_recipes({}), folder / "tiles", 0, options);
  EXPECT_EQ(files.side, 32);
  ASSERT_EQ(files.channels.size(), 3U);
  EXPECT_EQ(files.channels[0].file, "wang.color.png");
  EXPECT_EQ(read_color_image(folder / "tiles" / "wang.color.png").width, 128);
  const GreyImage height = read_grey_image(folder / "tiles" / files.channels[1].file);
  EXPECT_EQ(height.width, 128);
  EXPECT_EQ(height.height, 64);
  EXPECT_EQ(read_color_image(folder / "tiles" / files.plane).width, 8 * 32);
  EXPECT_GT(files.channels[1].high, files.channels[1].low);
}

}  // namespace
}  // namespace papilla
