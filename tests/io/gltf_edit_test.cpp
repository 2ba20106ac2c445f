// SPDX-License-Identifier: MIT
#include "papilla/io/gltf_edit.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "io/glb_fixture.hpp"
#include "io/gltf_comparison.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/gltf_vertices.hpp"
#include "papilla/io/named_files.hpp"

namespace papilla {
namespace {

using nlohmann::ordered_json;
using test::GlbFixture;

/// One scene file, edited.
class GltfEditTest : public testing::Test {
 protected:
  /// @param members  of the root, each followed by a comma.
  void write(const GlbFixture& glb, const std::string& members, const std::string& further_chunks = "") {
    std::string bytes = glb.glb(members) + further_chunks;
    const auto length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data() + 8, &length, sizeof length);
    folder_.write("in.glb", bytes);
    scene_ = read_gltf(in(), {}, &origin_);
  }

  static GltfSurfaceEdit tagged(std::uint32_t part, std::uint32_t slot, const std::string& rule, double stiffness) {
    GltfSurfaceEdit edit;
    edit.part = part, edit.slot = slot;
    edit.rule = rule;
    edit.tag.emplace();
    edit.tag->stiffness = stiffness;
    return edit;
  }

  /// Every triangle a chart of its own.
  static CornerAttribute<Vec2> torn_uv(std::size_t triangles) {
    CornerAttribute<Vec2> uv;
    for (Index t = 0; t < triangles; ++t) {
      for (const Vec2 corner : {Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}}) uv.values.push_back(corner + Vec2{2.0 * t, 0});
      uv.indices.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return uv;
  }

  ordered_json edit(std::vector<GltfSurfaceEdit> edits) {
    result_ = write_edited_gltf(in(), scene_, origin_, std::move(edits), out());
    const auto differences = test::unlisted_differences(in(), out(), result_.changes);
    EXPECT_TRUE(differences.empty()) << differences.front();
    return test::RawGltf(out()).json;
  }

  bool changed(const std::string& pointer) const {
    return std::any_of(result_.changes.begin(), result_.changes.end(),
                       [&](const GltfChange& change) { return change.pointer == pointer; });
  }

  std::filesystem::path in() const { return folder_ / "in.glb"; }
  std::filesystem::path out() const { return folder_ / "out.glb"; }

  const test::TemporaryFolder folder_;
  Scene scene_;
  GltfOrigin origin_;
  GltfEditResult result_;
};

const std::vector<float> k_square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// Two meshes, each a square, that show the materials by number.
std::string two_meshes(const std::string& first, const std::string& second) {
  const auto primitive = [](const std::string& more) {
    return R"({"primitives":[{"attributes":{"POSITION":0},"indices":1)" + more + "}]}";
  };
  return R"("scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"name":"a"},{"mesh":1,"name":"b"}],"meshes":[)" +
         primitive(first) + "," + primitive(second) + "],";
}

GlbFixture square() {
  GlbFixture glb;
  glb.positions(k_square);
  glb.accessor(glb.view(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}), 5123, 6, "SCALAR");
  return glb;
}

TEST_F(GltfEditTest, ATagGoesIntoTheMaterialAndTheListOfTags) {
  write(square(), two_meshes(R"(,"material":0)", R"(,"material":1)") +
                      R"("materials":[{"name":"m","extras":{"own":[1.50,2]}},{}],"cameras":[{"type":"orthographic",)"
                      R"("orthographic":{"xmag":1,"ymag":1,"zfar":9,"znear":0.1}}],"extras":{"x":null},)");
  const auto json = edit({tagged(0, 0, "hard", 700)});
  EXPECT_EQ(json["materials"][0]["extras"]["haptic"]["stiffness"], 700);
  EXPECT_EQ(json["materials"][0]["extras"]["papilla"]["material"], "hard");
  EXPECT_EQ(json["materials"].size(), 2U);
  EXPECT_EQ(result_.changes.size(), 4U);
  for (const char* pointer :
       {"/materials/0/extras/haptic", "/materials/0/extras/papilla", "/nodes/0/extras", "/asset/extras"})
    EXPECT_TRUE(changed(pointer)) << pointer;
  ASSERT_EQ(result_.scene.materials.at(0).haptic->stiffness, 700);
}

TEST_F(GltfEditTest, AMaterialThatOthersShowIsCopied) {
  write(square(), two_meshes(R"(,"material":0)", R"(,"material":0)") +
                      R"("materials":[{"name":"m","pbrMetallicRoughness":{"metallicFactor":0.25}}],)");
  const auto json = edit({tagged(0, 0, "hard", 700)});
  ASSERT_EQ(json["materials"].size(), 2U);
  EXPECT_FALSE(json["materials"][0].contains("extras"));
  EXPECT_EQ(json["materials"][1]["name"], "m hard");
  EXPECT_EQ(json["materials"][1]["pbrMetallicRoughness"]["metallicFactor"], 0.25);
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["material"], 1);
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["material"], 0);
  EXPECT_TRUE(changed("/materials/1"));
  EXPECT_TRUE(changed("/meshes/0/primitives/0/material"));
}

TEST_F(GltfEditTest, TwoRulesForOneMaterialGiveOneCopy) {
  write(square(), two_meshes(R"(,"material":0)", R"(,"material":0)") + R"("materials":[{}],)");
  const auto json = edit({tagged(0, 0, "hard", 700), tagged(1, 0, "soft", 100)});
  ASSERT_EQ(json["materials"].size(), 2U);
  EXPECT_EQ(json["materials"][0]["extras"]["haptic"]["stiffness"], 700);
  EXPECT_EQ(json["materials"][1]["extras"]["haptic"]["stiffness"], 100);
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["material"], 1);
}

TEST_F(GltfEditTest, APrimitiveWithoutMaterialGetsOne) {
  write(square(), two_meshes("", ""));
  const auto json = edit({tagged(1, 0, "hard", 700)});
  EXPECT_FALSE(json["meshes"][0]["primitives"][0].contains("material"));
  EXPECT_EQ(json["meshes"][1]["primitives"][0]["material"], 0);
  EXPECT_EQ(json["materials"][0]["name"], "hard");
  EXPECT_FALSE(json["materials"][0].contains("pbrMetallicRoughness"));
}

TEST_F(GltfEditTest, TheMaterialsOfVariantsAreTaggedToo) {
  const std::string variants =
      R"(,"extensions":{"KHR_materials_variants":{"mappings":[{"material":1,"variants":[0]},{"material":0,"variants":[1]}]}})";
  write(square(), two_meshes(R"(,"material":0)" + variants, R"(,"material":1)") +
                      R"("materials":[{"name":"day"},{"name":"night"}],"extensionsUsed":["KHR_materials_variants"],)"
                      R"("extensions":{"KHR_materials_variants":{"variants":[{"name":"n"},{"name":"d"}]}},)");
  const auto json = edit({tagged(0, 0, "hard", 700)});
  ASSERT_EQ(json["materials"].size(), 3U);  // "night" is shown by the other mesh, too
  EXPECT_TRUE(json["materials"][0]["extras"].contains("haptic"));
  EXPECT_FALSE(json["materials"][1].contains("extras"));
  const auto& primitive = json["meshes"][0]["primitives"][0];
  const auto& mappings = primitive["extensions"]["KHR_materials_variants"]["mappings"];
  EXPECT_EQ(primitive["material"], 0);
  EXPECT_EQ(mappings[0]["material"], 2);
  EXPECT_EQ(mappings[1]["material"], 0);
  EXPECT_EQ(json["materials"][2]["extras"]["haptic"]["stiffness"], 700);
}

TEST_F(GltfEditTest, ExtrasThatAreNoObjectAreRefusedOnlyWhereATagMustGo) {
  write(square(), two_meshes(R"(,"material":0)", "") + R"("materials":[{"name":"m","extras":"mine"}],)");
  EXPECT_NE(test::message_of<InvalidInput>([&] { edit({tagged(0, 0, "hard", 700)}); }).find("material 0 'm'"),
            std::string::npos);
  EXPECT_EQ(edit({})["materials"][0]["extras"], "mine");
}

TEST_F(GltfEditTest, ChunksBehindTheBinaryOneStay) {
  const std::string chunk = GlbFixture::word(4) + "ABCDwxyz";
  write(square(), two_meshes("", ""), chunk);
  edit({tagged(0, 0, "hard", 700)});
  EXPECT_TRUE(test::content_of(out()).ends_with(chunk));
}

TEST_F(GltfEditTest, NewUvWithoutTearsAreOneMoreAttribute) {
  GlbFixture glb = square();
  glb.accessor(glb.view(std::vector<float>(8, 0.5F)), 5126, 4, "VEC2");
  write(glb, test::mesh_of(R"({"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0})") +
                 R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{}],)");
  GltfSurfaceEdit edit_square = tagged(0, 0, "grain", 700);
  edit_square.uv = {{{0, 0}, {2, 0}, {2, 3}, {0, 3}}, {{0, 1, 2}, {0, 2, 3}}};
  edit_square.tag->height.emplace();
  const auto json = edit({edit_square});
  const auto& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["indices"], 1);
  EXPECT_EQ(primitive["attributes"]["POSITION"], 0);
  EXPECT_EQ(primitive["attributes"]["TEXCOORD_1"], 3);
  EXPECT_EQ(json["materials"][0]["extras"]["haptic"]["height"]["texCoord"], 1);
  EXPECT_EQ(json["accessors"].size(), 4U);
  const TriangleMesh mesh = read_gltf(out()).parts.at(0).mesh;
  EXPECT_EQ(mesh.uv1.values.at(mesh.uv1.indices[1][2]), (Vec2{0, 3}));
  EXPECT_EQ(mesh.uv.values.at(0), (Vec2{0.5, 0.5}));
}

/// A channel that the file's pictures name can't be the grain's, even where a primitive lacks it.
TEST_F(GltfEditTest, AMissingChannelOfThePicturesStaysFree) {
  write(square(), test::mesh_of(R"({"attributes":{"POSITION":0},"indices":1,"material":0})") +
                      R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{}],)");
  GltfSurfaceEdit edit_square = tagged(0, 0, "grain", 700);
  edit_square.uv = {{{0, 0}, {2, 0}, {2, 3}, {0, 3}}, {{0, 1, 2}, {0, 2, 3}}};
  const auto json = edit({edit_square});
  const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  ASSERT_TRUE(attributes.contains("TEXCOORD_1"));
  EXPECT_FALSE(json["accessors"][attributes["TEXCOORD_0"].get<std::size_t>()].contains("bufferView"));
}

/// Quantized positions with gaps, joints, and a sparse morph target: what a vertex carries is repeated as it is stored.
TEST_F(GltfEditTest, TornVerticesAreRepeatedInTheirOwnTypes) {
  GlbFixture glb;
  const std::vector<std::int16_t> positions = {0, 0, 0, 77, 100, 0, 0, 77, 100, 100, 0, 77, 0, 100, 0, 77};
  glb.accessor(glb.view(positions, R"(,"byteStride":8)"), 5122, 4, "VEC3");
  glb.accessor(glb.view(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}), 5121, 6, "SCALAR");
  glb.accessor(glb.view(std::vector<std::uint8_t>{1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0}), 5121, 4, "VEC4");
  glb.accessor(glb.view(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), 5126, 4, "VEC4");
  const int index = glb.view(std::vector<std::uint8_t>{2}), value = glb.view(std::vector<float>{0, 0, 5});
  glb.accessor(-1, 5126, 4, "VEC3",
               R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(index) +
                   R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(value) + "}}");
  write(glb, test::mesh_of(R"({"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1,)"
                           R"("targets":[{"POSITION":4}]})"));
  GltfSurfaceEdit torn = tagged(0, 0, "grain", 700);
  torn.uv = torn_uv(2);
  const auto json = edit({torn});
  const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  const auto& accessor = json["accessors"][attributes["POSITION"].get<std::size_t>()];
  EXPECT_EQ(accessor["componentType"], 5122);
  EXPECT_EQ(accessor["count"], 6);
  EXPECT_TRUE(attributes.contains("TEXCOORD_0"));
  const GltfVertices before = GltfVertexReader(in()).read(0, 0), after = GltfVertexReader(out()).read(0, 0);
  ASSERT_EQ(after.count, 6U);
  const auto expect_repeated = [](const GltfAttribute& a, const GltfAttribute& b) {
    const std::size_t size = a.element_bytes;
    ASSERT_EQ(b.bytes.size(), 6 * size);
    EXPECT_EQ(std::memcmp(a.bytes.data(), b.bytes.data(), 4 * size), 0);
    EXPECT_EQ(std::memcmp(a.bytes.data(), b.bytes.data() + 4 * size, size), 0) << "vertex 0 again";
    EXPECT_EQ(std::memcmp(a.bytes.data() + 2 * size, b.bytes.data() + 5 * size, size), 0) << "vertex 2 again";
  };
  for (const GltfAttribute& a : before.attributes)
    for (const GltfAttribute& b : after.attributes)
      if (a.name == b.name) expect_repeated(a, b);
  expect_repeated(before.targets.at(0).at(0), after.targets.at(0).at(0));
  const TriangleMesh mesh = read_gltf(out()).parts.at(0).mesh;
  ASSERT_EQ(mesh.triangles.size(), 2U);
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(mesh.uv.values[mesh.uv.indices[t][k]], torn.uv.values[torn.uv.indices[t][k]]);
}

TEST_F(GltfEditTest, ATornStripBecomesTriangles) {
  GlbFixture glb;
  glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  write(glb, test::mesh_of(R"({"attributes":{"POSITION":0},"mode":5})"));
  GltfSurfaceEdit torn = tagged(0, 0, "grain", 700);
  torn.uv = torn_uv(2);
  const auto json = edit({torn});
  EXPECT_EQ(json["meshes"][0]["primitives"][0]["mode"], 4);
  const TriangleMesh before = scene_.parts.at(0).mesh, after = read_gltf(out()).parts.at(0).mesh;
  for (std::size_t t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(before.corner(t, k), after.corner(t, k));
}

/// Of two primitives on the same vertices, the one that nothing is wanted of keeps them.
TEST_F(GltfEditTest, VerticesThatPrimitivesShareAreWrittenOnce) {
  GlbFixture glb = square();
  glb.accessor(glb.view(std::vector<std::uint16_t>{2, 1, 0}), 5123, 3, "SCALAR");
  const std::string primitive = R"({"attributes":{"POSITION":0},"indices":)";
  write(glb, test::mesh_of(primitive + "1}," + primitive + R"(2,"material":0},)" + primitive + R"(2,"material":1})") +
                 R"("materials":[{},{}],)");
  GltfSurfaceEdit first = tagged(0, 0, "grain", 700), second = tagged(0, 1, "grain", 700);
  first.uv = torn_uv(2);
  second.uv = torn_uv(1);
  const auto json = edit({first, second});
  const auto& primitives = json["meshes"][0]["primitives"];
  EXPECT_EQ(primitives[0]["attributes"], primitives[1]["attributes"]);
  EXPECT_EQ(primitives[2]["attributes"]["POSITION"], 0);
  EXPECT_EQ(primitives[2]["indices"], 2);
}

/// The triangle that is not turned keeps its normals at the vertices that both share.
TEST_F(GltfEditTest, ATurnedTriangleGetsReversedCornersAndNegatedNormals) {
  GlbFixture glb = square();
  glb.accessor(glb.view(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}), 5126, 4, "VEC3");
  write(glb,
        test::mesh_of(R"({"attributes":{"POSITION":0,"NORMAL":2},"indices":1,"material":0})") + R"("materials":[{}],)");
  for (Triangle* triangle : {&scene_.parts[0].mesh.triangles[1], &origin_.parts[0].primitives[0].vertices[1]})
    std::swap((*triangle)[1], (*triangle)[2]);
  GltfSurfaceEdit turned;
  turned.turned = {0, 1};
  turned.keeps_material = true;
  const auto json = edit({turned});
  EXPECT_EQ(json["materials"], ordered_json::parse("[{}]"));
  const TriangleMesh mesh = read_gltf(out()).parts.at(0).mesh;
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.corner(t, static_cast<int>(k)), scene_.parts[0].mesh.corner(t, static_cast<int>(k)));
      EXPECT_EQ(mesh.normals.values[mesh.normals.indices[t][k]], (Vec3{0, 0, t == 0 ? 1.0 : -1.0}));
    }
}

TEST_F(GltfEditTest, TheNormalMapOfTheFileStays) {
  const EncodedImage map{"grain normal", "image/png", "", std::vector<std::byte>(16), ""};
  write(square(), two_meshes(R"(,"material":0)", R"(,"material":1)") +
                      R"("materials":[{"normalTexture":{"index":0}},{}],"textures":[{}],)");
  GltfSurfaceEdit own = tagged(0, 0, "grain", 700), free = tagged(1, 0, "grain", 700);
  own.uv = free.uv = {{{0, 0}, {2, 0}, {2, 3}, {0, 3}}, {{0, 1, 2}, {0, 2, 3}}};
  own.normal_map = free.normal_map = &map;
  const auto json = edit({own, free});
  EXPECT_EQ(json["materials"][0]["normalTexture"]["index"], 0);
  EXPECT_EQ(json["materials"][1]["normalTexture"]["index"], 1);
  ASSERT_EQ(result_.notes.size(), 1U);
  EXPECT_NE(result_.notes[0].find("keeps its own normal map"), std::string::npos);
}

/// What keeps materials apart in files that are written anew would change how the material looks.
TEST_F(GltfEditTest, ATagAloneChangesNothingThatIsSeen) {
  write(square(), two_meshes(R"(,"material":0)", R"(,"material":1)") + R"("materials":[{},{}],)");
  const auto json = edit({tagged(0, 0, "hard", 700), tagged(1, 0, "hard", 700)});
  for (const auto& material : json["materials"]) {
    EXPECT_TRUE(material.contains("extras"));
    EXPECT_EQ(material.size(), 1U) << material;
  }
}

TEST_F(GltfEditTest, CoarserMaterialsAreTaggedWithTheirs) {
  write(square(), two_meshes(R"(,"material":0)", R"(,"material":2)") +
                      R"("materials":[{"name":"fine","extensions":{"MSFT_lod":{"ids":[1,2]}}},{"name":"middle"},)"
                      R"({"name":"coarse"}],"extensionsUsed":["MSFT_lod"],)");
  const auto json = edit({tagged(0, 0, "hard", 700)});
  ASSERT_EQ(json["materials"].size(), 4U);  // "coarse" is shown by the other mesh, too
  EXPECT_TRUE(json["materials"][0]["extras"].contains("haptic"));
  EXPECT_TRUE(json["materials"][1]["extras"].contains("haptic"));
  EXPECT_FALSE(json["materials"][2].contains("extras"));
  EXPECT_EQ(json["materials"][3]["name"], "coarse hard");
  EXPECT_EQ(json["materials"][0]["extensions"]["MSFT_lod"]["ids"], ordered_json::parse("[1,3]"));
}

TEST_F(GltfEditTest, AnimationsOfAMaterialMoveItsCopy) {
  GlbFixture glb = square();
  glb.accessor(glb.view(std::vector<float>{0, 1}), 5126, 2, "SCALAR");
  const auto channel = [](const char* pointer) {
    return R"({"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")" +
           std::string(pointer) + R"("}}}})";
  };
  write(glb, two_meshes(R"(,"material":0)", R"(,"material":0)") +
                 R"("materials":[{"name":"m"},{"name":"n"}],"extensionsUsed":["KHR_animation_pointer"],)"
                 R"("animations":[{"samplers":[{"input":2,"output":2}],"channels":[)" +
                 channel("/materials/0/alphaCutoff") + "," + channel("/materials/01/alphaCutoff") + "," +
                 channel("/nodes/0/scale") + "]}],");
  EXPECT_TRUE(scene_.warnings.empty()) << scene_.warnings.front();
  const auto json = edit({tagged(0, 0, "hard", 700)});
  const auto& channels = json["animations"][0]["channels"];
  ASSERT_EQ(channels.size(), 4U);
  const ordered_json::json_pointer pointer("/target/extensions/KHR_animation_pointer/pointer");
  EXPECT_EQ(channels[0][pointer], "/materials/0/alphaCutoff");
  EXPECT_EQ(channels[3][pointer], "/materials/2/alphaCutoff");
  EXPECT_TRUE(changed("/animations/0/channels/3"));
}

/// A mesh that three nodes show, "a", "b" and "c".
std::string shared_mesh() {
  return R"("scene":0,"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0,"name":"a"},{"mesh":0,"name":"b"},)"
         R"({"mesh":0,"name":"c"}],"meshes":[{"name":"seat","primitives":[{"attributes":{"POSITION":0},"indices":1,)"
         R"("material":0}],"extras":{"id":7}}],"materials":[{"name":"m"}],)";
}

TEST_F(GltfEditTest, PartsOfOneMeshGetMeshesOfTheirOwn) {
  write(square(), shared_mesh());
  scene_.parts.push_back(Part(scene_.parts[0]));
  origin_.parts.push_back(GltfOrigin::Part(origin_.parts[0]));
  scene_.nodes[1].part = 1;
  const auto before = test::RawGltf(in()).json, json = edit({tagged(1, 0, "hard", 700)});
  ASSERT_EQ(json["meshes"].size(), 2U);
  EXPECT_EQ(json["meshes"][0], before["meshes"][0]);
  auto copy = json["meshes"][1];
  EXPECT_EQ(copy["primitives"][0]["material"], 1);
  copy["primitives"][0]["material"] = 0;
  EXPECT_EQ(copy, before["meshes"][0]) << "the same name, data and extras";
  for (const std::size_t node : {0U, 1U, 2U}) EXPECT_EQ(json["nodes"][node]["mesh"], node == 1 ? 1 : 0);
  std::set<std::string> pointers;
  for (const GltfChange& change : result_.changes) pointers.insert(change.kind + " " + change.pointer);
  EXPECT_EQ(pointers, (std::set<std::string>{"added /meshes/1", "added /materials/1", "changed /nodes/1/mesh",
                                             "added /nodes/1/extras", "added /asset/extras"}));
  EXPECT_EQ(json["accessors"], before["accessors"]);
}

/// Of vertices that a copy shares with its original only the copy's are written anew.
TEST_F(GltfEditTest, NewUvOfACopyLeaveItsOriginalAlone) {
  write(square(), shared_mesh());
  scene_.parts.push_back(Part(scene_.parts[0]));
  origin_.parts.push_back(GltfOrigin::Part(origin_.parts[0]));
  scene_.nodes[2].part = 1;
  GltfSurfaceEdit relief = tagged(1, 0, "grain", 700);
  relief.uv = torn_uv(2);
  const auto before = test::RawGltf(in()).json, json = edit({relief});
  EXPECT_EQ(json["meshes"][0], before["meshes"][0]);
  const Scene after = read_gltf(out());
  ASSERT_EQ(after.parts.size(), 2U);
  EXPECT_TRUE(after.parts[0].mesh.uv.values.empty());
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(after.parts[1].mesh.corner(t, static_cast<int>(k)),
                scene_.parts[0].mesh.corner(t, static_cast<int>(k)));
      const CornerAttribute<Vec2>&uv = after.parts[1].mesh.uv, &wanted = relief.uv;
      EXPECT_EQ(uv.values[uv.indices[t][k]], wanted.values[wanted.indices[t][k]]);
    }
}

TEST_F(GltfEditTest, AnimationsOfAMeshMoveItsCopy) {
  GlbFixture glb = square();
  glb.accessor(glb.view(std::vector<float>{0, 1}), 5126, 2, "SCALAR");
  const auto channel = [](const char* pointer) {
    return R"({"sampler":0,"target":{"path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":")" +
           std::string(pointer) + R"("}}}})";
  };
  write(glb, shared_mesh() +
                 R"("extensionsUsed":["KHR_animation_pointer"],)"
                 R"("animations":[{"samplers":[{"input":2,"output":2}],"channels":[)" +
                 channel("/meshes/0/weights/0") + "," + channel("/nodes/0/weights/0") + "]}],");
  scene_.parts.push_back(Part(scene_.parts[0]));
  origin_.parts.push_back(GltfOrigin::Part(origin_.parts[0]));
  scene_.nodes[1].part = 1;
  const auto json = edit({tagged(1, 0, "hard", 700)});
  const auto& channels = json["animations"][0]["channels"];
  ASSERT_EQ(channels.size(), 3U);
  const ordered_json::json_pointer pointer("/target/extensions/KHR_animation_pointer/pointer");
  EXPECT_EQ(channels[2][pointer], "/meshes/1/weights/0");
  EXPECT_TRUE(changed("/animations/0/channels/2"));
}

/// Its part has the rule of the finest level's, though its name is another one.
TEST_F(GltfEditTest, CoarserLevelsAreReadForAnEdit) {
  write(square(), R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"extensions":{"MSFT_lod":{"ids":[1]}}},)"
                  R"({"mesh":1}],"meshes":[{"name":"seat","primitives":[{"attributes":{"POSITION":0},"indices":1}]},)"
                  R"({"name":"seat_LOD1","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
                  R"("extensionsUsed":["MSFT_lod"],)");
  EXPECT_EQ(scene_.parts.size(), 1U);
  scene_ = read_gltf(in(), {.coarser_parts = true}, &origin_);
  ASSERT_EQ(scene_.parts.size(), 2U);
  EXPECT_EQ(scene_.parts[1].name, "seat");
  EXPECT_EQ(scene_.nodes.size(), 1U);
  ASSERT_EQ(origin_.levels.size(), 1U);
  EXPECT_EQ(origin_.levels[0].node, 1U);
  EXPECT_EQ(origin_.levels[0].part, 1U);
  EXPECT_EQ(origin_.levels[0].finest, 0U);
  const auto json = edit({tagged(0, 0, "hard", 700), tagged(1, 0, "hard", 700)});
  for (const auto& mesh : json["meshes"]) EXPECT_EQ(mesh["primitives"][0]["material"], 0);
}

/// A picture and a buffer in files, one of them in a folder below.
class GltfFilesTest : public GltfEditTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "a/maps");
    std::filesystem::create_directories(folder_ / "b");
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    folder_.write("a/shape.bin", {reinterpret_cast<const char*>(points.data()), 36});
    folder_.write("a/maps/my map.png", k_png);
    folder_.write("a/in.gltf",
                  R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[)"
                  R"({"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"name":"m"}],)"
                  R"("images":[{"uri":"maps/my%20map.png"}],"accessors":[{"bufferView":0,"componentType":5126,)"
                  R"("count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,)"
                  R"("byteLength":36}],"buffers":[{"uri":"shape.bin","byteLength":36}]})");
    scene_ = read_gltf(folder_ / "a/in.gltf", {}, &origin_);
    relief_ = tagged(0, 0, "grain", 700);
    relief_.uv = torn_uv(1);
    for (const char c : std::string(k_png)) map_.bytes.push_back(static_cast<std::byte>(c));
    relief_.normal_map = &map_;
  }

  GltfEditResult edit_to(const char* output) {
    auto result = write_edited_gltf(folder_ / "a/in.gltf", scene_, origin_, {relief_}, folder_ / output);
    const auto differences = test::unlisted_differences(folder_ / "a/in.gltf", folder_ / output, result.changes);
    EXPECT_TRUE(differences.empty()) << differences.front();
    return result;
  }

  static constexpr const char* k_png = "\x89PNG\r\n\x1a\n any";
  EncodedImage map_{"grain normal", "image/png", "", {}, ""};
  GltfSurfaceEdit relief_;
};

TEST_F(GltfFilesTest, AreCopiedAndNewDataGetFilesOfTheirOwn) {
  edit_to("b/out.gltf");
  EXPECT_EQ(test::content_of(folder_ / "b/shape.bin"), test::content_of(folder_ / "a/shape.bin"));
  EXPECT_EQ(test::content_of(folder_ / "b/maps/my map.png"), k_png);
  EXPECT_EQ(test::content_of(folder_ / "b/out-grain_normal.png"), k_png);
  const auto json = test::RawGltf(folder_ / "b/out.gltf").json;
  EXPECT_EQ(json["buffers"][0]["uri"], "shape.bin");
  EXPECT_EQ(json["buffers"][1]["uri"], "out.bin");
  EXPECT_EQ(json["images"][1]["uri"], "out-grain_normal.png");
  EXPECT_EQ(read_gltf(folder_ / "b/out.gltf").parts.at(0).mesh.uv.values.size(), 3U);
  EXPECT_EQ(named_files(folder_ / "b/out.gltf").size(), 4U);
}

TEST_F(GltfFilesTest, InTheSameFolderNothingIsCopied) {
  edit_to("a/out.gltf");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "a"), std::filesystem::directory_iterator()),
            6);
}

/// A new name also where the document names a file as the binary one would be called.
TEST_F(GltfFilesTest, NewNamesAreFree) {
  edit_to("b/shape.gltf");
  EXPECT_EQ(test::RawGltf(folder_ / "b/shape.gltf").json["buffers"][1]["uri"], "shape-2.bin");
}

TEST_F(GltfFilesTest, FilesOfAnotherSceneStay) {
  folder_.write("b/shape.bin", "another");
  const std::string message = test::message_of<IoError>([&] { edit_to("b/out.gltf"); });
  EXPECT_NE(message.find("shape.bin"), std::string::npos) << message;
  EXPECT_EQ(test::content_of(folder_ / "b/shape.bin"), "another");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b/out.gltf"));
}

TEST_F(GltfFilesTest, NothingIsWrittenWhenOneOfThemIsRefused) {
  folder_.write("b/out.bin", "another");  // Written last.
  EXPECT_THROW(edit_to("b/out.gltf"), IoError);
  EXPECT_EQ(std::distance(std::filesystem::recursive_directory_iterator(folder_ / "b"),
                          std::filesystem::recursive_directory_iterator()),
            1);
}

TEST_F(GltfFilesTest, ThoseOfTheFormerOutputAreReplaced) {
  edit_to("b/out.gltf");
  folder_.write("b/out.bin", "old");
  edit_to("b/out.gltf");
  EXPECT_NE(test::content_of(folder_ / "b/out.bin"), "old");
}

TEST_F(GltfFilesTest, AGlbBecomesGltfAndBack) {
  edit_to("b/one.glb");
  const Scene one = read_gltf(folder_ / "b/one.glb", {}, &origin_);
  const auto changes = write_edited_gltf(folder_ / "b/one.glb", one, origin_, {}, folder_ / "b/two.gltf").changes;
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].pointer, "/buffers/0/uri");
  EXPECT_TRUE(test::unlisted_differences(folder_ / "b/one.glb", folder_ / "b/two.gltf", changes).empty());
  const Scene two = read_gltf(folder_ / "b/two.gltf", {}, &origin_);
  write_edited_gltf(folder_ / "b/two.gltf", two, origin_, {}, folder_ / "b/three.glb");
  EXPECT_EQ(test::content_of(folder_ / "b/three.glb"), test::content_of(folder_ / "b/one.glb"));
}

TEST_F(GltfEditTest, ABufferWithoutDataIsReadAgain) {
  const auto file = folder_.write("in.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":1}]})");
  GltfOrigin origin;
  const Scene scene = read_gltf(file, {}, &origin);
  EXPECT_TRUE(write_edited_gltf(file, scene, origin, {}, out()).changes.empty());
  EXPECT_NO_THROW(read_gltf(out()));
}

TEST_F(GltfEditTest, NothingWantedGivesTheSameDocument) {
  write(square(), two_meshes("", "") + R"("extras":1.0,)");
  EXPECT_EQ(edit({}).dump(), test::RawGltf(in()).json.dump());
  EXPECT_TRUE(result_.changes.empty());
}

}  // namespace
}  // namespace papilla
