// SPDX-License-Identifier: MIT
#include "papilla/io/glb_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/named_files.hpp"

namespace papilla {
namespace {

using nlohmann::json;
using test::content_of;
using test::message_of;
using test::TemporaryFolder;

class GlbWriter : public testing::Test {
 protected:
  Scene round_trip(const Scene& scene) const {
    write_glb(scene, folder_ / "a.glb");
    return read_gltf(folder_ / "a.glb");
  }

  json document(const Scene& scene, const GlbWriteOptions& options = {}) const {
    write_glb(scene, folder_ / "a.glb", options);
    const std::string bytes = content_of(folder_ / "a.glb");
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    return json::parse(bytes.substr(20, length));
  }

  std::string refusal(const Scene& scene) const {
    return message_of<InvalidInput>([&] { write_glb(scene, folder_ / "bad.glb"); });
  }

  const TemporaryFolder folder_;
};

TEST_F(GlbWriter, GeometryComesBack) {
  const Scene scene = test::rich_scene();
  const Scene back = round_trip(scene);
  ASSERT_EQ(back.parts.size(), 1U);
  EXPECT_EQ(back.parts[0].mesh.triangles.size(), 12U);
  EXPECT_EQ(back.parts[0].mesh.positions.size(), 8U);
  const auto before = instances(scene), after = instances(back);
  ASSERT_EQ(after.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t t = 0; t < 12; ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec3 there =
            transform_point(multiply(to_y_up(UpAxis::z), before[i].world), scene.parts[0].mesh.corner(t, k));
        const Vec3 here = transform_point(after[i].world, back.parts[0].mesh.corner(t, k));
        EXPECT_NEAR(norm(there - here), 0, 1e-4);
        const auto& uv = scene.parts[0].mesh.uv;
        const auto& uv_back = back.parts[0].mesh.uv;
        const auto at = static_cast<std::size_t>(k);
        EXPECT_NEAR(norm(uv.values[uv.indices[t][at]] - uv_back.values[uv_back.indices[t][at]]), 0, 1e-6);
      }
  }
  EXPECT_EQ(back.parts[0].mesh.material, scene.parts[0].mesh.material);
}

TEST_F(GlbWriter, MaterialsTexturesAndExtrasComeBack) {
  const Scene scene = test::rich_scene();
  const Scene back = round_trip(scene);
  ASSERT_EQ(back.materials.size(), 2U);
  const Material& grain = back.materials[0];
  ASSERT_TRUE(grain.haptic);
  EXPECT_EQ(grain.haptic->stiffness, 900);
  EXPECT_EQ(json::parse(grain.haptic->other_json), json::parse(R"({"empty":[],"big":4294967296,"none":null})"));
  EXPECT_EQ(grain.extras_json, "");
  EXPECT_EQ(json::parse(grain.extensions_json), json::parse(scene.materials[0].extensions_json));
  EXPECT_EQ(grain.base_color, scene.materials[0].base_color);
  EXPECT_TRUE(grain.double_sided);
  EXPECT_EQ(grain.normal_texture->factor, 0.5);
  EXPECT_EQ(grain.normal_texture->transform->offset, (Vec2{0.5, 0}));
  EXPECT_EQ(back.materials[1].alpha_mode, "MASK");
  ASSERT_EQ(back.images.size(), 2U);
  EXPECT_EQ(back.images[0].bytes, scene.images[0].bytes);
  EXPECT_EQ(back.images[0].name, "picture ä");
  EXPECT_EQ(back.images[1].name, "haptic.height") << "a picture that only extras name is kept";
  EXPECT_EQ(back.images[1].extras_json, R"({"i":[]})");
  EXPECT_EQ(back.textures.at(0).wrap_s, 33071);
  EXPECT_EQ(back.textures[0].extras_json, R"({"t":true})");
  EXPECT_EQ(json::parse(back.extras_json), json::parse(scene.extras_json));
  EXPECT_EQ(back.nodes[0].extras_json, scene.nodes[0].extras_json);
  EXPECT_EQ(back.parts[0].extras_json, scene.parts[0].extras_json);
  EXPECT_EQ(back.parts[0].name, scene.parts[0].name);
}

TEST_F(GlbWriter, DeclaresExactlyTheExtensionsInUse) {
  EXPECT_EQ(document(test::rich_scene())["extensionsUsed"], json({"KHR_materials_clearcoat", "KHR_texture_transform"}));
  Scene plain = test::rich_scene();
  plain.materials[0].extensions_json.clear();
  plain.materials[0].normal_texture->transform.reset();
  plain.extras_json = R"({"extensions":{"none":{}}})";
  EXPECT_FALSE(document(plain).contains("extensionsUsed"));
}

TEST_F(GlbWriter, SharesPartsAndStatesTheSource) {
  const json gltf = document(test::rich_scene());
  EXPECT_EQ(gltf["meshes"].size(), 1U);
  EXPECT_EQ(gltf["nodes"].size(), 4U) << "three and the turn from Z up to Y up";
  EXPECT_EQ(gltf["asset"]["extras"]["sourceFormat"], "test");
  EXPECT_EQ(gltf["asset"]["generator"], std::string("papilla ") + version());
  EXPECT_FALSE(gltf["nodes"][0].contains("matrix") || gltf["nodes"][0].contains("rotation")) << "identity";
}

TEST_F(GlbWriter, CarriesOnWhoseAFileIsAndWhatWroteIt) {
  Scene scene = test::rich_scene();
  scene.asset.copyright = "(c) somebody";
  scene.asset.generators = {"modeller 1", "packer 2"};
  scene.asset.extras_json = R"({"license":"CC-BY-4.0","author":["a"]})";
  scene.asset.xmp_packets_json = R"({"packets":[{"dc:rights":"all"}]})";
  scene.asset.xmp_reference_json = R"({"packet":0})";
  const json asset = document(scene)["asset"];
  EXPECT_EQ(asset["copyright"], "(c) somebody");
  EXPECT_EQ(asset["extras"]["license"], "CC-BY-4.0");
  EXPECT_EQ(asset["extras"]["generators"], json({"modeller 1", "packer 2", std::string("papilla ") + version()}));
  const Scene back = read_gltf(folder_ / "a.glb");
  EXPECT_EQ(back.asset.copyright, scene.asset.copyright);
  EXPECT_EQ(json::parse(back.asset.extras_json), json::parse(scene.asset.extras_json));
  EXPECT_EQ(json::parse(back.asset.xmp_packets_json), json::parse(scene.asset.xmp_packets_json));
  EXPECT_EQ(json::parse(back.asset.xmp_reference_json), json::parse(scene.asset.xmp_reference_json));
  EXPECT_EQ(back.asset.generators.size(), 3U);
  EXPECT_TRUE(back.losses.empty()) << back.losses[0];
  EXPECT_EQ(round_trip(back).asset.generators.size(), 3U) << "our own name is not piled up";
  scene.asset.extras_json = "[]";
  EXPECT_NE(refusal(scene).find("asset.extras"), std::string::npos);
}

TEST_F(GlbWriter, PicturesOfOtherFormatsKeepTheirExtensions) {
  Scene scene = test::rich_scene();
  scene.images[1].mime_type = "image/webp";
  scene.textures[0].others = {{"EXT_texture_webp", 1}};
  json gltf = document(scene);
  EXPECT_EQ(gltf["textures"][0]["source"], 0);
  EXPECT_EQ(gltf["textures"][0]["extensions"]["EXT_texture_webp"]["source"], 1);
  EXPECT_FALSE(gltf.contains("extensionsRequired")) << "there is a PNG";
  EXPECT_EQ(read_gltf(folder_ / "a.glb").textures.at(0).others.at(0).image, 1U);
  scene.textures[0].image = 1;
  gltf = document(scene);
  EXPECT_FALSE(gltf["textures"][0].contains("source"));
  EXPECT_EQ(gltf["extensionsRequired"], json({"EXT_texture_webp"}));
  EXPECT_EQ(read_gltf(folder_ / "a.glb").textures.at(0).image, 1U);
  scene.textures[0].others[0].image = 7;
  EXPECT_NE(refusal(scene), "");
}

TEST_F(GlbWriter, TangentsOnlyWhereANormalTextureNeedsThem) {
  const json primitives = document(test::rich_scene())["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2U);
  EXPECT_TRUE(primitives[0]["attributes"].contains("TANGENT"));
  EXPECT_FALSE(primitives[1]["attributes"].contains("TANGENT"));
}

TEST_F(GlbWriter, PicturesKeepAllThatPlacesThem) {
  Scene scene = test::rich_scene();
  scene.textures[0].wrap_t = 33648;
  scene.materials[0].normal_texture->tex_coord = 1;
  scene.materials[0].normal_texture->transform = UvTransform{{0.5, 0.25}, 0.3, {2, 3}};
  const json attributes = document(scene)["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_TRUE(attributes.contains("TEXCOORD_1")) << "the texture needs coordinates";
  const Scene back = round_trip(scene);
  EXPECT_EQ(back.textures.at(0).wrap_s, 33071);
  EXPECT_EQ(back.textures[0].wrap_t, 33648);
  ASSERT_TRUE(back.materials.at(0).normal_texture);
  EXPECT_EQ(back.materials[0].normal_texture->tex_coord, 1);
  EXPECT_EQ(back.materials[0].normal_texture->transform, scene.materials[0].normal_texture->transform);
}

/// The tangents of the first primitive of a scene.
std::vector<std::array<float, 4>> written_tangents(const json& gltf, const std::string& bytes) {
  const json& accessor =
      gltf["accessors"][gltf["meshes"][0]["primitives"][0]["attributes"]["TANGENT"].get<std::size_t>()];
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const std::size_t begin =
      28 + length + gltf["bufferViews"][accessor["bufferView"].get<std::size_t>()].value("byteOffset", std::size_t{0});
  std::vector<std::array<float, 4>> tangents(accessor["count"].get<std::size_t>());
  std::memcpy(tangents.data(), bytes.data() + begin, 16 * tangents.size());
  return tangents;
}

/// A quad whose second coordinates run along y and x: a mirror image.
TEST_F(GlbWriter, TangentsAreThoseOfTheCoordinatesOfTheNormalMap) {
  Scene scene = test::rich_scene();
  scene.up = UpAxis::y;
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh = {};
  mesh.positions = {{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.uv.values = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.uv1.values = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  mesh.uv.indices = mesh.uv1.indices = {{0, 1, 2}, {0, 2, 3}};
  for (const int channel : {0, 1}) {
    scene.materials[0].normal_texture->tex_coord = channel;
    const json gltf = document(scene);
    const auto tangents = written_tangents(gltf, content_of(folder_ / "a.glb"));
    ASSERT_EQ(tangents.size(), 4U);
    for (const auto& tangent : tangents)
      EXPECT_EQ(tangent, (channel == 0 ? std::array<float, 4>{1, 0, 0, 1} : std::array<float, 4>{0, 1, 0, -1}));
  }
}

/// Two quads whose second coordinates are mirrored at their common edge: that has vertices of either hand.
TEST_F(GlbWriter, VerticesBetweenMirrorImagesHaveBothHands) {
  Scene scene = test::rich_scene();
  scene.up = UpAxis::y;
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh = {};
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {0, 10, 0}, {10, 10, 0}, {20, 10, 0}};
  mesh.triangles = mesh.uv.indices = mesh.uv1.indices = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  mesh.uv.values = {{0, 0}, {0.5, 0}, {1, 0}, {0, 1}, {0.5, 1}, {1, 1}};
  mesh.uv1.values = {{0, 0}, {1, 0}, {0, 0}, {0, 1}, {1, 1}, {0, 1}};
  scene.materials[0].normal_texture->tex_coord = 1;
  const json gltf = document(scene);
  auto tangents = written_tangents(gltf, content_of(folder_ / "a.glb"));
  std::sort(tangents.begin(), tangents.end());
  ASSERT_EQ(tangents.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_EQ(tangents[i], (i < 4 ? std::array<float, 4>{-1, 0, 0, -1} : std::array<float, 4>{1, 0, 0, 1})) << i;
}

/// The cube, all of it of the first material, whose tag holds a map of four bytes.
Scene tagged_scene() {
  Scene scene = test::rich_scene();
  scene.parts[0].mesh.material.assign(12, 0);
  scene.materials[0].extras_json =
      R"({"haptic":{"version":1,"dynamicFriction":0.35,"height":{"uri":"data:image/png;base64,iVBORw==","scale":2e-4}}})";
  return scene;
}

TEST_F(GlbWriter, TheHapticTagIsWrittenAsItIsRead) {
  Scene scene = tagged_scene();
  const Scene once = round_trip(scene), twice = round_trip(once);
  ASSERT_TRUE(once.materials[0].haptic && once.materials[0].haptic->height);
  EXPECT_EQ(once.materials[0].haptic->height->uri, "data:image/png;base64,iVBORw==");
  EXPECT_EQ(twice.materials[0].haptic, once.materials[0].haptic);
  scene = once;
  scene.materials[0].extras_json = "[1]";
  EXPECT_THROW(write_glb(scene, folder_ / "a.glb"), InvalidInput);
}

TEST_F(GlbWriter, MirrorsHeightMapsAsTexturesOfMeshes) {
  const Scene scene = tagged_scene();
  const json gltf = document(scene, {.mirror_mpeg_haptics = true});
  EXPECT_EQ(gltf["meshes"][0]["extensions"]["MPEG_material_haptic"]["hapticMaterialIndex"], 0);
  const json& material = gltf["extensions"]["MPEG_material_haptic"]["materials"].at(0);
  EXPECT_EQ(material["name"], "grain");
  const json& layer = material["vibrotactileTexture"].at(0);
  EXPECT_EQ(layer["type"], "High_Resolution");
  EXPECT_EQ(layer["extras"]["scale"], 2e-4);
  EXPECT_EQ(layer["texture"]["extensions"], gltf["materials"][0]["normalTexture"]["extensions"]);
  const json& image =
      gltf["images"].at(gltf["textures"].at(layer["texture"]["index"].get<std::size_t>())["source"].get<std::size_t>());
  EXPECT_EQ(gltf["bufferViews"].at(image["bufferView"].get<std::size_t>())["byteLength"], 4);
  EXPECT_EQ(round_trip(scene).materials[0].extras_json, read_gltf(folder_ / "a.glb").materials[0].extras_json);
  EXPECT_FALSE(gltf.contains("extensionsRequired"));
  const auto used = gltf["extensionsUsed"].get<std::vector<std::string>>();
  EXPECT_EQ(std::count(used.begin(), used.end(), "MPEG_material_haptic"), 1);
}

TEST_F(GlbWriter, MirrorsFrictionAsPhysicsMaterials) {
  const json gltf = document(tagged_scene(), {.mirror_khr_physics = true});
  const json& material = gltf["extensions"]["KHR_physics_rigid_bodies"]["physicsMaterials"].at(0);
  EXPECT_EQ(material["staticFriction"], 0.35) << "each other's default";
  EXPECT_EQ(material["dynamicFriction"], 0.35);
  Scene rough = tagged_scene();
  rough.materials[0].extras_json = R"({"haptic":{"version":1,"staticFriction":0.65}})";
  const json other = document(rough, {.mirror_khr_physics = true})["extensions"]["KHR_physics_rigid_bodies"];
  EXPECT_EQ(other["physicsMaterials"].at(0)["staticFriction"], 0.65);
  EXPECT_EQ(other["physicsMaterials"].at(0)["dynamicFriction"], 0.65);
  int colliders = 0;
  for (std::size_t i = 0; i < gltf["nodes"].size(); ++i) {
    const json& node = gltf["nodes"][i];
    EXPECT_EQ(node.contains("mesh"), node.contains("extensions"));
    if (!node.contains("mesh")) continue;
    ++colliders;
    EXPECT_EQ(node["extensions"]["KHR_physics_rigid_bodies"]["collider"]["geometry"]["node"], i);
  }
  EXPECT_EQ(colliders, 2);
}

TEST_F(GlbWriter, MirrorsNothingOfMeshesOfSeveralMaterials) {
  Scene scene = tagged_scene();
  scene.parts[0].mesh.material[3] = 1;
  const auto losses = write_glb(scene, folder_ / "a.glb", {.mirror_mpeg_haptics = true, .mirror_khr_physics = true});
  EXPECT_EQ(std::count_if(losses.begin(), losses.end(),
                          [](const std::string& loss) { return loss.find("several materials") != std::string::npos; }),
            2);
  const json gltf = document(scene, {.mirror_mpeg_haptics = true, .mirror_khr_physics = true});
  EXPECT_FALSE(gltf["meshes"][0].contains("extensions"));
  scene.materials[0].extras_json.clear();
  EXPECT_FALSE(document(scene, {.mirror_mpeg_haptics = true, .mirror_khr_physics = true}).contains("extensions"));
}

TEST_F(GlbWriter, AGltfWithFilesBesideItIsTheSameScene) {
  const Scene scene = test::rich_scene(), one = round_trip(scene);
  const test::TemporaryFolder folder;
  write_gltf(scene, folder / "my dash.gltf");
  const auto names = named_files(folder / "my dash.gltf");
  EXPECT_TRUE(names.contains("my_dash.bin"));
  EXPECT_GT(names.size(), 1U) << "pictures";
  EXPECT_EQ(folder.files(), names.size() + 1);
  const Scene two = read_gltf(folder / "my dash.gltf");
  ASSERT_EQ(two.parts.size(), one.parts.size());
  for (std::size_t p = 0; p < one.parts.size(); ++p)
    EXPECT_EQ(two.parts[p].mesh.positions, one.parts[p].mesh.positions);
  ASSERT_EQ(two.images.size(), one.images.size());
  for (std::size_t i = 0; i < one.images.size(); ++i) EXPECT_EQ(two.images[i].bytes, one.images[i].bytes);
  EXPECT_EQ(two.losses, one.losses);
}

TEST_F(GlbWriter, AGltfIsReplacedWhateverTheCaseOfItsExtension) {
  const test::TemporaryFolder folder;
  write_gltf(test::rich_scene(), folder / "a.Gltf");
  EXPECT_TRUE(named_files(folder / "a.Gltf").contains("a.bin"));
  Scene other = test::rich_scene();
  other.parts[0].mesh.positions[0].x += 1;
  EXPECT_NO_THROW(write_gltf(other, folder / "a.Gltf")) << "a.bin is its own";
}

TEST_F(GlbWriter, NamesOfFilesOfPicturesAreShort) {
  Scene scene = test::rich_scene();
  ASSERT_GT(scene.images.size(), 0U);
  for (EncodedImage& image : scene.images) image.name = std::string(300, 'x');
  const test::TemporaryFolder folder;
  write_gltf(scene, folder / "a.gltf");
  EXPECT_TRUE(std::filesystem::exists(folder / ("a-" + std::string(64, 'x') + ".png")));
}

/// A former output may be anything.
TEST_F(GlbWriter, FormerFilesMayBeNestedDeep) {
  const test::TemporaryFolder folder;
  constexpr std::size_t k_deep = 1'000'000;
  const std::string nested = std::string(k_deep, '[') + std::string(k_deep, ']');
  folder.write("a.gltf", R"({"extras": )" + nested + R"(, "images": [{"uri": "my%20map.png"}, {"uri": "data:,x"}]})");
  EXPECT_EQ(named_files(folder / "a.gltf"), std::set<std::string>{"my map.png"});
}

TEST_F(GlbWriter, LevelsOfDetailAreNodesThatNoSceneNames) {
  Scene scene = test::rich_scene();
  for (const double coverage : {0.5, 0.25}) {
    PartLevel level{scene.parts[0].mesh, coverage};
    level.mesh.triangles.resize(6);
    level.mesh.uv.indices.resize(6);
    level.mesh.material.resize(6);
    scene.parts[0].levels.push_back(level);
  }
  const json gltf = document(scene);
  EXPECT_EQ(gltf["meshes"].size(), 3U) << "shared by both instances";
  EXPECT_EQ(gltf["nodes"].size(), 8U);
  const json& left = gltf["nodes"][1];
  EXPECT_EQ(left["extensions"]["MSFT_lod"]["ids"], json({3, 4}));
  EXPECT_EQ(left["extras"]["MSFT_screencoverage"], json({0.5, 0.25, 0}));
  EXPECT_EQ(gltf["nodes"][3]["name"], "left_LOD1");
  for (const char* key : {"translation", "rotation", "scale"}) EXPECT_EQ(gltf["nodes"][4][key], left[key]) << key;
  EXPECT_EQ(gltf["extensionsUsed"].back(), "MSFT_lod");

  const Scene back = round_trip(scene), plain = round_trip(test::rich_scene());
  EXPECT_EQ(back.parts.size(), 1U);
  EXPECT_EQ(back.nodes.size(), plain.nodes.size());
  EXPECT_EQ(back.parts[0].mesh.triangles, plain.parts[0].mesh.triangles);
  EXPECT_EQ(back.nodes[1].extras_json, plain.nodes[1].extras_json);
  ASSERT_EQ(back.losses.size(), plain.losses.size() + 1);
  EXPECT_NE(back.losses.back().find("4 coarser levels"), std::string::npos) << back.losses.back();
}

TEST_F(GlbWriter, LevelsOfANodeWithChildrenDoNotTakeTheseAway) {
  Scene scene = test::rich_scene();
  scene.nodes[1].children = {2};
  scene.nodes[0].children = {1};
  scene.parts[0].levels.push_back({scene.parts[0].mesh, 0.1});
  const Scene back = round_trip(scene);
  const auto before = instances(scene), after = instances(back);
  ASSERT_EQ(after.size(), before.size());
  EXPECT_FALSE(back.nodes[1].part) << "its mesh went to a leaf";
}

TEST_F(GlbWriter, RefusesCoveragesThatDoNotDescend) {
  for (const double wrong : {0.6, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    Scene scene = test::rich_scene();
    scene.parts[0].levels = {{scene.parts[0].mesh, 0.5}, {scene.parts[0].mesh, wrong}};
    EXPECT_NE(refusal(scene).find("level 2 has a screen coverage of"), std::string::npos);
  }
}

TEST_F(GlbWriter, SameSceneSameBytes) {
  write_glb(test::rich_scene(), folder_ / "a.glb");
  write_glb(test::rich_scene(), folder_ / "b.glb");
  EXPECT_EQ(content_of(folder_ / "a.glb"), content_of(folder_ / "b.glb"));
}

TEST_F(GlbWriter, WideIndicesFromTheRestartValueOn) {
  for (const std::size_t vertices : {65535U, 65536U}) {
    Part part;
    for (std::size_t i = 0; i < vertices; ++i)
      part.mesh.positions.push_back({double(i % 256), double(i / 256), double(i % 7)});
    for (Index i = 0; i + 2 < vertices; ++i) part.mesh.triangles.push_back({i, i + 1, i + 2});
    part.mesh.normals.values = {{0, 0, 1}};
    part.mesh.normals.indices.assign(part.mesh.triangles.size(), {0, 0, 0});
    const json gltf = document(single_part_scene(part, "test"));
    const json indices = gltf["accessors"][gltf["meshes"][0]["primitives"][0]["indices"].get<std::size_t>()];
    EXPECT_EQ(indices["componentType"], vertices == 65535 ? 5123 : 5125);
  }
}

TEST_F(GlbWriter, MissingUvAndNormalsAreMade) {
  Scene scene = test::rich_scene();
  scene.parts[0].mesh.uv = {};
  const Scene back = round_trip(scene);
  EXPECT_FALSE(back.parts[0].mesh.uv.empty()) << "the texture needs coordinates";
  ASSERT_FALSE(back.parts[0].mesh.normals.empty());
  for (const Vec3& normal : back.parts[0].mesh.normals.values) EXPECT_NEAR(norm(normal), 1, 1e-6);
}

TEST_F(GlbWriter, ColoursAndSecondChannelComeBack) {
  Scene scene = test::rich_scene();
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh.colors.values = {{0.25F, 0.5F, 1, 0.75F}};
  mesh.colors.indices.assign(12, {0, 0, 0});
  mesh.uv1.values = {{3, -2}};
  mesh.uv1.indices.assign(12, {0, 0, 0});
  mesh.uv = {};
  const Scene back = round_trip(scene);
  const Color color = back.parts[0].mesh.colors.values.at(0);
  EXPECT_NEAR(color.r, 0.25, 1e-5);
  EXPECT_NEAR(color.a, 0.75, 1e-5);
  EXPECT_EQ(back.parts[0].mesh.uv1.values.at(0), (Vec2{3, -2}));
}

TEST_F(GlbWriter, AnEmptySceneIsAValidFile) {
  const json gltf = document(Scene{});
  EXPECT_FALSE(gltf.contains("buffers") || gltf.contains("nodes") || gltf.contains("meshes"));
  EXPECT_TRUE(read_gltf(folder_ / "a.glb").parts.empty());
}

TEST_F(GlbWriter, ReferencesToMissingPicturesAreLeftOut) {
  Scene scene = test::rich_scene();
  scene.images[0].bytes.clear();
  scene.materials[0].extensions_json.clear();
  const json gltf = document(scene);
  EXPECT_EQ(gltf["images"].size(), 1U);
  EXPECT_FALSE(gltf["materials"][0].contains("normalTexture"));
}

TEST_F(GlbWriter, RefusesWhatGltfCannotHold) {
  Scene shear = test::rich_scene();
  shear.nodes[1].local[0] = 0.5;
  EXPECT_NE(refusal(shear).find("shears"), std::string::npos);
  Scene nan = test::rich_scene();
  nan.parts[0].mesh.positions[3].y = std::nan("");
  EXPECT_NE(refusal(nan).find("position 3"), std::string::npos);
  Scene huge = test::rich_scene();
  huge.parts[0].mesh.positions[0].x = 1e300;
  EXPECT_NE(refusal(huge), "");
  Scene index = test::rich_scene();
  index.parts[0].mesh.triangles[0][0] = 8;
  EXPECT_NE(refusal(index), "");
  Scene slot = test::rich_scene();
  slot.parts[0].mesh.material[0] = 2;
  EXPECT_NE(refusal(slot), "");
  Scene material = test::rich_scene();
  material.parts[0].materials[1] = 9;
  EXPECT_NE(refusal(material), "");
  Scene extras = test::rich_scene();
  extras.materials[0].extras_json = "{";
  EXPECT_NE(refusal(extras).find("grain"), std::string::npos);
  EXPECT_EQ(folder_.files(), 0U) << "nothing is left behind";
}

TEST_F(GlbWriter, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_THROW(write_glb(test::rich_scene(), "/dev/full"), IoError);
}

TEST_F(GlbWriter, PrefixesOfItsOutputAreRefused) {
  write_glb(test::rich_scene(), folder_ / "a.glb");
  const std::string whole = content_of(folder_ / "a.glb");
  for (std::size_t length = 0; length < whole.size(); length += 17)
    ASSERT_THROW(read_gltf(folder_.write("cut.glb", whole.substr(0, length))), InvalidInput) << length;
}

}  // namespace
}  // namespace papilla
