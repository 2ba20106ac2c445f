// SPDX-License-Identifier: MIT
#include "papilla/pipeline/weather_scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/height_source.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/texture/normal_map.hpp"

namespace papilla {
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
  const WeatherResult result = weather_scene(two_sides(), config, 1);
  EXPECT_EQ(red_at(result.scene, 0.25, 0.5), 255);
  EXPECT_LT(red_at(result.scene, 0.75, 0.5), 60);
  EXPECT_TRUE(result.materials[0].depends_on_normal);
  EXPECT_FALSE(result.materials[0].atlas.has_value());
  EXPECT_EQ(result.images, 3) << "colour, normals, and roughness";
}

/// Adds a horizontal metre square that looks up (or down) and fills the unit square of uv.
void add_square(TriangleMesh& mesh, double x, double z, bool up) {
  const auto p = static_cast<Index>(mesh.positions.size()), q = static_cast<Index>(mesh.uv.values.size());
  mesh.positions.insert(mesh.positions.end(), {{x, 0, z}, {x + 1000, 0, z}, {x + 1000, 1000, z}, {x, 1000, z}});
  mesh.uv.values.insert(mesh.uv.values.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  for (const Triangle& t : {up ? Triangle{0, 1, 2} : Triangle{0, 2, 1}, up ? Triangle{0, 2, 3} : Triangle{0, 3, 2}}) {
    mesh.triangles.push_back({t[0] + p, t[1] + p, t[2] + p});
    mesh.uv.indices.push_back({t[0] + q, t[1] + q, t[2] + q});
  }
}

Scene scene_of(TriangleMesh mesh) {
  Scene scene = two_sides();
  scene.parts[0].mesh = std::move(mesh);
  return scene;
}

/// Red where the middle of a triangle lies.
int red_of(const Scene& scene, std::size_t part, std::size_t triangle) {
  const CornerAttribute<Vec2>& uv = scene.parts[part].mesh.uv;
  const Vec2 a = uv.values[uv.indices[triangle][0]], b = uv.values[uv.indices[triangle][1]],
             c = uv.values[uv.indices[triangle][2]];
  const Vec2 middle = (1.0 / 3) * (a + b + c);
  return red_at(scene, middle.x, 1 - middle.y);
}

TEST(Weather, FacesThatShareTheirTexelsGetAnAtlas) {
  TriangleMesh mesh;
  add_square(mesh, 0, 0, true), add_square(mesh, 2000, 0, false);
  add_square(mesh, 4000, 0, true), add_square(mesh, 6000, 0, true);
  WeatherConfig config;
  config.size = 64;
  config.layers.push_back({"base|colorfunction=white|alphafunction=clampunit(normaldot)", {"*"}});
  const WeatherResult result = weather_scene(scene_of(mesh), config, 1);
  EXPECT_EQ(red_of(result.scene, 0, 0), 255);
  EXPECT_LT(red_of(result.scene, 0, 2), 60);
  EXPECT_EQ(red_of(result.scene, 0, 4), 255);
  EXPECT_EQ(result.materials[0].atlas.value().charts, 4U);
  EXPECT_EQ(result.materials[0].atlas.value().tiles, 2U) << "three look the same";
  const TriangleMesh& out = result.scene.parts[0].mesh;
  EXPECT_EQ(out.uv1.values.size(), mesh.uv.values.size()) << "the old coordinates are kept";
  for (const Vec2& uv : out.uv.values) EXPECT_TRUE(uv.x >= 0 && uv.y >= 0);
}

TEST(Weather, InstancesOfAPartAreWrittenApartWhenTheyLookUnlike) {
  TriangleMesh mesh;
  add_square(mesh, 0, 0, true);
  Scene scene = scene_of(mesh);
  Node turned;
  turned.part = 0;
  turned.local = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
  scene.nodes.push_back(turned), scene.roots.push_back(1);
  Node again;
  again.part = 0;
  again.local[3] = 5000;
  scene.nodes.push_back(again), scene.roots.push_back(2);
  WeatherConfig config;
  config.size = 32;
  config.layers.push_back({"base|colorfunction=white|alphafunction=clampunit(normaldot)", {"*"}});
  const WeatherResult result = weather_scene(scene, config, 1);
  ASSERT_EQ(result.scene.parts.size(), 2U);
  EXPECT_EQ(red_of(result.scene, *result.scene.nodes[0].part, 0), 255);
  EXPECT_LT(red_of(result.scene, *result.scene.nodes[1].part, 0), 60);
  EXPECT_EQ(result.scene.nodes[2].part, result.scene.nodes[0].part);
}

TEST(Weather, NoSnowBelowARoof) {
  TriangleMesh mesh;  // A table, a roof 300 mm above it, and a table in the open.
  add_square(mesh, 0, 0, true), add_square(mesh, 0, 300, true), add_square(mesh, 20000, 0, true);
  WeatherConfig config;
  config.size = 32;
  config.layers.push_back({"base|colorfunction=white|alphafunction=sky", {"*"}});
  const WeatherResult result = weather_scene(scene_of(mesh), config, 1);
  EXPECT_TRUE(result.materials[0].depends_on_sky);
  EXPECT_LT(red_of(result.scene, 0, 0), 120);
  EXPECT_EQ(red_of(result.scene, 0, 2), 255);
  EXPECT_GT(red_of(result.scene, 0, 4), 250);
}

TEST(Weather, TheTexelsOfAPictureRunDownItsRows) {
  TriangleMesh mesh;
  add_square(mesh, 0, 0, true);
  WeatherConfig config;
  config.size = 32;
  // Scene (x, y, z up) is (x, z, -y) in the recipe's axes.
  config.layers.push_back({"base|colorfunction=white|alphafunction=step(-posz,.5)", {"*"}});
  const WeatherResult result = weather_scene(scene_of(mesh), config, 1);
  EXPECT_EQ(red_at(result.scene, 0.5, 0.1), 255) << "the top row is v = 1, y = 1 m";
  EXPECT_LT(red_at(result.scene, 0.5, 0.9), 60);
}

TEST(Weather, PaintsOnlyWhatChanged) {
  Scene scene = two_sides();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "wood";
  scene.parts.push_back(scene.parts[0]);
  scene.parts[1].materials = {1};
  Node node;
  node.part = 1;
  scene.nodes.push_back(node), scene.roots.push_back(1);
  WeatherConfig config;
  config.size = 16;
  config.layers = {{"dust", {"wood"}}, {"rust_on", {"paint"}}};
  WeatherCache cache;
  EXPECT_EQ(weather_scene(scene, config, 0.5, cache).painted, 2);
  EXPECT_EQ(weather_scene(scene, config, 0.5, cache).painted, 0);
  EXPECT_EQ(weather_scene(scene, config, 0.6, cache).painted, 2);
  config.layers[0].recipe = "dust|scale=.1";
  const WeatherResult cached = weather_scene(scene, config, 0.5, cache);
  EXPECT_EQ(cached.painted, 1);
  const WeatherResult fresh = weather_scene(scene, config, 0.5);
  ASSERT_EQ(cached.scene.images.size(), fresh.scene.images.size());
  for (std::size_t i = 0; i < fresh.scene.images.size(); ++i)
    EXPECT_EQ(cached.scene.images[i].bytes, fresh.scene.images[i].bytes);
}

/// The material's normal map, as it is shown.
ColorImage normals_of(const Scene& scene) {
  const Texture& texture = scene.textures[scene.materials[0].normal_texture->texture];
  return decode_color_image(scene.images[*texture.image].bytes, "map");
}

/// A metre square over the unit square of uv with a normal map of waves of 0.5 m.
Scene waves(const HeightMap& relief) {
  TriangleMesh mesh;
  add_square(mesh, 0, 0, true);
  Scene scene = scene_of(mesh);
  EncodedImage image;
  image.name = "waves", image.mime_type = "image/png", image.bytes = encode_png(normal_map(relief));
  scene.images.push_back(std::move(image));
  scene.textures.push_back({});
  scene.textures.back().image = 0;
  scene.materials[0].normal_texture = TextureReference{};
  return scene;
}

TEST(Weather, TheOwnReliefIsTheFirstLayer) {
  HeightMap relief{64, 64, Values<float>(64 * 64), 1000.0 / 64, 1000.0 / 64, true};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) relief.at(x, y) = static_cast<float>(20 * std::sin(2 * std::numbers::pi * x / 32));
  const Scene scene = waves(relief);
  const ColorImage own = normal_map(relief);
  WeatherConfig config;
  config.size = 64, config.depth_mm = 50;
  // A layer that only colours leaves the relief as it was.
  config.layers = {{"base|bumpblend=off|colorfunction=white", {"*"}}};
  const WeatherResult coloured = weather_scene(scene, config, 1);
  EXPECT_TRUE(coloured.materials[0].own_relief);
  const ColorImage kept = normals_of(coloured.scene);
  ASSERT_EQ(kept.pixels.size(), own.pixels.size());
  for (std::size_t i = 0; i < own.pixels.size(); ++i) EXPECT_NEAR(kept.pixels[i], own.pixels[i], 2) << i;
  // One that covers half of it flattens that half, away from its border.
  config.layers = {{"base|bumpblend=interpolate|bumpfunction=.5|alphafunction=step(x,.5)", {"*"}}};
  const ColorImage half = normals_of(weather_scene(scene, config, 1).scene);
  for (int x = 2; x < 30; ++x)
    EXPECT_NEAR(half.pixels[3 * static_cast<std::size_t>(x)], own.pixels[3 * static_cast<std::size_t>(x)], 3);
  for (int x = 34; x < 62; ++x) EXPECT_EQ(half.pixels[3 * static_cast<std::size_t>(x)], 128);
  // And layers read it: only what lies low is covered.
  config.layers = {
      {"base|bumpblend=off|colorfunction=white|alphafunction=step(nearmean(lowerbump,.4),lowerbump+.2)", {"*"}}};
  const WeatherResult dirty = weather_scene(scene, config, 1);
  EXPECT_LT(red_at(dirty.scene, 8.5 / 64, 0.5), 60);
  EXPECT_EQ(red_at(dirty.scene, 24.5 / 64, 0.5), 255);
}

TEST(Weather, TheNewReliefIsFelt) {
  HeightMap relief{32, 32, Values<float>(32 * 32), 1000.0 / 32, 1000.0 / 32, true};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) relief.at(x, y) = static_cast<float>(20 * std::sin(2 * std::numbers::pi * x / 32));
  Scene scene = waves(relief);
  MaterialTag tag;
  tag.height = HeightTag{};
  scene.materials[0].haptic = tag;
  WeatherConfig config;
  config.size = 32, config.depth_mm = 50;
  // Half of the surface is filled up to 15 mm: (0.8 - 0.5) 50.
  config.layers = {{"base|bumpblend=interpolate|bumpfunction=max(lowerbump,.8)|alphafunction=step(.5,y)", {"*"}}};
  const Scene aged = weather_scene(scene, config, 1).scene;
  const std::optional<MaterialTag>& felt = aged.materials[0].haptic;
  ASSERT_TRUE(felt && felt->height);
  EXPECT_EQ(felt->height->size, (std::array<int, 2>{32, 32}));
  EXPECT_NEAR(felt->height->metres_per_uv.x, 1, 1e-9);
  EXPECT_NEAR(felt->height->offset_m, -0.020, 0.001) << "the lowest place of the other half";
  EXPECT_NEAR(felt->height->offset_m + felt->height->scale_m, 0.020, 0.001);
  EXPECT_GT(felt->height->rms_m, 0.008);
  // A material without a tag stays without, and a map on coordinates of its own stays.
  scene.materials[0].haptic.reset();
  EXPECT_FALSE(weather_scene(scene, config, 1).scene.materials[0].haptic);
  tag.height->sha256 = std::string(64, '0');
  scene.materials[0].haptic = tag;
  scene.materials[0].normal_texture.reset();
  EXPECT_EQ(weather_scene(scene, config, 1).scene.materials[0].haptic.value().height.value().sha256,
            tag.height->sha256);
}

/// Rust that grips on one half, dust that slips on the other: the hand feels either where it is.
TEST(Weather, FrictionAndStiffnessAreFeltWhereTheyAre) {
  Scene scene = waves({32, 32, Values<float>(32 * 32), 1000.0 / 32, 1000.0 / 32, true});
  MaterialTag tag;
  tag.stiffness = 600;
  tag.static_friction = 0.5, tag.dynamic_friction = 0.4;
  scene.materials[0].haptic = tag;
  WeatherConfig config;
  config.size = 32;
  config.layers = {{"base|bumpblend=off|frictionfunction=.8|stiffnessfunction=1.5|alphafunction=step(x,.5)", {"*"}},
                   {"base|bumpblend=off|frictionfunction=.1|stiffnessfunction=.5|alphafunction=step(.5,x)", {"*"}}};
  const WeatherResult aged = weather_scene(scene, config, 1);
  const MaterialTag& felt = aged.scene.materials[0].haptic.value();
  ASSERT_TRUE(felt.maps);
  EXPECT_EQ(felt.maps->channels[0].value().quantity, Quantity::stiffness);
  EXPECT_NEAR(felt.maps->channels[0]->least(), 300, 1e-3);
  EXPECT_NEAR(felt.maps->channels[0]->most(), 900, 1e-3);
  EXPECT_EQ(felt.maps->channels[1].value().quantity, Quantity::dynamic_friction);
  EXPECT_NEAR(felt.dynamic_friction, 0.45, 1e-3) << "the mean, for where the map is lost";
  EXPECT_NEAR(felt.static_friction, 0.45 * 0.5 / 0.4, 1e-3);
  std::vector<HapticWarning> warnings;
  const auto maps = find_maps(*felt.maps, aged.scene, "aged.glb", 0, warnings);
  ASSERT_TRUE(maps && warnings.empty());
  for (const double u : {0.25, 0.75}) {
    ContactConstants there;
    there.static_friction = felt.static_friction, there.dynamic_friction = felt.dynamic_friction;
    maps->apply({u, 0.5}, there);
    EXPECT_NEAR(there.dynamic_friction, u < 0.5 ? 0.1 : 0.8, 2e-3) << u;  // step(x, .5) is 1 where x >= .5.
    EXPECT_NEAR(there.static_friction, there.dynamic_friction * 0.5 / 0.4, 2e-3) << u;
    EXPECT_NEAR(there.stiffness, u < 0.5 ? 300 : 900, 3) << u;
  }
  // Where nothing differs there is no map; a second ageing says that it takes the first one for constant.
  config.layers = {{"base|bumpblend=off|frictionfunction=.8", {"*"}}};
  EXPECT_FALSE(weather_scene(scene, config, 1).scene.materials[0].haptic.value().maps);
  const WeatherResult again = weather_scene(aged.scene, config, 1);
  EXPECT_FALSE(again.scene.materials[0].haptic.value().maps);
  EXPECT_TRUE(std::any_of(again.scene.losses.begin(), again.scene.losses.end(),
                          [](const std::string& loss) { return loss.find("its own maps") != std::string::npos; }));
}

/// Factor times picture of a channel (0 to 3) of a reference of the first material.
double shown_at(const Scene& scene, const std::optional<TextureReference>& reference, std::size_t channel, double u,
                double factor) {
  if (!reference) return factor;
  const RgbaImage image = decode_rgba_image(scene, *scene.textures[reference->texture].image);
  const auto x = static_cast<std::size_t>(u * image.width), y = static_cast<std::size_t>(image.height / 2);
  return factor * image.pixels[4 * (y * static_cast<std::size_t>(image.width) + x) + channel] / 255;
}
double roughness_at(const Scene& scene, double u) {
  const Material& m = scene.materials[0];
  return shown_at(scene, m.metallic_roughness_texture, 1, u, m.roughness);
}
double metallic_at(const Scene& scene, double u) {
  const Material& m = scene.materials[0];
  return shown_at(scene, m.metallic_roughness_texture, 2, u, m.metallic);
}
double alpha_at(const Scene& scene, double u) {
  const Material& m = scene.materials[0];
  return shown_at(scene, m.base_color_texture, 3, u, m.base_color[3]);
}

WeatherConfig one_layer(const std::string& recipe) {
  WeatherConfig config;
  config.size = 32;
  config.layers = {{recipe, {"*"}}};
  return config;
}

TEST(Weather, AConstantRecipeIsAConstantRoughness) {
  const Scene scene = weather_scene(two_sides(), one_layer("base|roughnessfunction=.3|reflectionfunction=.7"), 1).scene;
  EXPECT_FALSE(scene.materials[0].metallic_roughness_texture);
  EXPECT_NEAR(scene.materials[0].roughness, 0.3, 1e-6);
  EXPECT_NEAR(scene.materials[0].metallic, 0.7, 1e-6);
  // A highlight of n = 30 is a roughness of 1/2.
  EXPECT_NEAR(weather_scene(two_sides(), one_layer("base|specularfunction=1|specularcoefffunction=30"), 1)
                  .scene.materials[0]
                  .roughness,
              0.5, 1e-6);
  // What does not cover leaves the own ones.
  const Scene own = weather_scene(two_sides(), one_layer("base|alphafunction=0"), 1).scene;
  EXPECT_NEAR(own.materials[0].roughness, 0.8, 1e-6);
  EXPECT_EQ(own.materials[0].metallic, 0);
  EXPECT_EQ(own.materials[0].alpha_mode, "OPAQUE");
}

TEST(Weather, WetIsShinyWhereItLies) {
  Scene scene = two_sides();
  scene.materials[0].roughness = 0.9;
  // The cover of wetness, whose scale is 0.9, is cut in half: u < 1/2 stays dry.
  const WeatherResult wet = weather_scene(scene, one_layer("wetness|alphafunction=.85*step(x,.5/.9)"), 1);
  for (const double u : {0.1, 0.3, 0.45}) EXPECT_NEAR(roughness_at(wet.scene, u), 0.9, 0.003) << u;
  const double film = std::pow(2 / (0.9 * 122), 0.25);
  for (const double u : {0.55, 0.9}) EXPECT_NEAR(roughness_at(wet.scene, u), 0.15 * 0.9 + 0.85 * film, 0.003) << u;
  EXPECT_EQ(metallic_at(wet.scene, 0.75), 0);
  // And the recipe as it is, at time 1: nowhere rougher, and shiny somewhere.
  const WeatherResult worn = weather_scene(scene, one_layer("wetness"), 1);
  EXPECT_LT(worn.materials[0].roughness, 0.7);
  for (double u = 0.01; u < 1; u += 0.07) EXPECT_LE(roughness_at(worn.scene, u), 0.904);
}

TEST(Weather, ChromeBelowRustStaysMetalWhereTheRustIsNot) {
  Scene scene = two_sides();
  scene.materials[0].metallic = 1, scene.materials[0].roughness = 0.1;
  scene.materials[0].haptic.emplace().dynamic_friction = 0.2;
  const Scene rusty = weather_scene(scene, one_layer("rust_on|alphafunction=step(x,.5/.45)"), 1).scene;
  for (const double u : {0.05, 0.25, 0.48}) {
    EXPECT_EQ(metallic_at(rusty, u), 1) << u;
    EXPECT_NEAR(roughness_at(rusty, u), 0.1, 0.003) << u;
  }
  for (const double u : {0.52, 0.75, 0.95}) {
    EXPECT_EQ(metallic_at(rusty, u), 0) << u;
    EXPECT_EQ(roughness_at(rusty, u), 1) << u;
  }
  EXPECT_EQ(rusty.materials[0].roughness, 1) << "the picture has it all";
  const std::vector<std::optional<MapChannel>> channels(rusty.materials[0].haptic->maps.value().channels.begin(),
                                                        rusty.materials[0].haptic->maps->channels.end());
  const auto friction = std::find_if(channels.begin(), channels.end(), [](const auto& channel) {
    return channel && channel->quantity == Quantity::dynamic_friction;
  });
  ASSERT_NE(friction, channels.end());
  EXPECT_NEAR((*friction)->least(), 0.2, 1e-3);
  EXPECT_NEAR((*friction)->most(), 0.8, 1e-3);
}

TEST(Weather, DampingIsFeltWhereItIs) {
  Scene scene = two_sides();
  scene.materials[0].haptic.emplace().damping = 0.4;
  const WeatherResult soft = weather_scene(scene, one_layer("base|dampingfunction=1+step(x,.5)"), 1);
  const MaterialTag& tag = soft.scene.materials[0].haptic.value();
  ASSERT_TRUE(tag.maps);
  const auto channel = std::find_if(tag.maps->channels.begin(), tag.maps->channels.end(),
                                    [](const auto& c) { return c && c->quantity == Quantity::damping; });
  ASSERT_NE(channel, tag.maps->channels.end());
  EXPECT_NEAR((*channel)->least(), 0.4, 1e-3);
  EXPECT_NEAR((*channel)->most(), 0.8, 1e-3);
  EXPECT_NEAR(tag.damping, 0.6, 1e-3);
  EXPECT_NEAR(soft.materials[0].damping, 1.5, 1e-3);
}

TEST(Weather, LayersLieOverTheOwnMetallicRoughnessPicture) {
  Scene scene = two_sides();
  EncodedImage image;
  image.name = "shine", image.mime_type = "image/png";
  image.bytes = encode_png(ColorImage{2, 1, {0, 51, 255, 0, 204, 0}});
  scene.images.push_back(std::move(image));
  scene.textures.push_back({});
  scene.textures.back().image = 0;
  scene.materials[0].metallic_roughness_texture = TextureReference{};
  scene.materials[0].roughness = 0.5, scene.materials[0].metallic = 1;
  const Scene seen = weather_scene(scene, one_layer("base|alphafunction=0"), 1).scene;
  EXPECT_NEAR(roughness_at(seen, 0.25), 0.1, 0.01) << "the middle of the first texel: 51/255 half";
  EXPECT_NEAR(roughness_at(seen, 0.75), 0.4, 0.01);
  EXPECT_NEAR(metallic_at(seen, 0.25), 1, 0.04);
  EXPECT_NEAR(metallic_at(seen, 0.75), 0, 0.04);
  // On other coordinates than the colour only its mean is known, and that is said.
  scene.materials[0].base_color_texture = TextureReference{};
  scene.materials[0].metallic_roughness_texture->tex_coord = 1;
  const WeatherResult mean = weather_scene(scene, one_layer("base|alphafunction=0"), 1);
  EXPECT_NEAR(mean.scene.materials[0].roughness, 0.25, 0.003);
  EXPECT_NEAR(mean.scene.materials[0].metallic, 0.5, 0.003);
  ASSERT_EQ(mean.scene.losses.size(), 1U);
  EXPECT_NE(mean.scene.losses[0].find("metallic-roughness picture"), std::string::npos);
}

TEST(Weather, HolesAreSeenThrough) {
  const Scene pierced = weather_scene(two_sides(), one_layer("base|alphablend=cut|alphafunction=step(x,.5)"), 1).scene;
  EXPECT_EQ(pierced.materials[0].alpha_mode, "MASK");
  EXPECT_EQ(pierced.materials[0].base_color[3], 1);
  EXPECT_EQ(alpha_at(pierced, 0.25), 1);
  EXPECT_EQ(alpha_at(pierced, 0.75), 0);
  // Glass is seen through where nothing lies on it.
  Scene glass = two_sides();
  glass.materials[0].alpha_mode = "BLEND", glass.materials[0].base_color[3] = 0.2;
  const Scene dirty = weather_scene(glass, one_layer("base|alphafunction=step(x,.5)*.5"), 1).scene;
  EXPECT_EQ(dirty.materials[0].alpha_mode, "BLEND");
  EXPECT_NEAR(alpha_at(dirty, 0.25), 0.2, 0.003);
  EXPECT_NEAR(alpha_at(dirty, 0.75), 0.6, 0.003);
}

TEST(Weather, DiffuseScalesWhatIsNoMetal) {
  const auto red = [&](const std::string& more) {
    return red_at(weather_scene(two_sides(), one_layer("base|colorfunction=white" + more), 1).scene, 0.25, 0.5);
  };
  EXPECT_EQ(red("|diffusefunction=.5"), 188) << "half of the light";
  EXPECT_EQ(red("|diffusefunction=.5|reflectionfunction=1"), 255);
}

TEST(Weather, MapsTileWhereTheUvLeaveTheRepeat) {
  TriangleMesh mesh;
  add_square(mesh, 0, 0, true);
  for (Vec2& uv : mesh.uv.values) uv = 3.0 * uv;
  WeatherConfig config;
  config.size = 64;
  config.layers = {{"base|bumpblend=off|colorfunction=rgb(main,main,main)|mainfunction=x", {"*"}}};
  const Scene scene = weather_scene(scene_of(mesh), config, 1).scene;
  EXPECT_NEAR(red_at(scene, 0.5 / 64, 0.5), red_at(scene, 63.5 / 64, 0.5), 6);
  EXPECT_NEAR(red_at(scene, 0.25, 0.5), red_at(scene, 0.75, 0.5), 6) << "the ramp's four corners are blended";
}

TEST(Weather, TimeStepsShareTheSurface) {
  WeatherConfig config;
  config.size = 16;
  config.layers = {{"snow", {"*"}}};
  WeatherCache cache;
  const Scene scene = two_sides();
  weather_scene(scene, config, 0.2, cache);
  EXPECT_EQ(cache.surfaces(), 1U);
  const WeatherResult later = weather_scene(scene, config, 0.9, cache);
  EXPECT_EQ(cache.surfaces(), 1U);
  const WeatherResult alone = weather_scene(scene, config, 0.9);
  EXPECT_EQ(later.scene.images.back().bytes, alone.scene.images.back().bytes);
  config.layers = {{"base|alphafunction=normaldot", {"*"}}};
  weather_scene(scene, config, 0.9, cache);
  EXPECT_EQ(cache.surfaces(), 2U) << "another reading";
}

TEST(Weather, KnowsTheFilesItRestsOnAndPaintsAnewWhenAPictureChanges) {
  const papilla::TemporaryFolder folder("papilla-weather");
  std::ofstream(folder.path() / "one.recipes") << "include two.recipes\n";
  std::ofstream(folder.path() / "two.recipes") << "dots image|picpath=dots.png\n";
  const auto picture = [&](unsigned char grey, int side) {
    write_color_image(folder.path() / "dots.png",
                      {side, side, Values<unsigned char>(3 * static_cast<std::size_t>(side * side), grey)});
  };
  picture(255, 1);
  WeatherConfig config;
  config.size = 16, config.folder = folder.path(), config.libraries = {"one.recipes"};
  config.layers = {{"dots", {"*"}}};
  WeatherCache cache;
  const Scene scene = two_sides();
  EXPECT_EQ(red_at(weather_scene(scene, config, 1, cache).scene, 0.25, 0.5), 255);
  for (const char* name : {"one.recipes", "two.recipes", "dots.png"})
    EXPECT_TRUE(cache.files().contains(folder.path() / name)) << name;
  EXPECT_EQ(weather_scene(scene, config, 1, cache).painted, 0);
  picture(0, 4);
  const WeatherResult again = weather_scene(scene, config, 1, cache);
  EXPECT_EQ(again.painted, 1);
  EXPECT_EQ(red_at(again.scene, 0.25, 0.5), 0);
  // What can't be read is watched, too.
  config.libraries = {"missing.recipes"};
  EXPECT_THROW(weather_scene(scene, config, 1, cache), IoError);
  EXPECT_TRUE(cache.files().contains(folder.path() / "missing.recipes"));
}

TEST(Weather, FilesThatItsRecipesNameLieInTheFolderOfTheConfiguration) {
  const papilla::TemporaryFolder folder("papilla-weather");
  std::filesystem::create_directory(folder / "inside");
  std::ofstream(folder / "out.recipes") << "dots image|picpath=out.png\n";
  write_color_image(folder / "out.png", {1, 1, {9, 9, 9}});
  WeatherConfig config;
  config.size = 16, config.folder = folder / "inside", config.source = "c.json";
  const auto refusal = [&] {
    try {
      weather_scene(two_sides(), config, 1);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  config.layers = {{"image|picpath=../out.png", {"*"}}};
  EXPECT_NE(refusal().find("'../out.png' leads out of the folder"), std::string::npos) << refusal();
  config.layers = {{"dots", {"*"}}};
  config.libraries = {"../out.recipes"};
  EXPECT_NE(refusal().find("c.json: at /libraries/0: '../out.recipes' leads out"), std::string::npos) << refusal();
}

TEST(Weather, LeavesAloneWhatNoLayerFits) {
  WeatherConfig config;
  config.layers.push_back({"dust", {"wood*"}});
  const WeatherResult result = weather_scene(two_sides(), config, 1);
  EXPECT_FALSE(result.scene.materials[0].base_color_texture);
  EXPECT_EQ(result.images, 0);
}

/// Two squares of one material, side by side, shown by the nodes "left" and "right" below "table".
Scene table() {
  TriangleMesh mesh;
  add_square(mesh, 0, 0, true);
  Scene scene = scene_of(mesh);
  scene.parts[0].name = "top";
  Node left, right, root;
  left.name = "left", left.part = 0;
  right.name = "right", right.part = 0;
  right.local[3] = 5000;
  root.name = "table", root.children = {1, 2};
  scene.nodes = {root, left, right};
  scene.roots = {0};
  assign_part_ids(scene);
  return scene;
}

int red_of_use(const Scene& scene, std::uint32_t node) {
  const Part& part = scene.parts[scene.nodes[node].part.value()];
  const Material& material = scene.materials[part.materials.at(0)];
  if (!material.base_color_texture) return -1;
  const Texture& texture = scene.textures[material.base_color_texture->texture];
  return decode_color_image(scene.images[*texture.image].bytes, "map").pixels[0];
}

TEST(Weather, ALayerMayLieOnOneUseOfAMaterial) {
  WeatherConfig config;
  config.size = 16;
  WeatherLayer white{"base|colorfunction=white", {"paint"}, {}}, black{"base|colorfunction=black", {"*"}, {}};
  white.where.node = "table/right";
  black.where.except.resize(1);
  black.where.except[0].instance = "right";
  config.layers = {white, black};
  WeatherCache cache;
  const Scene scene = table();
  const WeatherResult result = weather_scene(scene, config, 1, cache);
  EXPECT_EQ(red_of_use(result.scene, 1), 0);
  EXPECT_EQ(red_of_use(result.scene, 2), 255);
  ASSERT_EQ(result.scene.materials.size(), 2U);
  EXPECT_EQ(result.scene.materials[1].name, "paint 2");
  EXPECT_EQ(result.layers[0].surfaces, 1U);
  EXPECT_EQ(result.layers[1].uses, 1U);
  EXPECT_EQ(reason_for_no_paint(result), "");
  // What was painted for other surfaces is not taken for these.
  config.layers[0].where.node = "table/left";
  config.layers[1].where.except[0].instance = "left";
  const WeatherResult exchanged = weather_scene(scene, config, 1, cache);
  EXPECT_EQ(red_of_use(exchanged.scene, 1), 255);
  EXPECT_EQ(red_of_use(exchanged.scene, 2), 0);
}

TEST(Weather, SaysWhyNothingIsPainted) {
  WeatherConfig config;
  config.size = 16;
  config.layers = {{"dust", {"piant"}, {}}};
  Scene scene = table();
  EXPECT_EQ(reason_for_no_paint(weather_scene(scene, config, 1)),
            "no layer lies on any surface; layer 1 (/layers/0): materials 'piant' matches nothing; did you mean "
            "'paint'?");
  config.layers[0].materials = {"*"};
  config.layers[0].where.instance = "lefd";
  const WeatherResult none = weather_scene(scene, config, 1);
  EXPECT_EQ(none.scene.warnings.at(0), "layer 1 (/layers/0): instance 'lefd' matches nothing; did you mean 'left'?");
  config.layers[0].where = {};
  scene.parts[0].mesh.uv = {};
  EXPECT_NE(reason_for_no_paint(weather_scene(scene, config, 1)).find("has no texture coordinates"), std::string::npos);
  scene.materials.clear();
  scene.parts[0].materials.clear();
  EXPECT_NE(reason_for_no_paint(weather_scene(scene, config, 1)).find("has no material"), std::string::npos);
}

TEST(Weather, StrictLayersAreRefusedBeforeAnythingIsPainted) {
  WeatherConfig config;
  config.size = 16;
  config.source = "snow.json";
  config.layers.push_back({"base|colorfunction=white", {"paint"}});
  config.layers.push_back({"base|colorfunction=white", {"no such material"}});
  EXPECT_TRUE(weather_scene(two_sides(), config, 1).materials[0].painted());
  config.strict = true;
  bool painted = false;
  try {
    weather_scene(two_sides(), config, 1, [&](const Progress&) { return painted = true; });
    ADD_FAILURE() << "not refused";
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("snow.json: layer 2 (/layers/1): ")) << error.what();
  }
  EXPECT_FALSE(painted);
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
  EXPECT_NE(refusal("{").find("byte 2: is no valid JSON"), std::string::npos);
  EXPECT_NE(refusal("{\"a\\nb\":1}").find("unknown key 'a\\nb'"), std::string::npos);
  EXPECT_NE(refusal("{\"layers\":[{\"recipe\":\"dust\",\"nodes\":\"a\"}]}").find("did you mean 'node'?"),
            std::string::npos);
  EXPECT_NE(refusal("{\"layrs\":[]}").find("unknown key 'layrs'; did you mean 'layers'?"), std::string::npos);
  EXPECT_NE(refusal("{\"size\":1}").find("1 must be from 16 to 8192"), std::string::npos);
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
  EXPECT_EQ(grain.height.method, "recipe");
  EXPECT_FALSE(grain.roughness_factor) << "leather has no colour: the part's own look stays";
  rule.show = "picture";
  const Grain shown = make_grain(rule);
  EXPECT_FALSE(shown.shine) << "leather has one roughness";
  EXPECT_NEAR(shown.roughness_factor.value(), std::pow(2 / (0.3 * 12), 0.25), 1e-6);
  EXPECT_EQ(shown.metallic_factor.value(), 0);
  // Channels that differ are pictures; what the rule says wins.
  rule.recipe =
      "base|cols=red,green|mainfunction=step(x,.5)|reflectionfunction=main|roughnessfunction=.2+.5*main|"
      "dampingfunction=1+main";
  rule.damping = 0.4;
  const Grain steel = make_grain(rule);
  ASSERT_TRUE(steel.shine);
  EXPECT_EQ(steel.roughness_factor.value(), 1);
  const ColorImage shine = decode_color_image(steel.shine->bytes, "shine");
  const auto texel = [&](int x, std::size_t k) {
    return shine.pixels[3 * static_cast<std::size_t>(256 * shine.width + x) + k];
  };
  EXPECT_EQ(texel(1, 1), 51 + texel(1, 2) / 2) << "roughness is 0.2 + metallic / 2 everywhere";
  EXPECT_NEAR(texel(200, 1), 51 + texel(200, 2) / 2, 1);
  rule.roughness = 0.35, rule.metallic = 0.1;
  const Grain said = make_grain(rule);
  EXPECT_FALSE(said.shine);
  EXPECT_EQ(said.roughness_factor.value(), 0.35);
  const MaterialTag tag = surface_tag(rule, &said, 0);
  ASSERT_TRUE(tag.maps);
  EXPECT_NEAR(tag.damping, 0.4 * said.damping_factor, 1e-9);
  EXPECT_TRUE(std::any_of(tag.maps->channels.begin(), tag.maps->channels.end(),
                          [](const auto& channel) { return channel && channel->quantity == Quantity::damping; }));
  rule.roughness.reset(), rule.metallic.reset(), rule.damping.reset();
  rule.recipe = "leather|seed=x";
  EXPECT_THROW(make_grain(rule), InvalidInput);
}

}  // namespace
}  // namespace papilla
