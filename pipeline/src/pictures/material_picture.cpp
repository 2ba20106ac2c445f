// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/material_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"
#include "papilla/texture/resample.hpp"
#include "pictures/relief.hpp"

namespace papilla {
namespace {

/// A ball whose uv are millimetres along its equator and its meridians.
Part ball(double diameter_mm) {
  constexpr Index k_around = 96, k_up = 48;
  const double radius = diameter_mm / 2;
  Part part;
  part.name = "ball";
  part.materials = {0};
  TriangleMesh& mesh = part.mesh;
  for (Index row = 0; row <= k_up; ++row)
    for (Index column = 0; column <= k_around; ++column) {
      const double latitude = std::numbers::pi * (static_cast<double>(row) / k_up - 0.5);
      const double longitude = 2 * std::numbers::pi * column / k_around;
      const Vec3 normal{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                        std::sin(latitude)};
      mesh.positions.push_back(radius * normal);
      mesh.normals.values.push_back(normal);
      mesh.uv.values.push_back({radius * longitude, radius * latitude});
    }
  for (Index row = 0; row < k_up; ++row)
    for (Index column = 0; column < k_around; ++column) {
      const Index a = row * (k_around + 1) + column, b = a + 1, c = a + k_around + 1, d = c + 1;
      if (row > 0) mesh.triangles.push_back({a, b, d});
      if (row + 1 < k_up) mesh.triangles.push_back({a, d, c});
    }
  mesh.normals.indices = mesh.uv.indices = mesh.triangles;
  return part;
}

ColorImage relief_picture(const HeightMap& relief, int side_px) {
  const double pitch = std::max(relief.width * relief.pitch_mm_x, relief.height * relief.pitch_mm_y) / side_px;
  const auto samples = [&](int n, double pitch_mm) {
    return std::max(1, static_cast<int>(std::lround(n * pitch_mm / pitch)));
  };
  double exaggeration = 1;
  ColorImage picture =
      draw_relief(resample(relief, samples(relief.width, relief.pitch_mm_x), samples(relief.height, relief.pitch_mm_y)),
                  exaggeration);
  draw_scale_bar(picture, pitch);
  return picture;
}

/// Copies a picture into the middle of the square that begins at `left`.
void paste(const ColorImage& from, int left, int side_px, ColorImage& to) {
  const int x0 = left + (side_px - from.width) / 2, y0 = (side_px - from.height) / 2;
  for (int y = 0; y < from.height; ++y) {
    const auto row = from.pixels.begin() + std::ptrdiff_t{3} * y * from.width;
    std::copy(row, row + std::ptrdiff_t{3} * from.width,
              to.pixels.begin() + std::ptrdiff_t{3} * (std::ptrdiff_t{y0 + y} * to.width + x0));
  }
}

}  // namespace

ColorImage material_picture(const MaterialRule& rule, const MaterialPictureOptions& options) {
  if (options.side_px < 64 || options.side_px > 2048)
    throw InvalidInput("material_picture: side_px " + std::to_string(options.side_px) + " is not from 64 to 2048");
  Scene scene = single_part_scene(ball(options.ball_mm), "ball");
  scene.materials.resize(1);
  Materials rules;
  const MaterialRule& shown = rules.materials.emplace(rule.name, rule).first->second;
  rules.materials.begin()->second.unwrap = "keep";
  AssignRule all;
  all.part = "*";
  all.material = shown.name;
  rules.assign.push_back(std::move(all));
  BakeOptions bake;
  bake.library = options.library;
  bake.unwrap.method.cache = options.cache;
  const BakeResult baked = bake_scene(std::move(scene), rules, bake);

  SceneViewOptions view;
  view.width = view.height = options.side_px;
  view.towards_camera = {0.3, 0.3, 1};
  const int side = options.side_px;
  ColorImage picture{2 * side, side, {}};
  picture.pixels.assign(std::size_t{3} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(side), 160);
  paste(render_scene(baked.scene, view), 0, side, picture);
  if (const auto grain = baked.grains.find(shown.name); grain != baked.grains.end())
    paste(relief_picture(grain->second.relief, side), side, side, picture);
  return picture;
}

}  // namespace papilla
