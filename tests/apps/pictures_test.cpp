// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "pictures/border_edges.hpp"
#include "pictures/pixel_text.hpp"
#include "pictures/scene_render.hpp"

namespace papilla::app {
namespace {

TEST(BorderEdges, BelongToOneTriangle) {
  const auto borders = border_edges({{0, 1, 2}, {2, 1, 3}, {k_no_value, k_no_value, k_no_value}});
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
  ColorImage picture{200, 20, std::vector<unsigned char>(3 * 200 * 20, 128)};
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
    RenderOptions options{.mode = RenderMode::checker, .width = 200, .height = 200};
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
}  // namespace papilla::app
