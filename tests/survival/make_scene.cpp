// SPDX-License-Identifier: MIT
// usage: papilla-survival-scene FILE.glb STROKES.csv STROKES.json
// Plates in a row, one for each material that tools treat in another way, the hand's way over all of them, and the time
// at which it strokes each.
#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/image_file.hpp"

namespace papilla {
namespace {

constexpr double k_side_mm = 60, k_distance_mm = 80, k_repeat_mm = 20;
constexpr int k_cells = 24;

struct Plate {
  std::string name;
  std::array<double, 4> color;
  double metallic = 0, roughness = 0.8;
  double stiffness = 0, friction = 0;  ///< Stiffness 0: no tag.
  double wave_mm = 0;                  ///< Of the relief; 0: none.
};

/// The relief's wave lengths divide the repeat. Two plates look alike and feel different, one has no tag.
const std::vector<Plate> k_plates = {
    {"leather", {1, 1, 1, 1}, 0, 0.6, 350, 0.4, 4},
    {"cloth", {0.3, 0.3, 0.6, 1}, 0, 0.9, 150, 0.6, 2},
    {"rubber mat", {0.1, 0.1, 0.1, 1}, 0, 0.9, 300, 0.8, 10},
    {"red paint", {0.8, 0.05, 0.05, 1}, 0, 0.4, 380, 0.2, 0},
    {"green paint", {0.05, 0.6, 0.05, 1}, 0, 0.4, 380, 0.25, 0},
    {"green foam", {0.05, 0.6, 0.05, 1}, 0, 0.4, 100, 0.7, 0},
    {"blue paint", {0.05, 0.05, 0.8, 1}, 0, 0.4, 360, 0.3, 0},
    {"yellow, not felt", {0.9, 0.8, 0.1, 1}, 0, 0.4, 0, 0, 0},
    {"black plastic", {0.01, 0.01, 0.01, 1}, 0, 0.5, 320, 0.35, 0},
    {"chrome", {0.8, 0.8, 0.82, 1}, 1, 0.1, 390, 0.1, 0},
    {"steel", {0.5, 0.5, 0.52, 1}, 1, 0.4, 390, 0.15, 0},
    {"white enamel", {0.9, 0.9, 0.88, 1}, 0, 0.2, 385, 0.12, 0},
};

/// Flat in the middle and bent down towards its edges, so that simplification has something to keep.
TriangleMesh plate_mesh() {
  TriangleMesh mesh;
  for (int j = 0; j <= k_cells; ++j)
    for (int i = 0; i <= k_cells; ++i) {
      const double x = k_side_mm * (static_cast<double>(i) / k_cells - 0.5);
      const double y = k_side_mm * (static_cast<double>(j) / k_cells - 0.5);
      const auto below = [](double v) { return std::pow(std::max(std::abs(v) - 20, 0.0), 2) / 50; };
      mesh.positions.push_back({x, y, -below(x) - below(y)});
      mesh.uv.values.push_back({x / k_repeat_mm, y / k_repeat_mm});
    }
  for (Index j = 0; j < k_cells; ++j)
    for (Index i = 0; i < k_cells; ++i) {
      const Index a = j * (k_cells + 1) + i, d = a + k_cells + 1;
      mesh.triangles.push_back({a, a + 1, d + 1});
      mesh.triangles.push_back({a, d + 1, d});
    }
  mesh.uv.indices = mesh.triangles;
  return mesh;
}

HeightMap relief_of(double wave_mm) {
  HeightMap relief{128, 128, Values<float>(std::size_t{128} * 128), k_repeat_mm / 128, k_repeat_mm / 128, true};
  const double k = 2 * std::numbers::pi / wave_mm;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      relief.at(x, y) = static_cast<float>(0.02 * wave_mm * std::sin(k * (x + 0.5) * relief.pitch_mm_x) *
                                           std::cos(k * (y + 0.5) * relief.pitch_mm_y));
  return relief;
}

MaterialTag tag_of(const Plate& plate) {
  MaterialTag tag;
  tag.stiffness = plate.stiffness;
  tag.damping = 0.1;
  tag.static_friction = 1.2 * plate.friction;
  tag.dynamic_friction = plate.friction;
  if (plate.wave_mm == 0) return tag;
  const HeightMap relief = relief_of(plate.wave_mm);
  const EncodedHeight encoded = encode_height_png16(relief);
  const double rms_mm = 0.01 * plate.wave_mm;  // of a product of two sines of amplitude 0.02 wave lengths
  tag.height = make_height_tag(relief, {encoded.png, encoded.scale_mm, encoded.offset_mm, rms_mm});
  tag.roughness = RoughnessTag{2.2, 1e-3 * rms_mm, {1e-4 * plate.wave_mm, 1e-3 * plate.wave_mm}};
  return tag;
}

/// A picture of its own for each textured plate, as normal map, so that tools keep the texture coordinates.
std::uint32_t add_picture(Scene& scene, const std::string& name) {
  ColorImage picture{64, 64, Values<unsigned char>(std::size_t{3} * 64 * 64, 128)};
  for (std::size_t i = 0; i < picture.pixels.size(); i += 3) {
    picture.pixels[i] = static_cast<unsigned char>(120 + (i / 3 + scene.images.size()) % 16);
    picture.pixels[i + 2] = 255;
  }
  EncodedImage image;
  image.name = "normal " + name;
  image.mime_type = "image/png";
  image.bytes = encode_png(picture);
  scene.images.push_back(std::move(image));
  Texture texture;
  texture.image = static_cast<std::uint32_t>(scene.images.size() - 1);
  scene.textures.push_back(std::move(texture));
  return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

Scene plates_scene() {
  Scene scene;
  scene.format = "survival test";
  scene.up = UpAxis::z;
  scene.asset.copyright = "CC0, nobody";
  scene.asset.extras_json = R"({"license":"CC0-1.0"})";
  Node group;
  group.name = "plates";
  for (std::uint32_t i = 0; i < k_plates.size(); ++i) {
    const Plate& plate = k_plates[i];
    Material material;
    material.name = plate.name;
    material.base_color = plate.color;
    material.metallic = plate.metallic, material.roughness = plate.roughness;
    if (plate.stiffness > 0) material.haptic = tag_of(plate);
    if (plate.wave_mm > 0) material.normal_texture = TextureReference{add_picture(scene, plate.name), 0, 1, {}};
    scene.materials.push_back(std::move(material));
    Part part;
    part.name = plate.name + " plate";
    part.mesh = plate_mesh();
    part.materials = {i};
    scene.parts.push_back(std::move(part));
    Node node;
    node.name = plate.name + " node";
    node.part = i;
    node.local[3] = k_distance_mm * i;
    group.children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(std::move(node));
  }
  scene.roots = {static_cast<std::uint32_t>(scene.nodes.size())};
  scene.nodes.push_back(std::move(group));
  assign_part_ids(scene);
  return scene;
}

/// Down onto each plate, 0.5 mm deep, 10 mm along it and up again.
void write_strokes(const std::string& csv, const std::string& json) {
  std::ofstream way(csv);
  nlohmann::ordered_json strokes = nlohmann::ordered_json::array();
  way << "t,x,y,z\n";
  double t = 0;
  const auto go = [&](double seconds, double x_mm, double height_mm) {
    t += seconds;
    way << fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}\n", t, 1e-3 * x_mm, 1e-3 * height_mm, 1e-3 * 1.3);
  };
  for (std::size_t i = 0; i < k_plates.size(); ++i) {
    const double x = k_distance_mm * static_cast<double>(i);
    go(0.05, x - 5, 2);
    go(0.05, x - 5, -0.5);
    const double begin = t;
    go(0.1, x + 5, -0.5);
    strokes.push_back({{"material", k_plates[i].name},
                       {"from", begin},
                       {"to", t},
                       {"felt", k_plates[i].stiffness > 0},
                       {"relief", k_plates[i].wave_mm > 0}});
    go(0.05, x + 5, 2);
  }
  std::ofstream(json) << strokes.dump();
}

}  // namespace
}  // namespace papilla

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  papilla::write_glb(papilla::plates_scene(), argv[1]);
  papilla::write_strokes(argv[2], argv[3]);
  return 0;
}
