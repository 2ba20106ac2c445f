// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"
#include "pictures/border_edges.hpp"
#include "pictures/mip_pyramid.hpp"
#include "pictures/pixel_text.hpp"
#include "pictures/relief.hpp"

namespace papilla {
namespace {

TEST(BorderEdges, BelongToOneTriangle) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 3}, {k_no_value, k_no_value, k_no_value}};
  const auto borders = border_edges(triangles);
  ASSERT_EQ(borders.size(), 3U);
  EXPECT_EQ(borders[0], (std::array{true, false, true}));
  EXPECT_EQ(borders[1], (std::array{false, true, true}));
  EXPECT_EQ(borders[2], (std::array{false, false, false}));
}

TEST(PixelText, DrawsTheDotsOfItsLetters) {
  std::set<std::pair<int, int>> dots;
  draw_text("-.", 4, 10, 1, [&](int x, int y) { dots.insert({x, y}); });
  EXPECT_EQ(dots, (std::set<std::pair<int, int>>{{0, 12}, {1, 12}, {2, 12}, {5, 14}}));
  EXPECT_EQ(text_width("four", 2), 32);
}

TEST(PixelText, NamesPanelsBelowThem) {
  ColorImage picture{200, 20, Values<unsigned char>(3 * 200 * 20, 128)};
  const ColorImage named = with_captions(picture, {"lattice", ""});
  EXPECT_EQ(named.width, 200);
  ASSERT_GT(named.height, 20);
  ASSERT_EQ(named.pixels.size(), 3U * 200 * static_cast<unsigned>(named.height));
  EXPECT_TRUE(std::equal(picture.pixels.begin(), picture.pixels.end(), named.pixels.begin()));
  int left = 0, right = 0;
  for (int y = 20; y < named.height; ++y)
    for (int x = 0; x < 200; ++x)
      (x < 100 ? left : right) += named.pixels[3 * static_cast<std::size_t>(200 * y + x)] == 0;
  EXPECT_GT(left, 50);
  EXPECT_EQ(right, 0);
}

/// How many pixels are as red as borders.
int red_pixels(const TriangleMesh& mesh) {
  Part part;
  part.mesh = mesh;
  const ColorImage picture = render_scene(single_part_scene(std::move(part), "test"),
                                          {.mode = RenderMode::triangles, .width = 160, .height = 160});
  int red = 0;
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3)
    red += picture.pixels[i] > 150 && picture.pixels[i + 1] < 110 && picture.pixels[i + 2] < 110;
  return red;
}

TEST(RenderTriangles, ShowsBordersAndNoEdgesBetweenTriangles) {
  TriangleMesh joined;
  joined.positions = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  joined.triangles = {{0, 1, 2}, {0, 2, 3}};
  TriangleMesh loose = joined;
  loose.positions.insert(loose.positions.end(), {{0, 0, 0}, {10, 10, 0}});
  loose.triangles[1] = {4, 5, 3};
  EXPECT_GT(red_pixels(joined), 100);
  EXPECT_GT(red_pixels(loose), red_pixels(joined) + 50);
}

/// Linear colour in the middle of a picture of squares seen from z, of one material each.
Vec3 middle_of(const std::vector<double>& heights, const std::vector<std::array<double, 4>>& colors) {
  Part part;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const auto first = static_cast<Index>(part.mesh.positions.size());
    for (const Vec2 corner : {Vec2{-100, -100}, Vec2{100, -100}, Vec2{100, 100}, Vec2{-100, 100}})
      part.mesh.positions.push_back({corner.x, corner.y, heights[i]});
    part.mesh.triangles.push_back({first, first + 1, first + 2});
    part.mesh.triangles.push_back({first, first + 2, first + 3});
    part.mesh.material.insert(part.mesh.material.end(), 2, static_cast<std::uint32_t>(i));
    part.materials.push_back(static_cast<std::uint32_t>(i));
  }
  Scene scene = single_part_scene(std::move(part), "test");
  scene.up = UpAxis::y;
  scene.materials.clear();
  for (const auto& color : colors) {
    Material material;
    material.base_color = color;
    material.roughness = 1;
    if (color[3] < 1) material.alpha_mode = "BLEND";
    scene.materials.push_back(std::move(material));
  }
  const ColorImage picture = render_scene(scene, {.width = 41, .height = 41, .towards_camera = {0, 0, 1}});
  const auto linear = [&](std::size_t channel) {
    const double c = picture.pixels[3 * (20 * 41 + 20) + channel] / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {linear(0), linear(1), linear(2)};
}

TEST(RenderScene, GlassLetsShineThroughWhatLiesBehind) {
  const std::array<double, 4> red{0.4, 0, 0, 1}, green{0, 0.4, 0, 1}, glass{0, 0.4, 0, 0.25}, blue{0, 0, 0.4, 0.5};
  const Vec3 behind = middle_of({0}, {red}), before = middle_of({0}, {green});
  const Vec3 through = middle_of({1, 0}, {glass, red});
  EXPECT_LT(norm(through - (0.75 * behind + 0.25 * before)), 0.01);
  EXPECT_GT(through.x, 3 * through.y / 2);
  // What is behind stays hidden, and the order in the file does not matter.
  EXPECT_LT(norm(middle_of({0, -1}, {red, glass}) - behind), 0.01);
  const Vec3 stack = middle_of({2, 1, 0}, {glass, blue, red});
  EXPECT_LT(norm(middle_of({1, 0, 2}, {blue, red, glass}) - stack), 0.002);
  EXPECT_GT(middle_of({2, 1, 0}, {blue, glass, red}).z, stack.z + 0.03);
}

/// A square of 200 mm seen from z, u along x and v along y, once over it.
Scene square_seen_from_z() {
  Part part;
  part.mesh.positions = {{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}};
  part.mesh.triangles = part.mesh.uv.indices = {{0, 1, 2}, {0, 2, 3}};
  part.mesh.uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  part.materials = {0};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.up = UpAxis::y;
  scene.materials.resize(1);
  scene.materials[0].base_color = {0.1, 0.1, 0.1, 1};
  scene.materials[0].roughness = 1;
  return scene;
}

/// How often light and dark fields of a checker alternate along a line through the middle.
int alternations(const ColorImage& picture, bool along_x) {
  const auto dark = [&](int i) {
    const int x = along_x ? i : picture.width / 2 + 3, y = along_x ? picture.height / 2 + 3 : i;
    const auto at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
    return picture.pixels[at] < picture.pixels[at + 2];
  };
  int count = 0;
  for (int i = 21; i < picture.width - 20; ++i) count += dark(i) != dark(i - 1);
  return count;
}

/// Repeats of 100 by 50 mm on the second coordinates: fields of 20 mm are square.
TEST(RenderScene, FieldsOfACheckerAreSquareOnTheCoordinatesOfTheRelief) {
  Scene scene = square_seen_from_z();
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh.uv1.indices = mesh.uv.indices;
  mesh.uv1.values = {{0, 0}, {2, 0}, {2, 4}, {0, 4}};
  scene.materials[0].normal_texture = TextureReference{0, 1, 1, {}};
  SceneViewOptions options{.mode = RenderMode::checker, .width = 400, .height = 400, .towards_camera = {0, 0, 1}};
  options.mm_per_uv = {{100, 50}};
  const ColorImage picture = render_scene(scene, options);
  EXPECT_EQ(alternations(picture, true), 9);
  EXPECT_EQ(alternations(picture, false), 9);
}

/// The light comes from above: what is inclined towards growing v, which is up here, is brighter.
TEST(RenderScene, NormalMapsAreLitFromAbove) {
  const auto brightness = [](unsigned char green) {
    Scene scene = square_seen_from_z();
    ColorImage map{4, 4, {}};
    for (int i = 0; i < 16; ++i) map.pixels.insert(map.pixels.end(), {128, green, 230});
    scene.images.resize(1);
    scene.images[0].mime_type = "image/png";
    scene.images[0].bytes = encode_png(map);
    scene.textures.resize(1);
    scene.textures[0].image = 0;
    scene.materials[0].normal_texture = TextureReference{0, 0, 1, {}};
    const ColorImage picture = render_scene(scene, {.width = 41, .height = 41, .towards_camera = {0, 0, 1}});
    return int{picture.pixels[3 * (20 * 41 + 20)]};
  };
  EXPECT_GT(brightness(180), brightness(128) + 5);
  EXPECT_LT(brightness(76), brightness(128) - 5);
}

/// Columns end, rows go on: over the lower border lies the upper one.
TEST(MipPyramid, EachAxisHasItsOwnBorder) {
  RgbaImage image{2, 4, {}};
  for (const int grey : {0, 51, 102, 153, 204, 255, 51, 102})
    image.pixels.insert(image.pixels.end(), {static_cast<unsigned char>(grey), 0, 0, 255});
  const MipPyramid columns_end(image, false, {true, false}), rows_end(image, false, {false, true});
  const auto red = [](const MipPyramid& pyramid, double u, double v) { return pyramid.sample({u, v}, 1).color.x; };
  EXPECT_NEAR(red(columns_end, 0.25, 0), 0.5 * (0.2 + 0), 1e-6);
  EXPECT_NEAR(red(columns_end, 0, 0.875), 0, 1e-6);
  EXPECT_NEAR(red(rows_end, 0.25, 0), 0.2, 1e-6);
  EXPECT_NEAR(red(rows_end, 0, 0.875), 0.5 * (0 + 0.2), 1e-6);
}

/// Rows of 0, 1, 2 and 1 units that repeat: the slope is 1/pitch at half of them. With columns twice as near.
TEST(DrawRelief, SlopesAreThoseOfRowsThatRepeat) {
  HeightMap map{3, 4, {}, 0.25, 0.5, true};
  for (const float row : {0.0F, 0.01F, 0.02F, 0.01F}) map.mm.insert(map.mm.end(), 3, row);
  double exaggeration = 0;
  draw_relief(map, exaggeration);
  EXPECT_NEAR(exaggeration, 0.25 / (0.01 / 0.5 * std::sqrt(0.5)), 1e-5);
}

/// The corners of large triangles lie behind a camera that is near: what is before it is drawn all the same, with the
/// checker at the size that it has there.
TEST(CloseUp, ShowsTrianglesThatGoOnBehindTheCamera) {
  const auto dark_pixels = [](Vec3 third, Vec3 fourth) {
    Part part;
    part.mesh.positions = {{-1000, -1000, 0}, {1000, -1000, 0}, third, fourth};
    part.mesh.triangles = part.mesh.uv.indices = {{0, 1, 2}, {0, 2, 3}};
    for (const Vec3& p : part.mesh.positions) part.mesh.uv.values.push_back({p.x / 1000, p.y / 1000});
    part.materials = {0};
    Scene scene = single_part_scene(std::move(part), "test");
    scene.materials.resize(1);
    SceneViewOptions options{.mode = RenderMode::checker, .width = 200, .height = 200};
    options.close_up = CloseUp{{3, 4, 0}, {0, 0, 1}, 100};
    options.mm_per_uv = {{1000, 1000}};
    const ColorImage picture = render_scene(scene, options);
    int dark = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
      EXPECT_LT(picture.pixels[i + 2], 200) << "background at pixel " << i / 3;
      dark += picture.pixels[i] < picture.pixels[i + 2];
    }
    return dark;
  };
  const int square = dark_pixels({1000, 1000, 0}, {-1000, 1000, 0});
  EXPECT_NEAR(square, 200 * 200 / 2, 2000);
  EXPECT_EQ(dark_pixels({2000, 9000, 0}, {-900, 8000, 0}), square);
}

}  // namespace
}  // namespace papilla
