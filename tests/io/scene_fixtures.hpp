// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <utility>

#include "io/png_fixtures.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::test {

/// A cube of side `size` around the origin with outward triangles, every side with its own uv square.
inline TriangleMesh cube(double size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({((i & 1) - 0.5) * size, ((i >> 1 & 1) - 0.5) * size, ((i >> 2 & 1) - 0.5) * size});
  const Index sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  mesh.uv.values = {{0, 0}, {0.5, 0}, {0.5, 0.25}, {0, 0.25}};
  for (const auto& s : sides) {
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
    mesh.uv.indices.push_back({0, 1, 2});
    mesh.uv.indices.push_back({0, 2, 3});
  }
  return mesh;
}

inline EncodedImage small_png(std::string name) {
  EncodedImage image;
  image.name = std::move(name);
  image.mime_type = "image/png";
  image.bytes.assign(as_bytes(k_grey8_png).begin(), as_bytes(k_grey8_png).end());
  return image;
}

/// Two cubes of one part, turned, scaled and moved, with two materials, textures and extras everywhere.
inline Scene rich_scene() {
  Scene scene;
  scene.format = "test";
  scene.up = UpAxis::z;
  scene.extras_json = R"({"scene":[1,2.5,null,{}]})";
  scene.images = {small_png("picture ä"), small_png("haptic.height")};
  scene.images[1].extras_json = R"({"i":[]})";
  Texture texture;
  texture.image = 0;
  texture.name = "t";
  texture.wrap_s = 33071;
  texture.extras_json = R"({"t":true})";
  scene.textures = {texture};
  Material grain;
  grain.name = "grain";
  grain.base_color = {0.25, 0.5, 0.75, 1};
  grain.roughness = 0.5;
  grain.double_sided = true;
  grain.normal_texture = TextureReference{0, 0, 0.5, UvTransform{{0.5, 0}, 0, {2, 2}}};
  grain.base_color_texture = TextureReference{0, 0, 1, {}};
  grain.extras_json = R"({"haptic":{"version":1,"stiffness":900.0,"empty":[],"big":4294967296,"none":null}})";
  grain.extensions_json = R"({"KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatTexture":{"index":0}}})";
  Material chrome;
  chrome.name = "chrome";
  chrome.metallic = 1;
  chrome.alpha_mode = "MASK";
  scene.materials = {grain, chrome};
  Part part;
  part.name = "cube \"ü\"";
  part.mesh = cube(20);
  part.mesh.material.assign(12, 0);
  part.mesh.material[11] = 1;
  part.materials = {0, 1};
  part.extras_json = R"({"p":1})";
  scene.parts = {part};
  scene.nodes.resize(3);
  scene.nodes[0].name = "root";
  scene.nodes[0].children = {1, 2};
  scene.nodes[0].extras_json = R"({"layer":"A"})";
  scene.nodes[1].name = "left";
  scene.nodes[1].part = 0;
  scene.nodes[1].local = {0, -2, 0, 10, 2, 0, 0, 20, 0, 0, 2, 30, 0, 0, 0, 1};
  scene.nodes[2].name = "right";
  scene.nodes[2].part = 0;
  scene.nodes[2].local = {-1, 0, 0, -100, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  scene.roots = {0};
  assign_part_ids(scene);
  return scene;
}

/// Six times the signed volume of all instances, in mm³: positive for closed surfaces that face outwards.
inline double signed_volume_times_6(const Scene& scene) {
  double volume = 0;
  for (const Instance& instance : instances(scene)) {
    const TriangleMesh& mesh = scene.parts[instance.part].mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec3 corner[3];
      for (int k = 0; k < 3; ++k) corner[k] = transform_point(instance.world, mesh.corner(t, k));
      volume += dot(corner[0], cross(corner[1], corner[2]));
    }
  }
  return volume;
}

}  // namespace papilla::test
