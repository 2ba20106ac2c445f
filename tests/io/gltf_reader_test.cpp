// SPDX-License-Identifier: MIT
#include "papilla/io/gltf_reader.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "io/glb_fixture.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::GlbFixture;
using test::mesh_of;
using test::message_of;
using test::row_of_points;
using test::TemporaryFolder;

/// The x of every triangle corner in metres.
std::vector<int> corner_numbers(const Scene& scene) {
  std::vector<int> numbers;
  const TriangleMesh& mesh = scene.parts.at(0).mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) numbers.push_back(static_cast<int>(mesh.corner(t, k).x / 1000));
  return numbers;
}

class GltfReader : public testing::Test {
 protected:
  Scene read(const std::string& glb) const { return read_gltf(folder_.write("a.glb", glb)); }
  std::string refusal(const std::string& glb) const {
    return message_of<InvalidInput>([&] { read(glb); });
  }

  std::string triangle_glb(const std::string& attributes = "", const std::string& members = "") const {
    GlbFixture binary;
    binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    return binary.glb(members + mesh_of(R"({"attributes":{"POSITION":0)" + attributes + "}}"));
  }

  const TemporaryFolder folder_;
};

TEST_F(GltfReader, MetresBecomeMillimetres) {
  const Scene scene = read(triangle_glb());
  EXPECT_EQ(scene.format, "glTF");
  EXPECT_EQ(scene.up, UpAxis::y);
  ASSERT_EQ(scene.parts.size(), 1U);
  EXPECT_EQ(scene.parts[0].mesh.corner(0, 1), (Vec3{1000, 0, 0}));
  EXPECT_EQ(instances(scene).size(), 1U);
}

TEST_F(GltfReader, StripsAndFansInTheOrderOfTheSpecification) {
  GlbFixture binary;
  binary.positions(row_of_points(5));
  EXPECT_EQ(corner_numbers(read(binary.glb(mesh_of(R"({"attributes":{"POSITION":0},"mode":5})")))),
            (std::vector<int>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(corner_numbers(read(binary.glb(mesh_of(R"({"attributes":{"POSITION":0},"mode":6})")))),
            (std::vector<int>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST_F(GltfReader, ReadsAllIndexWidths) {
  for (const int type : {5121, 5123, 5125}) {
    GlbFixture binary;
    binary.positions(row_of_points(4));
    const int view = type == 5121   ? binary.view(std::vector<std::uint8_t>{3, 1, 2})
                     : type == 5123 ? binary.view(std::vector<std::uint16_t>{3, 1, 2})
                                    : binary.view(std::vector<std::uint32_t>{3, 1, 2});
    binary.accessor(view, type, 3, "SCALAR");
    const Scene scene = read(binary.glb(mesh_of(R"({"attributes":{"POSITION":0},"indices":1})")));
    EXPECT_EQ(corner_numbers(scene), (std::vector<int>{3, 1, 2}));
    EXPECT_EQ(scene.parts[0].mesh.positions.size(), 3U) << "unused vertices are left out";
  }
}

TEST_F(GltfReader, SparseValuesReplaceTheBase) {
  GlbFixture binary;
  const int base = binary.view(row_of_points(3));
  const int at = binary.view(std::vector<std::uint16_t>{1});
  const int values = binary.view(std::vector<float>{7, 0, 0});
  binary.accessor(base, 5126, 3, "VEC3",
                  R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(at) +
                      R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}");
  const std::string members = mesh_of(R"({"attributes":{"POSITION":0}})");
  EXPECT_EQ(corner_numbers(read(binary.glb(members))), (std::vector<int>{0, 7, 2}));
}

TEST_F(GltfReader, SparseWithoutBaseStartsFromZero) {
  GlbFixture binary;
  const int at = binary.view(std::vector<std::uint8_t>{2});
  const int values = binary.view(std::vector<float>{7, 0, 0});
  const auto with_index = [&](const std::string& count) {
    GlbFixture copy = binary;
    copy.accessor(-1, 5126, 3, "VEC3",
                  R"(,"sparse":{"count":)" + count + R"(,"indices":{"bufferView":)" + std::to_string(at) +
                      R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(values) + "}}");
    return copy.glb(mesh_of(R"({"attributes":{"POSITION":0}})"));
  };
  EXPECT_EQ(corner_numbers(read(with_index("1"))), (std::vector<int>{0, 0, 7}));
  EXPECT_NE(refusal(with_index("2")), "");
  EXPECT_NE(refusal(with_index("-1")), "");
  EXPECT_NE(refusal(with_index("2000000000")), "");
}

TEST_F(GltfReader, NormalizedIntegersAndQuantizedPositions) {
  GlbFixture binary;
  binary.accessor(binary.view(std::vector<std::int16_t>{0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 0}), 5122, 3, "VEC3");
  // 16-bit positions are padded to 8 bytes; without byteStride they are tight: take a second view for uv.
  binary.accessor(binary.view(std::vector<std::uint8_t>{0, 255, 255, 0, 51, 0}), 5121, 3, "VEC2",
                  R"(,"normalized":true)");
  binary.accessor(binary.view(std::vector<std::int8_t>{-128, 0, 0, 127, 0, 0, -127, 0, 0}), 5120, 3, "VEC3",
                  R"(,"normalized":true)");
  const Scene scene =
      read(binary.glb(R"("extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"],)" +
                      mesh_of(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1,"NORMAL":2}})")));
  const TriangleMesh& mesh = scene.parts[0].mesh;
  EXPECT_EQ(mesh.corner(0, 1), (Vec3{0, 2000, 0}));
  EXPECT_EQ(mesh.corner(0, 2), (Vec3{0, 0, 0})) << "read tightly";
  const auto uv = [&](std::size_t k) { return mesh.uv.values[mesh.uv.indices[0][k]]; };
  EXPECT_EQ(uv(0), (Vec2{0, 0})) << "v runs up in a scene";
  EXPECT_EQ(uv(1), (Vec2{1, 1}));
  EXPECT_EQ(uv(2), (Vec2{0.2, 1}));
  EXPECT_EQ(mesh.normals.values[mesh.normals.indices[0][0]], (Vec3{-1, 0, 0}));
  EXPECT_EQ(mesh.normals.values[mesh.normals.indices[0][1]], (Vec3{1, 0, 0}));
}

TEST_F(GltfReader, NodeTransformsByMatrixAndTrs) {
  GlbFixture binary;
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string mesh = R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"scenes":[{"nodes":[0]}],)";
  // A quarter turn about z, scale 2, then (1, 2, 3) m: (1, 0, 0) m goes to (1, 4, 3) m.
  const Scene trs = read(binary.glb(
      mesh +
      R"("nodes":[{"mesh":0,"translation":[1,2,3],"rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[2,2,2]}],)"));
  const Scene matrix = read(binary.glb(mesh + R"("nodes":[{"mesh":0,"matrix":[0,2,0,0,-2,0,0,0,0,0,2,0,1,2,3,1]}],)"));
  for (const Scene* scene : {&trs, &matrix}) {
    const Vec3 moved = transform_point(instances(*scene)[0].world, {1000, 0, 0});
    EXPECT_NEAR(norm(moved - Vec3{1000, 4000, 3000}), 0, 1e-9);
  }
}

/// v + 2 q × (q × v + w v), by its definition.
Vec3 turned(const std::array<double, 4>& q, Vec3 v) {
  const Vec3 axis{q[0], q[1], q[2]};
  return v + 2 * cross(axis, cross(axis, v) + q[3] * v);
}

TEST_F(GltfReader, NodesTurnAboutAllAxesAndScaleUnevenly) {
  GlbFixture binary;
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const Scene scene =
      read(binary.glb(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"scenes":[{"nodes":[0]}],)"
                      R"("nodes":[{"mesh":0,"translation":[1,2,-3],"rotation":[0.1,-0.5,0.7,0.5],"scale":[2,3,5]}],)"));
  const std::array<double, 4> q{0.1, -0.5, 0.7, 0.5};  // Of length 1.
  for (const Vec3 p : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0.3, -0.7, 0.2}}) {
    const Vec3 expected = Vec3{1, 2, -3} + turned(q, {2 * p.x, 3 * p.y, 5 * p.z});
    EXPECT_NEAR(norm(transform_point(instances(scene)[0].world, 1000 * p) - 1000 * expected), 0, 1e-9);
  }
}

TEST_F(GltfReader, TheLeastNormalizedByteIsMinusOne) {
  GlbFixture binary;
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  binary.accessor(binary.view(std::vector<std::int8_t>{-128, -127, 127, 0, 64, -128}), 5120, 3, "VEC2",
                  R"(,"normalized":true)");
  const Scene scene =
      read(binary.glb(R"("extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"],)" +
                      mesh_of(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1}})")));
  const TriangleMesh& mesh = scene.parts[0].mesh;
  EXPECT_EQ(mesh.uv.values[mesh.uv.indices[0][0]], (Vec2{-1, 2}));
  EXPECT_EQ(mesh.uv.values[mesh.uv.indices[0][1]], (Vec2{1, 1}));
  EXPECT_EQ(mesh.uv.values[mesh.uv.indices[0][2]], (Vec2{64 / 127.0, 2}));
}

/// The scale of whole numbers goes into them: what hangs on the node stays where it is.
TEST_F(GltfReader, ChildrenOfWholePositionsStayWhereTheyAre) {
  GlbFixture binary;
  binary.accessor(binary.view(std::vector<std::int16_t>{0, 0, 0, 4, 0, 0, 0, 4, 0}), 5122, 3, "VEC3");
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const Scene scene = read(binary.glb(
      R"("extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]},{"primitives":[{"attributes":{"POSITION":1}}]}],)"
      R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[1,0,0],"scale":[0.5,0.5,0.5],"children":[1]},)"
      R"({"mesh":1,"translation":[2,4,6]}],)"));
  const auto shown = instances(scene);
  ASSERT_EQ(shown.size(), 2U);
  const Vec3 corner = transform_point(shown[1].world, {0, 0, 0}), far = transform_point(shown[1].world, {0, 0, 1000});
  EXPECT_NEAR(norm(corner - Vec3{2000, 2000, 3000}), 0, 1e-9);
  EXPECT_NEAR(norm(far - Vec3{2000, 2000, 3500}), 0, 1e-9);
}

TEST_F(GltfReader, TheSecondCoordinatesAndColoursOfVerticesAreTheirOwn) {
  GlbFixture binary;
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  binary.accessor(binary.view(std::vector<std::uint16_t>{0, 65535, 13107, 52428, 65535, 0}), 5123, 3, "VEC2",
                  R"(,"normalized":true)");
  binary.accessor(binary.view(std::vector<float>{.1F, .2F, .3F, .4F, .5F, .6F, .7F, .8F, .9F, .1F, .2F, .6F}), 5126, 3,
                  "VEC4");
  const Scene scene = read(binary.glb(mesh_of(R"({"attributes":{"POSITION":0,"TEXCOORD_1":1,"COLOR_0":2}})")));
  const TriangleMesh& mesh = scene.parts[0].mesh;
  EXPECT_TRUE(mesh.uv.empty());
  ASSERT_FALSE(mesh.uv1.empty() || mesh.colors.empty());
  const Vec2 second = mesh.uv1.values[mesh.uv1.indices[0][1]];
  EXPECT_NEAR(second.x, 0.2, 1e-6);
  EXPECT_NEAR(second.y, 1 - 0.8, 1e-6);
  const Color color = mesh.colors.values[mesh.colors.indices[0][1]];
  EXPECT_NEAR(color.b, 0.7, 1e-5);
  EXPECT_NEAR(color.a, 0.8, 1e-5);
}

TEST_F(GltfReader, RefusesBadNodeTrees) {
  GlbFixture binary;
  const auto tree = [&](const std::string& nodes) {
    return binary.glb(R"("scenes":[{"nodes":[0]}],"nodes":)" + nodes + ",");
  };
  binary.positions(row_of_points(3));
  EXPECT_NE(refusal(tree(R"([{"children":[1]},{"children":[0]}])")), "");
  EXPECT_NE(refusal(tree(R"([{"children":[1,2]},{"children":[2]},{}])")), "");
  EXPECT_NE(refusal(tree(R"([{"children":[5]}])")), "");
  EXPECT_NE(refusal(tree(R"([{"mesh":5}])")), "");
  EXPECT_NE(refusal(tree(R"([{"rotation":[0,0,0]}])")), "");
  EXPECT_NE(refusal(tree(R"([{"rotation":[0,0,0,0]}])")), "");
  EXPECT_NE(refusal(tree(R"([{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}])")), "");
  EXPECT_NE(refusal(tree(R"([{},{"children":[2]},{"children":[1]}])")), "") << "a cycle that no scene uses";
}

TEST_F(GltfReader, RefusesUnknownExtensionsThatMayTouchGeometry) {
  const std::string required = R"("extensionsRequired":["EX_shape","KHR_materials_unlit"],)";
  const std::string message = refusal(triangle_glb("", required));
  EXPECT_NE(message.find("a.glb: needs EX_shape, which is not supported"), std::string::npos) << message;
  EXPECT_EQ(message.find("unlit"), std::string::npos);
  for (const char* place :
       {R"("skins":[{"joints":[0],"extensions":{"EX_shape":{}}}],)",
        R"("materials":[{"extensions":{"EX_shape":{}}}],"skins":[{"joints":[0],"extensions":{"EX_shape":{}}}],)"})
    EXPECT_NE(refusal(triangle_glb("", required + place)), "") << place;
}

TEST_F(GltfReader, IgnoresUnknownExtensionsThatLeaveGeometryAlone) {
  for (const char* place :
       {R"("materials":[{"extensions":{"EX_shape":{}}}],)",
        R"("materials":[{"normalTexture":{"index":0,"extensions":{"EX_shape":{}}}}],"textures":[{}],)",
        R"("textures":[{"extensions":{"EX_shape":{"source":9}}}],)", R"("extensions":{"EX_shape":{}},)"}) {
    const Scene scene = read(triangle_glb("", std::string(R"("extensionsRequired":["EX_shape"],)") + place));
    EXPECT_EQ(scene.parts.size(), 1U) << place;
    ASSERT_FALSE(scene.warnings.empty()) << place;
    EXPECT_EQ(scene.warnings[0], "needs EX_shape, which is not read and leaves the geometry alone");
  }
}

TEST_F(GltfReader, PicturesOfAnyFormatStopNothing) {
  for (const char* name : {"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu", "MSFT_texture_dds"}) {
    const std::string extension = name;
    const Scene scene =
        read(triangle_glb("", R"("extensionsRequired":[")" + extension + R"("],"textures":[{"extensions":{")" +
                                  extension + R"(":{"source":0}}}],"images":[{"uri":"data:image/odd;base64,AAAA"}],)"));
    EXPECT_EQ(scene.textures.at(0).image, 0U) << name;
    EXPECT_EQ(scene.textures[0].others.at(0).extension, name);
    EXPECT_EQ(scene.textures[0].extensions_json, "") << name;
    EXPECT_EQ(scene.images.at(0).bytes.size(), 3U) << name;
    EXPECT_TRUE(scene.warnings.empty()) << name;
  }
  const Scene both = read(triangle_glb(
      "",
      R"("textures":[{"source":1,"extensions":{"KHR_texture_basisu":{"source":0},"EX_other":{}}}],"images":[{"uri":"data:image/ktx2;base64,q0tUWCAyMLsNChoK"},{"uri":"data:image/avif;base64,AAAAHGZ0eXBhdmlmAAAAAA=="}],)"));
  EXPECT_EQ(both.textures.at(0).image, 1U) << "what needs no extension comes first";
  EXPECT_EQ(both.textures[0].others.at(0).image, 0U);
  EXPECT_EQ(both.textures[0].extensions_json, R"({"EX_other":{}})");
  EXPECT_EQ(both.images.at(0).mime_type, "image/ktx2");
  EXPECT_EQ(both.images.at(1).mime_type, "image/avif");
  EXPECT_NE(refusal(triangle_glb("", R"("textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}],)"))
                .find("EXT_texture_webp: image 0 does not exist"),
            std::string::npos);
}

TEST_F(GltfReader, ChecksCountsBeforeTakingMemory) {
  for (const std::string count : {"4000000000", "9000000000000000000", "4"}) {
    GlbFixture binary;
    const int view = binary.view(row_of_points(3));
    binary.accessor(view, 5126, std::stoull(count), "VEC3");
    EXPECT_NE(refusal(binary.glb(mesh_of(R"({"attributes":{"POSITION":0}})"))), "") << count;
  }
  GlbFixture zeros;
  zeros.view(row_of_points(3));
  zeros.accessor(-1, 5126, 4000000000U, "VEC3");
  EXPECT_NE(refusal(zeros.glb(mesh_of(R"({"attributes":{"POSITION":0}})"))), "");
}

TEST_F(GltfReader, RefusesWrongReferences) {
  EXPECT_NE(refusal(triangle_glb(R"(,"NORMAL":7)")), "");
  GlbFixture index_too_large;
  index_too_large.positions(row_of_points(3));
  index_too_large.accessor(index_too_large.view(std::vector<std::uint16_t>{0, 1, 3}), 5123, 3, "SCALAR");
  EXPECT_NE(refusal(index_too_large.glb(mesh_of(R"({"attributes":{"POSITION":0},"indices":1})"))), "");
  GlbFixture not_finite;
  not_finite.positions({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0});
  EXPECT_NE(refusal(not_finite.glb(mesh_of(R"({"attributes":{"POSITION":0}})"))).find("element 2"), std::string::npos);
  GlbFixture fewer_normals;
  fewer_normals.positions(row_of_points(3));
  fewer_normals.positions(row_of_points(2));
  EXPECT_NE(refusal(fewer_normals.glb(mesh_of(R"({"attributes":{"POSITION":0,"NORMAL":1}})"))), "");
}

TEST_F(GltfReader, NamesThePlaceOfAMemberThatIsMissing) {
  const std::string view = R"({"buffer":0,"byteLength":4})",
                    accessor = R"({"componentType":5126,"count":1,"type":"VEC3"})";
  const std::pair<std::string, std::string> faults[] = {
      {R"("buffers":[{"byteLength":4},{"uri":"a"}])", "buffers[1].byteLength is missing"},
      {R"("bufferViews":[)" + view + R"(,{"buffer":"0","byteLength":4}])", "bufferViews[1].buffer is no whole number"},
      {R"("accessors":[)" + accessor + R"(,{"count":1,"type":"VEC3"}])", "accessors[1].componentType is missing"},
      {R"("accessors":[{"componentType":5126,"count":-1,"type":"VEC3"}])", "accessors[0].count is no whole number"},
      {R"("accessors":[{"componentType":5126,"count":1,"type":3}])", "accessors[0].type is no accessor type"},
      {R"("meshes":[{"primitives":[{"indices":0}]}])", "meshes[0].primitives[0].attributes is missing"},
      {R"("accessors":[{"componentType":1,"count":1,"type":"VEC3"}])",
       "accessors[0].componentType is no component type"},
      {R"("bufferViews":[{"buffer":0,"byteLength":4,"byteStride":3}])",
       "bufferViews[0].byteStride is no multiple of 4"},
      {R"("nodes":[{"mesh":3e9}])", "nodes[0].mesh is no whole number"},
      {R"("nodes":[{"children":[0.5]}])", "nodes[0].children[0] is no whole number"},
      {R"("materials":[{"normalTexture":{"index":1e300}}])", "materials[0].normalTexture.index is no whole number"},
      {R"("skins":[{"joints":[0]},{}])", "skins[1].joints is missing"},
      {R"("cameras":[{"type":"fisheye"}])", "cameras[0].type is no camera type"},
      {R"("cameras":[{"type":"perspective"}])", "cameras[0].perspective is missing"},
      {R"("cameras":[{"type":"orthographic","orthographic":1}])", "cameras[0].orthographic is no object"},
      {R"("nodes":[{},7])", "nodes[1] is no object"},
  };
  for (const auto& [json, place] : faults)
    EXPECT_NE(refusal(R"({"asset":{"version":"2.0"},)" + json + "}").find(place), std::string::npos)
        << json << ": " << refusal(R"({"asset":{"version":"2.0"},)" + json + "}");
}

TEST_F(GltfReader, RefusesDeepJson) {
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_NE(refusal(triangle_glb("", R"("extras":)" + deep + ",")).find("nested"), std::string::npos);
}

TEST_F(GltfReader, EveryPrefixThrowsOrSucceeds) {
  const std::string whole = triangle_glb();
  read(whole);
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "") << length;
}

TEST_F(GltfReader, DamagedBytesNeverCrash) {
  const std::string whole = triangle_glb();
  const std::string values(
      "\0\xff"
      "9-{\"",
      6);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = values[i % values.size()];
    try {
      const Scene scene = read(damaged);
      for (const Part& part : scene.parts)
        for (const Vec3& position : part.mesh.positions) ASSERT_TRUE(is_finite(position));
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST_F(GltfReader, MixedPrimitivesFillMissingAttributes) {
  GlbFixture binary;
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  binary.accessor(binary.view(std::vector<float>{0, 0, 1, 0, 0, 1}), 5126, 3, "VEC2");
  binary.positions({1, 0, 0, 1, 0, 0, 1, 0, 0});
  const Scene scene = read(binary.glb(
      R"("materials":[{"name":"m"}],)" +
      mesh_of(
          R"({"attributes":{"POSITION":0,"TEXCOORD_0":1,"NORMAL":2},"material":0},{"attributes":{"POSITION":0}})")));
  const Part& part = scene.parts[0];
  EXPECT_EQ(part.mesh.positions.size(), 3U) << "equal positions are merged";
  EXPECT_EQ(part.mesh.triangles.size(), 2U);
  EXPECT_EQ(part.mesh.uv.indices.size(), 2U);
  EXPECT_EQ(part.mesh.normals.values[part.mesh.normals.indices[0][0]], (Vec3{1, 0, 0}));
  EXPECT_EQ(part.mesh.normals.values[part.mesh.normals.indices[1][0]], (Vec3{0, 0, 1})) << "flat shading";
  EXPECT_EQ(part.mesh.material, (Values<std::uint32_t>{0, 1}));
  EXPECT_EQ(scene.materials.at(part.materials.at(1)).name, "default");
}

TEST_F(GltfReader, MaterialsKeepEverything) {
  const std::string members =
      R"("materials":[{"name":"m","extras":{"haptic":{"empty":[],"none":null,"big":4294967296}},
      "pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"baseColorTexture":{"index":0,"texCoord":1,
      "extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,3],"rotation":0.25}}}},
      "normalTexture":{"index":0,"scale":0.5},"emissiveTexture":{"index":0,
      "extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"texCoord":1}}},"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}}}],
      "textures":[{"source":0,"sampler":0,"extras":{"t":1}}],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}],
      "images":[{"uri":"data:image/png;base64,iVBORw0KGgo=","name":"i","extras":{"i":2}}],)";
  const Scene scene = read(triangle_glb("", members));
  ASSERT_EQ(scene.materials.size(), 2U) << "the primitive without material wears the default one";
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.extras_json, R"({"haptic":{"big":4294967296,"empty":[],"none":null}})");
  EXPECT_EQ(material.extensions_json, R"({"KHR_materials_clearcoat":{"clearcoatFactor":1}})");
  EXPECT_EQ(material.base_color, (std::array<double, 4>{0.1, 0.2, 0.3, 0.4}));
  ASSERT_TRUE(material.base_color_texture && material.base_color_texture->transform);
  EXPECT_EQ(material.base_color_texture->tex_coord, 1);
  EXPECT_EQ(material.base_color_texture->transform->scale, (Vec2{2, 3}));
  EXPECT_EQ(material.base_color_texture->transform->rotation, 0.25);
  EXPECT_EQ(material.normal_texture->factor, 0.5);
  EXPECT_EQ(scene.textures.at(0).wrap_s, 33071);
  EXPECT_EQ(scene.textures[0].wrap_t, 33648);
  EXPECT_EQ(scene.textures[0].mag_filter, 9728);
  ASSERT_TRUE(material.emissive_texture && material.emissive_texture->transform);
  EXPECT_EQ(material.emissive_texture->tex_coord, 1) << "that of the transform";
  EXPECT_EQ(material.emissive_texture->transform->offset, (Vec2{0.5, 0.25}));
  EXPECT_EQ(material.emissive_texture->transform->scale, (Vec2{1, 1}));
  EXPECT_EQ(scene.textures[0].extras_json, R"({"t":1})");
  EXPECT_EQ(scene.images.at(0).bytes.size(), 8U) << "kept as it is, though it is no whole picture";
  EXPECT_EQ(scene.images[0].mime_type, "image/png");
  EXPECT_EQ(scene.images[0].extras_json, R"({"i":2})");
}

/// A scene has two coordinates: those of the tag become the second ones, and change places with these.
TEST_F(GltfReader, CoordinatesOfATagChangePlacesWithTheSecondOnes) {
  GlbFixture binary;
  binary.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  binary.accessor(binary.view(std::vector<float>{.1F, .1F, .1F, .1F, .1F, .1F}), 5126, 3, "VEC2");
  binary.accessor(binary.view(std::vector<float>{.2F, .2F, .2F, .2F, .2F, .2F}), 5126, 3, "VEC2");
  binary.accessor(binary.view(std::vector<float>{.3F, .3F, .3F, .3F, .3F, .3F}), 5126, 3, "VEC2");
  GltfReadOptions options;
  options.tag_channel = true;
  const Scene scene = read_gltf(
      folder_.write(
          "a.glb",
          binary.glb(
              R"("materials":[{"extras":{"haptic":{"version":1,"stiffness":900,"height":{"image":0,"scale":2e-4,"texCoord":2}}},)"
              R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}},"normalTexture":{"index":0,"texCoord":2},)"
              R"("occlusionTexture":{"index":0}}],"textures":[{"source":0}],)"
              R"("images":[{"uri":"data:image/png;base64,iVBORw0KGgo="}],)" +
              mesh_of(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1,"TEXCOORD_1":2,"TEXCOORD_2":3},"material":0})"))),
      options);
  const Material& material = scene.materials.at(0);
  ASSERT_TRUE(material.haptic && material.haptic->height);
  EXPECT_EQ(material.haptic->height->tex_coord, 1);
  EXPECT_EQ(material.base_color_texture->tex_coord, 2);
  EXPECT_EQ(material.normal_texture->tex_coord, 1);
  EXPECT_EQ(material.occlusion_texture->tex_coord, 0);
  EXPECT_NEAR(scene.parts[0].mesh.uv1.values.at(0).x, 0.3, 1e-6);
}

TEST_F(GltfReader, ExternalFilesWithSpacesAndUmlauts) {
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  folder_.write("b in ä.bin", {reinterpret_cast<const char*>(points.data()), 36});
  const std::string text =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"b%20in%20ä.bin"}],
      "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,
      "type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
      "images":[{"uri":"missing.png"}]})";
  const Scene scene = read_gltf(folder_.write("Ü 1.gltf", text));
  EXPECT_EQ(scene.parts.at(0).mesh.triangles.size(), 1U);
  EXPECT_EQ(scene.roots.size(), 1U) << "without a scene the nodes without parent are the roots";
  EXPECT_FALSE(scene.warnings.empty());
  EXPECT_EQ(scene.images.at(0).uri, "missing.png");
}

/// A triangle in a file of its own, and a picture beside it.
std::string gltf_with_files(const std::string& buffer, const std::string& image) {
  return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":")" + buffer + R"("}],
      "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,
      "type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
      "images":[{"uri":"data:image/png;base64,iVBORw0KGgo="},{"uri":")" +
         image + "\"}]}";
}

TEST_F(GltfReader, NamesFilesInItsFolderOnly) {
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string bytes(reinterpret_cast<const char*>(points.data()), 36), png = "\x89PNG\r\n\x1a\n";
  const std::filesystem::path inside = folder_ / "inside";
  std::filesystem::create_directory(inside);
  folder_.write("secret.bin", bytes);
  folder_.write("secret.png", png);
  folder_.write("inside/b+1.bin", bytes + "padding");
  folder_.write("inside/a.png", png);
  std::filesystem::create_symlink("../secret.png", inside / "link.png");
  std::filesystem::create_symlink("../secret.bin", inside / "link.bin");
  const auto read_files = [&](const std::string& buffer, const std::string& image) {
    return read_gltf(folder_.write("inside/a.gltf", gltf_with_files(buffer, image)));
  };
  const Scene scene = read_files("b+1.bin", "a.png");
  EXPECT_EQ(scene.parts.at(0).mesh.corner(0, 1), (Vec3{1000, 0, 0}));
  EXPECT_EQ(scene.images.at(1).bytes.size(), png.size());
  EXPECT_EQ(scene.images[1].uri, "a.png");
  for (const std::string& uri : {std::string("../secret"), std::string("%2e%2e/secret"), std::string("..%2Fsecret"),
                                 (folder_ / "secret").string(), std::string("link")}) {
    const std::string image = message_of<InvalidInput>([&] { read_files("b+1.bin", uri + ".png"); });
    EXPECT_NE(image.find("inside/a.gltf: at /images/1/uri: '"), std::string::npos) << uri << ": " << image;
    EXPECT_NE(image.find("leads out of the folder"), std::string::npos) << uri << ": " << image;
    const std::string buffer = message_of<InvalidInput>([&] { read_files(uri + ".bin", "a.png"); });
    EXPECT_NE(buffer.find("inside/a.gltf: at /buffers/0/uri: '"), std::string::npos) << uri << ": " << buffer;
    EXPECT_NE(buffer.find("leads out of the folder"), std::string::npos) << uri << ": " << buffer;
  }
}

TEST_F(GltfReader, FilesThatItNamesHoldWhatTheyShould) {
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  folder_.write("b.bin", {reinterpret_cast<const char*>(points.data()), 36});
  folder_.write("short.bin", "short");
  folder_.write("passwd", "root:x:0:0");
  const auto refused = [&](const std::string& buffer, const std::string& image) {
    return message_of<InvalidInput>([&] { read_gltf(folder_.write("a.gltf", gltf_with_files(buffer, image))); });
  };
  EXPECT_NE(refused("b.bin", "passwd").find("a.gltf: at /images/1/uri: 'passwd' is no picture"), std::string::npos);
  EXPECT_NE(refused("short.bin", "a.png").find("at /buffers/0/uri: 'short.bin' has 5 bytes, byteLength is 36"),
            std::string::npos);
  EXPECT_NE(refused("none.bin", "a.png").find("at /buffers/0/uri: 'none.bin' does not exist"), std::string::npos);
  EXPECT_NE(refused(".", "a.png").find("at /buffers/0/uri: '.'"), std::string::npos);
}

TEST_F(GltfReader, ListsWhatIsLost) {
  const Scene scene = read(triangle_glb(R"(},"mode":1},{"attributes":{"POSITION":0)",
                                        R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}],)"));
  EXPECT_EQ(scene.parts[0].mesh.triangles.size(), 1U);
  EXPECT_EQ(scene.losses.size(), 2U);
}

TEST_F(GltfReader, MissingAndWrongFiles) {
  EXPECT_THROW(read_gltf(folder_ / "none.glb"), IoError);
  EXPECT_THROW(read_gltf(folder_ / ""), IoError);
  EXPECT_THROW(read_gltf(folder_.write("empty.glb", "")), InvalidInput);
  EXPECT_THROW(read_gltf(folder_.write("text.gltf", "hello")), InvalidInput);
}

}  // namespace
}  // namespace papilla
