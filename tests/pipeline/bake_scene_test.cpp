// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_scene.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/decode_grey16.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/stereo_file.hpp"
#include "papilla/texture/grain.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla_test/shapes.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

/// A picture of grain on disk and the rules that use it.
class BakeTest : public testing::Test {
 protected:
  BakeTest() {
    fs::create_directories(folder_);
    GrainOptions options;
    options.size_px = 64;
    write_grey_image(folder_ / "grain.png", synthesize_grain(GrainKind::spheres6, options).picture, 8);
    MaterialRule grain;
    grain.name = "grain";
    grain.texture = folder_ / "grain.png";
    grain.size_mm[0] = 40;
    grain.size_mm[1] = 20;
    grain.height.depth_mm = 0.4;
    grain.height.scale = 2;
    grain.height.relief.tile = false;  // The whole picture.
    grain.stiffness = 900;
    MaterialRule hard;
    hard.name = "hard";
    hard.stiffness = 2000;
    rules_.materials = {{"grain", grain}, {"hard", hard}};
    add_rule("dash*", "grain");
    add_rule("knob", "hard");
  }
  ~BakeTest() override { fs::remove_all(folder_); }

  void add_rule(const std::string& part, const std::string& material) {
    AssignRule rule;
    rule.part = part;
    rule.material = material;
    rules_.assign.push_back(rule);
  }

  /// A flat square of 100 mm in the xy plane, two triangles.
  static Part square(const std::string& name) {
    Part part;
    part.name = name;
    part.mesh.positions = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
    part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return part;
  }

  static Scene scene_of(std::vector<Part> parts) {
    Scene scene;
    scene.format = "STL";
    for (Part& part : parts) {
      Node node;
      node.name = part.name;
      node.part = static_cast<std::uint32_t>(scene.parts.size());
      scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
      scene.nodes.push_back(node);
      scene.parts.push_back(std::move(part));
    }
    return scene;
  }

  /// Sheets alone in space, which have no side, stay as they are.
  BakeResult run(Scene scene) const {
    BakeOptions options;
    options.plan.sides.keep = true;
    return bake_scene(std::move(scene), rules_, options);
  }

  static nlohmann::json tag_of(const Material& material) {
    return nlohmann::json::parse(to_json(material.haptic.value()));
  }

  const fs::path folder_ = fs::temp_directory_path() / ("papilla-bake-" + std::to_string(::getpid()));
  Materials rules_;
};

/// The back of a double sheet is dropped, so that the front must be seen from both sides.
TEST_F(BakeTest, DoubleSheetsAreSeenFromBothSides) {
  Part twice = square("dash_twice");
  twice.mesh.triangles.insert(twice.mesh.triangles.end(), {{0, 2, 1}, {0, 3, 2}});
  const BakeResult result = run(scene_of({twice, square("dash_once")}));
  ASSERT_EQ(result.surfaces.size(), 2U);
  EXPECT_EQ(result.surfaces[0].repaired.value().counts.opposites, 2U);
  EXPECT_EQ(repair_of(result.surfaces).counts.opposites, 2U);
  EXPECT_TRUE(result.scene.materials[result.scene.parts[0].materials.at(0)].double_sided);
  EXPECT_FALSE(result.scene.materials[result.scene.parts[1].materials.at(0)].double_sided);
}

TEST_F(BakeTest, APartWithoutGrainGetsNothingAndCostsNothing) {
  const BakeResult result = run(scene_of({square("knob"), square("floor")}));
  EXPECT_TRUE(result.scene.images.empty());
  EXPECT_TRUE(result.scene.textures.empty());
  EXPECT_TRUE(result.scene.parts[0].mesh.uv.empty());
  EXPECT_TRUE(result.scene.parts[1].mesh.uv.empty());
  EXPECT_TRUE(result.grains.empty());
  ASSERT_EQ(result.scene.materials.size(), 1U);
  const auto tag = tag_of(result.scene.materials[0]);
  EXPECT_EQ(tag.at("stiffness"), 2000);
  EXPECT_FALSE(tag.contains("height"));
  EXPECT_TRUE(result.scene.parts[1].materials.empty());
}

TEST_F(BakeTest, GrainHasItsPhysicalScale) {
  const BakeResult result = run(scene_of({square("dash")}));
  const TriangleMesh& mesh = result.scene.parts[0].mesh;
  ASSERT_EQ(mesh.uv.indices.size(), 2U);
  // 100 mm are 2.5 repeats of 40 mm and 5 repeats of 20 mm; grain stands upright.
  double low_u = 1e9, high_u = -1e9, low_v = 1e9, high_v = -1e9;
  for (const Triangle& t : mesh.uv.indices)
    for (const Index i : t) {
      low_u = std::min(low_u, mesh.uv.values[i].x);
      high_u = std::max(high_u, mesh.uv.values[i].x);
      low_v = std::min(low_v, mesh.uv.values[i].y);
      high_v = std::max(high_v, mesh.uv.values[i].y);
    }
  EXPECT_NEAR(high_u - low_u, 2.5, 1e-9);
  EXPECT_NEAR(high_v - low_v, 5.0, 1e-9);
  EXPECT_NEAR(result.surfaces.at(0).distortion.symmetric_dirichlet.mean, 4, 1e-9);
  EXPECT_EQ(result.mm_per_uv, (std::vector<Vec2>{{40, 20}}));
}

/// New uv are TEXCOORD_0: what lies on that is lost, what lies on TEXCOORD_1 is where it was.
TEST_F(BakeTest, PicturesOnTheSecondCoordinatesStay) {
  Part part = square("dash");
  part.mesh.uv1.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  part.mesh.uv1.indices = part.mesh.triangles;
  part.mesh.material = {0, 0};
  part.materials = {0};
  Scene scene = scene_of({part});
  const std::string png = read_file(folder_ / "grain.png");
  scene.images.resize(1);
  scene.images[0].mime_type = "image/png";
  scene.images[0].bytes.assign(std::as_bytes(std::span(png)).begin(), std::as_bytes(std::span(png)).end());
  scene.textures.resize(1);
  scene.textures[0].image = 0;
  scene.materials.resize(1);
  scene.materials[0].name = "skin";
  scene.materials[0].occlusion_texture = TextureReference{0, 1, 1, {}};
  scene.materials[0].emissive_texture = TextureReference{0, 0, 1, {}};
  const BakeResult result = run(std::move(scene));
  const TriangleMesh& mesh = result.scene.parts[0].mesh;
  const Material& material = result.scene.materials.at(result.scene.parts[0].materials.at(mesh.material.at(0)));
  ASSERT_TRUE(material.occlusion_texture);
  EXPECT_EQ(material.occlusion_texture->tex_coord, 1);
  EXPECT_FALSE(material.emissive_texture);
  EXPECT_EQ(result.scene.losses.size(), 1U);
  ASSERT_EQ(mesh.uv1.indices.size(), 2U);
  EXPECT_EQ(mesh.uv1.values.at(mesh.uv1.indices[0][2]), (Vec2{1, 1}));
}

/// Whether the uv of a mesh have the lengths of its edges, in repeats of 40 x 20 mm.
void expect_lengths(const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, const std::string& name) {
  ASSERT_EQ(uv.indices.size(), mesh.triangles.size()) << name;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const Vec3 edge = mesh.corner(t, static_cast<int>(l)) - mesh.corner(t, static_cast<int>(k));
      const Vec2 step = uv.values[uv.indices[t][l]] - uv.values[uv.indices[t][k]];
      EXPECT_NEAR(std::hypot(40 * step.x, 20 * step.y), norm(edge), 1e-6) << name;
    }
}

/// Oblong sheets of the same corners, cut along either diagonal. In place equal ones take each other's uv.
TEST_F(BakeTest, PartsCutIntoOtherTrianglesHaveTheirOwnUv) {
  std::vector<Part> parts = {square("dash"), square("dash_other"), square("dash_again")};
  parts[1].mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  for (Part& part : parts)
    for (Vec3& p : part.mesh.positions) p.y *= 0.6;
  BakeOptions options;
  options.plan.sides.keep = options.plan.keep_copies = true;
  const BakeResult result = bake_scene(scene_of(parts), rules_, options);
  ASSERT_EQ(result.surfaces.size(), 3U);
  for (const Part& part : result.scene.parts) expect_lengths(part.mesh, part.mesh.uv, part.name);
  options.plan.keep_copies = false;
  options.plan.in_place = true;
  const BakeResult in_place = bake_scene(scene_of(parts), rules_, options);
  ASSERT_EQ(in_place.surfaces.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) expect_lengths(parts[i].mesh, in_place.surfaces[i].uv, parts[i].name);
  EXPECT_EQ(in_place.surfaces[1].same_as, "");
  EXPECT_EQ(in_place.surfaces[2].same_as, in_place.surfaces[0].label);
}

/// Three of the six spheres of 10.7 pixels fill a tile of 32 pixels, half of the picture.
TEST_F(BakeTest, WhatRepeatsIsBakedOnceOnAnExactTile) {
  rules_.materials.at("grain").height.relief.tile.reset();
  const BakeResult result = bake_scene(scene_of({square("dash")}), rules_, {});
  const Grain& grain = result.grains.at("grain");
  EXPECT_DOUBLE_EQ(grain.size_mm[0], 20);
  EXPECT_DOUBLE_EQ(grain.size_mm[1], 10);
  EXPECT_EQ(grain.relief.width, 32);
  EXPECT_TRUE(grain.relief.periodic);
  EXPECT_TRUE(step_of(grain.plan, "exact_tile").run);
  ASSERT_TRUE(grain.tag.height);
  EXPECT_DOUBLE_EQ(grain.tag.height->metres_per_uv.x, 0.02);
  EXPECT_DOUBLE_EQ(grain.tag.height->metres_per_uv.y, 0.01);
  EXPECT_FALSE(grain.height.overlay);
}

/// The relief of several photographs is that of `papilla height`.
TEST_F(BakeTest, SeveralPhotographsGiveTheReliefOfTheVerb) {
  HeightMap relief{96, 72, {}, 0.1, 0.1, false};
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x)
      relief.mm.push_back(static_cast<float>(0.2 * std::sin(0.21 * x + 0.1 * y) * std::cos(0.17 * y)));
  MaterialRule& rule = rules_.materials.at("grain");
  HeightRule height;
  height.lights = {{{0.6, 0.1, 0.8}, {-0.5, 0.4, 0.8}, {-0.1, -0.7, 0.7}, {0.3, 0.6, 0.7}}, {}, "lights"};
  for (const Vec3 light : height.lights.directions) {
    height.images.push_back(folder_ / ("light" + std::to_string(height.images.size()) + ".tif"));
    write_grey_image(height.images.back(), render_lambert(relief, light), 32);
  }
  height.references = {{HeightReference::Kind::ruler, 5, {10, 10}, {60, 10}, {}}};
  height.max_slope = 1000;
  rule.height = height;
  rule.texture = height.images.front();
  rule.size_mm[0] = 20, rule.size_mm[1] = 7.2;
  const GrainPlan plan = plan_grain(rule);
  EXPECT_EQ(plan.problem, "");
  EXPECT_TRUE(step_of(plan.steps, "photometric_stereo").run);
  const BakeResult result = run(scene_of({square("dash")}));
  const Grain& grain = result.grains.at("grain");
  EXPECT_EQ(grain.height.method, "photometric-stereo");
  EXPECT_EQ(grain.height.photographs.size(), 4U);
  EXPECT_EQ(grain.height.stereo.value().depth_source, "measured");
  EXPECT_NEAR(grain.size_mm[0], 9.6, 1e-9) << "the ruler's";
  ASSERT_EQ(grain.warnings.size(), 1U);
  EXPECT_EQ(grain.warnings[0], "material 'grain': size_mm/0: 20 mm are 9.6 mm by the ruler in height.images");
  const StereoFiles verb =
      height_of_picture_files(height.images, folder_ / "verb.tif", {{}, height.lights, height.references});
  const HeightMap& map = verb.files.result.map;
  ASSERT_EQ(map.mm.size(), grain.relief.mm.size());
  for (std::size_t i = 0; i < map.mm.size(); ++i)
    ASSERT_NEAR(static_cast<double>(map.mm[i] - map.mm[0]),
                static_cast<double>(grain.relief.mm[i] - grain.relief.mm[0]), 1e-5);

  rule.height.images[2] = folder_ / "none.tif";
  EXPECT_NE(plan_grain(rule).problem.find("material 'grain', height.images: "), std::string::npos)
      << plan_grain(rule).problem;
  EXPECT_NE(plan_grain(rule).problem.find("none.tif"), std::string::npos);
}

TEST_F(BakeTest, TheTagDecodesToTheReliefThatTheNormalMapShows) {
  const BakeResult result = run(scene_of({square("dash")}));
  const auto height = tag_of(result.scene.materials.at(0)).at("height");
  EXPECT_EQ(height.at("bits"), 16);
  EXPECT_NEAR(height.at("scale").get<double>(), 2 * 0.4e-3, 1e-9);
  EXPECT_EQ(height.at("metresPerUV"), (std::vector<double>{0.04, 0.02}));
  EXPECT_EQ(height.at("uri").get<std::string>().rfind("data:image/png;base64,", 0), 0U);
  const Grain& grain = result.grains.at("grain");
  EXPECT_EQ(height.at("sha256"), sha256_hex(grain.height_png.bytes));
  const Grey16 samples = decode_grey16(grain.height_png.bytes, "height");
  EXPECT_EQ(samples.bits, 16);
  ASSERT_EQ(samples.values.size(), grain.relief.mm.size());
  const double scale_mm = 1e3 * height.at("scale").get<double>(), offset_mm = 1e3 * height.at("offset").get<double>();
  for (std::size_t i = 0; i < samples.values.size(); ++i)
    ASSERT_NEAR(offset_mm + scale_mm * samples.values[i] / 65535, static_cast<double>(grain.relief.mm[i]),
                scale_mm / 60000);
  ASSERT_TRUE(result.scene.materials[0].normal_texture.has_value());
  const Texture& texture = result.scene.textures.at(result.scene.materials[0].normal_texture->texture);
  const ColorImage normals = decode_color_image(result.scene.images.at(*texture.image).bytes, "normals");
  EXPECT_EQ(normals.width, grain.relief.width);
  EXPECT_EQ(normals.height, grain.relief.height);
}

/// The default is a third of what the friction holds; what was steeper is in the report.
TEST_F(BakeTest, SlopesAreLimitedByFrictionAndTheMeanHeightStays) {
  MaterialRule& rule = rules_.materials.at("grain");
  rule.static_friction = 0.8;
  rule.dynamic_friction = 0.7;
  const auto mean = [](const HeightMap& relief) {
    double sum = 0;
    for (const float h : relief.mm) sum += static_cast<double>(h);
    return sum / static_cast<double>(relief.mm.size());
  };
  const BakeResult limited = run(scene_of({square("dash"), square("knob")}));
  rule.height.max_slope = 1000;
  const BakeResult steep = run(scene_of({square("dash")}));
  const Grain &grain = limited.grains.at("grain"), &before = steep.grains.at("grain");
  EXPECT_NEAR(grain.height.max_slope, 1 / 2.4, 1e-12);
  EXPECT_EQ(grain.height.slopes.stop, StopReason::converged);
  EXPECT_GT(grain.height.slopes.share_before, 0.01);
  EXPECT_EQ(grain.height.slopes.share_after, 0);
  EXPECT_EQ(grain.height.slopes.steepest_before, before.height.slopes.steepest_before);
  EXPECT_EQ(before.height.slopes.share_before, 0);
  EXPECT_LE(grain.height.depth_mm, before.height.depth_mm);
  EXPECT_EQ(grain.height.unlimited_depth_mm, before.height.depth_mm);
  EXPECT_NEAR(mean(grain.relief), mean(before.relief), 1e-6);
  EXPECT_NEAR(limited.scene.materials.at(0).haptic->height->scale_m, 1e-3 * grain.height.depth_mm, 1e-9);
  EXPECT_TRUE(limited.scene.warnings.empty());
}

TEST_F(BakeTest, HeightsBeyondWhatATagMayHaveAreShrunkWithAWarning) {
  rules_.materials.at("grain").height.depth_mm = 50;
  const BakeResult result = run(scene_of({square("dash"), square("knob")}));
  EXPECT_LE(result.scene.materials.at(0).haptic->height->scale_m, 0.02 * (1 + 1e-6));
  ASSERT_EQ(result.scene.warnings.size(), 1U);
  EXPECT_EQ(result.scene.warnings[0], "material 'grain': height: 100 mm are beyond the limit of 20 mm; shrunk to 20");
  std::vector<HapticWarning> warnings;
  parse_material_tag(to_json(*result.scene.materials[0].haptic), warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0].message;
}

TEST_F(BakeTest, UsableUvStaysAndTheTextureTransformGivesTheScale) {
  Part part = square("dash");
  part.mesh.uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  part.mesh.uv.indices = part.mesh.triangles;
  const BakeResult result = run(scene_of({part}));
  EXPECT_EQ(result.scene.parts[0].mesh.uv.values, part.mesh.uv.values);
  const auto& reference = result.scene.materials.at(0).normal_texture;
  ASSERT_TRUE(reference && reference->transform);
  EXPECT_NEAR(reference->transform->scale.x, 2.5, 1e-9);
  EXPECT_NEAR(reference->transform->scale.y, 5, 1e-9);
  const auto height = tag_of(result.scene.materials[0]).at("height");
  EXPECT_NEAR(height.at("metresPerUV").at(0).get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(height.at("uvTransform").at("scale").at(0).get<double>(), 2.5, 1e-9);
}

TEST_F(BakeTest, OnlyTheGrainSurfaceOfAPartGetsUv) {
  Part part = square("dash");
  Scene scene = scene_of({part});
  scene.materials.resize(2);
  scene.materials[0].name = "skin";
  scene.materials[1].name = "metal";
  scene.parts[0].materials = {0, 1};
  scene.parts[0].mesh.material = {0, 1};
  AssignRule metal;
  metal.gltf_material = "metal";
  rules_.assign.insert(rules_.assign.begin(), metal);
  const BakeResult result = run(std::move(scene));
  const TriangleMesh& mesh = result.scene.parts[0].mesh;
  ASSERT_EQ(mesh.triangles.size(), 2U);
  for (std::size_t t = 0; t < 2; ++t) EXPECT_EQ(mesh.uv.has_value(t), mesh.material[t] == 0);

  write_glb(result.scene, folder_ / "out.glb", {});
  const Scene back = read_gltf(folder_ / "out.glb");
  ASSERT_EQ(back.parts.size(), 1U);
  for (std::size_t t = 0; t < 2; ++t)
    EXPECT_EQ(back.parts[0].mesh.uv.has_value(t),
              back.materials[back.parts[0].materials[back.parts[0].mesh.material[t]]].name == "skin");
}

TEST_F(BakeTest, TheSameInputGivesTheSameScene) {
  const Part patch = [] {
    Part part;
    part.name = "dash";
    part.mesh = test::uv_sphere(50, 24, 12);
    return part;
  }();
  for (const char* name : {"a.glb", "b.glb"})
    write_glb(run(scene_of({patch, square("knob")})).scene, folder_ / name, {});
  EXPECT_TRUE(read_file(folder_ / "a.glb") == read_file(folder_ / "b.glb"));
}

TEST_F(BakeTest, MapsAsUnwrapDoes) {
  Scene scene;
  for (const TriangleMesh& mesh : {test::torus(100, 30, 40, 20), test::cube(80), test::uv_sphere(60, 24, 12)}) {
    Part part;
    part.name = "dash " + std::to_string(scene.parts.size());
    part.mesh.positions = mesh.positions;
    part.mesh.triangles = mesh.triangles;
    scene.parts.push_back(part);
  }
  scene = scene_of(std::move(scene.parts));
  scene.format = "STEP";  // Clean: nothing is repaired.
  UnwrapOptions options;
  options.layout = UvLayout::tile;
  options.tile_mm = {40, 20};
  const UnwrapResult unwrapped = unwrap_scene(scene, options);
  const BakeResult baked = run(scene);
  ASSERT_EQ(baked.surfaces.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(baked.surfaces[i].mesh.triangles, unwrapped.scene.parts[i].mesh.triangles) << i;
    const Values<Vec2>&written = baked.surfaces[i].mesh.uv.values, &exact = unwrapped.scene.parts[i].mesh.uv.values;
    ASSERT_EQ(written.size(), exact.size()) << i;
    for (std::size_t v = 0; v < exact.size(); ++v) {  // Repeats in single precision.
      ASSERT_NEAR(written[v].x, exact[v].x, 1e-6 * (std::abs(exact[v].x) + options.tile_mm.x)) << i;
      ASSERT_NEAR(written[v].y, exact[v].y, 1e-6 * (std::abs(exact[v].y) + options.tile_mm.y)) << i;
    }
    EXPECT_EQ(baked.surfaces[i].mesh.uv.indices, unwrapped.scene.parts[i].mesh.uv.indices) << i;
    // What is written: repeats of the grain, whole ones taken off chart by chart.
    const TriangleMesh& mesh = baked.scene.parts[i].mesh;
    for (std::size_t v = 0; v < mesh.uv.values.size(); ++v) {
      const Vec2 repeats{unwrapped.scene.parts[i].mesh.uv.values[v].x / 40,
                         unwrapped.scene.parts[i].mesh.uv.values[v].y / 20};
      EXPECT_NEAR(std::remainder(mesh.uv.values[v].x - repeats.x, 1), 0, 1e-12);
      EXPECT_NEAR(std::remainder(mesh.uv.values[v].y - repeats.y, 1), 0, 1e-12);
    }
  }
}

TEST_F(BakeTest, UnwrapsAsTheMaterialSays) {
  MaterialRule& rule = rules_.materials.at("grain");
  rule.unwrap = "planar";
  MethodOptions options;
  options.planar.direction = Vec3{0, 0, 1};
  options.grains = {{GrainSource::direction, {1, 0, 0}},
                    {GrainSource::edge_loop, {130, 50, 0}, "dash_e*"},
                    {GrainSource::longest, {}, "dash_missing"}};
  rule.unwrap_options = options;
  const BakeResult result = run(scene_of({square("dash_axis"), square("dash_edge")}));
  ASSERT_EQ(result.surfaces.size(), 2U);
  for (const BakedSurface& surface : result.surfaces) {
    EXPECT_EQ(surface.method, "planar");
    EXPECT_EQ(surface.reason, "as the material says");
  }
  // v grows along x, and along the edge at x = 100, by a repeat every 20 mm.
  for (const std::size_t p : {0U, 1U}) {
    const TriangleMesh& mesh = result.scene.parts[p].mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        const Vec3 edge = mesh.corner(t, static_cast<int>(l)) - mesh.corner(t, static_cast<int>(k));
        const double v = (mesh.uv.values[mesh.uv.indices[t][l]] - mesh.uv.values[mesh.uv.indices[t][k]]).y;
        EXPECT_NEAR(v, (p == 0 ? edge.x : edge.y) / 20, 1e-9);
      }
  }
  const std::string warning =
      "material 'grain': its unwrap names part 'dash_missing', but it gives no such part new uv";
  EXPECT_NE(std::find(result.scene.warnings.begin(), result.scene.warnings.end(), warning),
            result.scene.warnings.end());
}

TEST_F(BakeTest, CancelEndsTheWork) {
  int calls = 0;
  EXPECT_THROW(bake_scene(scene_of({square("dash")}), rules_, {}, [&](const Progress&) { return ++calls < 2; }),
               Cancelled);
}

TEST_F(BakeTest, PicturesOfTheRulesMayLieAnywhereButAreFiles) {
  std::filesystem::create_directory(folder_ / "elsewhere");
  std::filesystem::rename(folder_ / "grain.png", folder_ / "elsewhere" / "grain.png");
  std::filesystem::create_directory(folder_ / "rules");
  rules_.materials.at("grain").texture = folder_ / "rules" / "../elsewhere/grain.png";
  EXPECT_FALSE(run(scene_of({square("dash")})).grains.empty());
  ASSERT_EQ(::mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  for (const char* name : {"pipe.png", "rules"}) {
    rules_.materials.at("grain").texture = folder_ / name;
    EXPECT_THROW(run(scene_of({square("dash")})), IoError) << name;
  }
}

TEST_F(BakeTest, NamesThePictureThatIsNone) {
  rules_.materials.at("grain").texture = folder_ / "missing.png";
  try {
    run(scene_of({square("dash")}));
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("missing.png"), std::string::npos);
  }
}

}  // namespace
}  // namespace papilla
