// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "io/temporary_folder.hpp"
#include "page/page_file.hpp"
#include "page/page_mesh.hpp"
#include "page/page_scene.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/io/glb_writer.hpp"

namespace papilla::app {
namespace {

/// n x n squares of 1 mm in the plane, uv of 1 per mm stretched by `stretch` along u.
TriangleMesh grid(Index n, double stretch) {
  TriangleMesh mesh;
  for (Index y = 0; y <= n; ++y)
    for (Index x = 0; x <= n; ++x) {
      mesh.positions.push_back({double(x), double(y), 0});
      mesh.uv.values.push_back({stretch * x, double(y)});
    }
  for (Index y = 0; y < n; ++y)
    for (Index x = 0; x < n; ++x) {
      const Index a = y * (n + 1) + x, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  mesh.uv.indices = mesh.triangles;
  return mesh;
}

TEST(Base64, KnownAnswers) {
  const auto of = [](std::string_view text) {
    return encode_base64(std::as_bytes(std::span(text.data(), text.size())));
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(PageMesh, KeepsEverythingWhenAsked) {
  const TriangleMesh mesh = grid(20, 2);
  const auto meshes = page_meshes(mesh, mesh.uv, {}, measure_distortion(mesh, mesh.uv), 1);
  ASSERT_EQ(meshes.size(), 1U);
  EXPECT_EQ(meshes[0].shown, 800U);
  EXPECT_GT(meshes[0].coarse, 0U);
  EXPECT_LT(meshes[0].coarse, 200U);
  EXPECT_EQ(meshes[0].vertices, 441U);
  EXPECT_EQ(meshes[0].error_mm, 0);
  EXPECT_EQ(meshes[0].high, (Vec3{20, 20, 0}));
  EXPECT_EQ(meshes[0].uv_low, (Vec2{0, -19}));  // v runs down
  EXPECT_EQ(meshes[0].uv_high, (Vec2{40, 1}));
}

TEST(PageMesh, SimplifiesAPlaneWithoutMovingIt) {
  const TriangleMesh mesh = grid(60, 1);
  const auto meshes = page_meshes(mesh, mesh.uv, {}, {}, 0.1);
  EXPECT_LE(meshes[0].shown, 1080U);
  EXPECT_LT(meshes[0].error_mm, 1e-3);
  EXPECT_EQ(meshes[0].high, (Vec3{60, 60, 0}));
}

TEST(PageMesh, SplitsByMaterial) {
  TriangleMesh mesh = grid(4, 1);
  mesh.material.assign(mesh.triangles.size(), 1);
  mesh.material[0] = 0;
  const auto meshes = page_meshes(mesh, mesh.uv, {}, {}, 1);
  ASSERT_EQ(meshes.size(), 2U);
  EXPECT_EQ(meshes[0].shown, 1U);
  EXPECT_EQ(meshes[1].shown, 31U);
}

TEST(PageMesh, KeepsTheSecondChannelWhereItIsNeeded) {
  TriangleMesh mesh = grid(4, 1);
  mesh.uv1 = mesh.uv;
  for (Vec2& value : mesh.uv1.values) value = {0.5 * value.x, 1 - 0.25 * value.y};
  EXPECT_TRUE(page_meshes(mesh, mesh.uv, {false}, {}, 1)[0].uv1_stream.empty());
  const auto meshes = page_meshes(mesh, mesh.uv, {true}, {}, 1);
  EXPECT_FALSE(meshes[0].uv1_stream.empty());
  EXPECT_EQ(meshes[0].uv1_low, (Vec2{0, 0}));
  EXPECT_EQ(meshes[0].uv1_high, (Vec2{2, 1}));
}

/// Of one part with one material.
Scene plate_on_both_channels() {
  Part part;
  part.mesh = grid(2, 1);
  part.mesh.uv1 = part.mesh.uv;
  part.materials = {0};
  return single_part_scene(std::move(part), "test");
}

TEST(PageScene, TellsWhatLiesOnTheSecondChannelAndWhatBrowsersDoNotShow) {
  Scene scene = plate_on_both_channels();
  Material material;
  material.base_color_texture = TextureReference{0, 1, 1, {}};
  material.normal_texture = TextureReference{1, 0, 1, {}};
  material.extensions_json = R"({"KHR_materials_unlit":{}})";
  scene.materials = {material};
  for (const char* type : {"image/webp", "image/ktx2"}) {
    Texture texture;
    texture.image = static_cast<std::uint32_t>(scene.images.size());
    scene.textures.push_back(texture);
    EncodedImage image;
    image.mime_type = type;
    image.bytes.resize(4);
    scene.images.push_back(image);
  }
  const Json json = page_scene(scene, "a.glb", {}, {}).json;
  const Json& shown = json["materials"][0];
  EXPECT_EQ(shown["base_map"]["tex_coord"], 1);
  EXPECT_TRUE(shown["normal_map"].is_null());
  EXPECT_TRUE(json["images"][1].is_null());
  EXPECT_EQ(shown["unlit"], true);
  ASSERT_EQ(shown["warnings"].size(), 1U);
  EXPECT_EQ(shown["warnings"][0].get<std::string>().substr(0, 17), "picture_not_shown");
  EXPECT_NE(json["parts"][0]["meshes"][0]["uv1_stream"], "");
}

/// Two triangles of unequal area in a box of three unequal sides, whose vertices come back from the streams.
TEST(PageMesh, VerticesComeBackFromTheStreams) {
  TriangleMesh mesh;
  mesh.positions = {{1, 2, 3}, {5, 3, 4}, {2, 8, 13}, {4, 9, 5}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
  mesh.uv.values = {{0.1, 0.2}, {0.7, 0.3}, {0.2, 3.9}, {0.6, 1}};
  mesh.uv1.values = {{0.5, 2}, {0.1, 5}, {0.9, 3}, {0.3, 4}};
  mesh.normals.values = {normalized(Vec3{1, 2, 3}), normalized(Vec3{-1, 2, 5}), normalized(Vec3{4, -2, 1}), {0, 0, -1}};
  mesh.uv.indices = mesh.uv1.indices = mesh.normals.indices = mesh.triangles;
  const DistortionReport report = measure_distortion(mesh, mesh.uv);
  const PageMesh page = page_meshes(mesh, mesh.uv, {true}, report, 1)[0];
  EXPECT_EQ(page.low, (Vec3{1, 2, 3}));
  EXPECT_EQ(page.high, (Vec3{5, 9, 13}));
  struct Vertex {
    std::array<std::uint16_t, 4> position;
    std::array<std::uint16_t, 2> uv;
    std::array<std::int8_t, 4> normal;
    std::array<std::uint16_t, 4> measured;
  };
  ASSERT_EQ(page.vertices, 4U);
  std::array<Vertex, 4> vertices{};
  std::array<std::array<std::uint16_t, 2>, 4> second{};
  const auto decode = [](auto& to, const std::vector<std::byte>& stream) {
    return meshopt_decodeVertexBuffer(to.data(), to.size(), sizeof(to[0]),
                                      reinterpret_cast<const unsigned char*>(stream.data()), stream.size());
  };
  ASSERT_EQ(decode(vertices, page.vertex_stream), 0);
  ASSERT_EQ(decode(second, page.uv1_stream), 0);
  const auto between = [](double low, double high, std::uint16_t code) { return low + (high - low) * code / 65535; };
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 p{between(1, 5, vertices[i].position[0]), between(2, 9, vertices[i].position[1]),
                 between(3, 13, vertices[i].position[2])};
    std::size_t k = 0;
    while (k < 4 && norm(mesh.positions[k] - p) > 1e-3) ++k;
    ASSERT_LT(k, 4U) << p.x << ' ' << p.y << ' ' << p.z;
    seen.insert(k);
    EXPECT_NEAR(between(page.uv_low.x, page.uv_high.x, vertices[i].uv[0]), mesh.uv.values[k].x, 1e-3);
    EXPECT_NEAR(between(page.uv_low.y, page.uv_high.y, vertices[i].uv[1]), 1 - mesh.uv.values[k].y, 1e-3);
    EXPECT_NEAR(between(page.uv1_low.x, page.uv1_high.x, second[i][0]), mesh.uv1.values[k].x, 1e-3);
    EXPECT_NEAR(between(page.uv1_low.y, page.uv1_high.y, second[i][1]), 1 - mesh.uv1.values[k].y, 1e-3);
    const Vec3 normal{vertices[i].normal[0] / 127.0, vertices[i].normal[1] / 127.0, vertices[i].normal[2] / 127.0};
    EXPECT_LT(norm(normal - mesh.normals.values[k]), 0.01);
    double angle = 0, area = 0;
    for (const std::size_t t : {0U, 1U}) {
      const auto& corners = mesh.triangles[t];
      if (std::find(corners.begin(), corners.end(), k) == corners.end()) continue;
      angle += report.per_triangle[t].area_mm2 * report.per_triangle[t].angle_error_deg;
      area += report.per_triangle[t].area_mm2;
    }
    EXPECT_NEAR(180 * vertices[i].measured[1] / 65534.0, angle / area, 0.01);
  }
  EXPECT_EQ(seen.size(), 4U);
}

TEST(PageScene, KnowsWhichWayIsUpAndWhatLiesOnTheSecondCoordinates) {
  Scene scene = plate_on_both_channels();
  Material material;
  material.normal_texture = TextureReference{0, 1, 1, {}};
  scene.materials = {material};
  Texture texture;
  texture.image = 0;
  texture.wrap_s = 33071;
  texture.wrap_t = 33648;
  scene.textures = {texture};
  EncodedImage image;
  image.mime_type = "image/png";
  image.bytes.resize(4);
  scene.images = {image};
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
    scene.up = up;
    const Json json = page_scene(scene, "a.glb", {}, {}).json;
    EXPECT_EQ(json["z_up"], up == UpAxis::z);
    EXPECT_NE(json["parts"][0]["meshes"][0]["uv1_stream"], "");
    EXPECT_EQ(json["materials"][0]["normal_map"]["wrap"], Json({33071, 33648}));
  }
  scene.parts[0].mesh.uv = {};
  EXPECT_EQ(page_scene(scene, "a.glb", {}, {}).json["parts"][0]["meshes"][0]["uv"], true);
}

TEST(PageScene, LevelsOfDetailStandWhereTheFinestDoes) {
  const auto plate = [](Index n) {  // Of 10 mm.
    TriangleMesh mesh = grid(n, 1);
    for (Vec3& p : mesh.positions) p = 10.0 / n * p;
    return mesh;
  };
  Part part;
  part.name = "plate";
  part.mesh = plate(10);
  part.levels = {{plate(4), 0.3}, {plate(1), 0.1}};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.nodes.push_back(scene.nodes[0]);
  scene.nodes[0].name = "under";
  scene.nodes[1].name = "upper";
  scene.nodes[1].local[3] = 40;
  scene.nodes[0].children = {1};  // One that shows levels and has a child.
  const test::TemporaryFolder folder;
  for (const MeshCoding coding : {MeshCoding::none, MeshCoding::quantize}) {
    GlbWriteOptions write;
    write.meshes = coding;
    write_glb(scene, folder / "a.glb", write);
    PageSceneOptions options;
    const Scene read = read_for_page(folder / "a.glb", {}, options.levels);
    const Json json = page_scene(read, folder / "a.glb", options, {}).json;
    EXPECT_EQ(json["triangles"], 400);
    EXPECT_EQ(json["finest_instances"], 2);
    EXPECT_EQ(json["levels"], Json::parse("[[0.3, 0.1, 0], [0.3, 0.1, 0]]"));
    ASSERT_EQ(json["instances"].size(), 6U);
    std::map<std::pair<int, int>, std::pair<double, int>> found;  // Farthest x and triangles by place and level.
    for (const Instance& use : instances(read)) {
      const auto same = [&](const Json& shown) { return shown["name"] == read.nodes[use.node].name; };
      const auto shown = std::find_if(json["instances"].begin(), json["instances"].end(), same);
      ASSERT_NE(shown, json["instances"].end());
      const Json& level = (*shown)["level"];
      double x = -1e9;
      for (const Vec3& p : read.parts[use.part].mesh.positions) x = std::max(x, transform_point(use.world, p).x);
      found[{level["place"], level["number"]}] = {x, static_cast<int>(read.parts[use.part].mesh.triangles.size())};
    }
    ASSERT_EQ(found.size(), 6U);
    for (const auto& [key, value] : found) {
      EXPECT_NEAR(value.first, (found.at({key.first, 0}).first), 1e-2);
      EXPECT_EQ(value.second, (std::array{200, 32, 2})[static_cast<std::size_t>(key.second)]);
    }
    EXPECT_NEAR(std::abs(found.at({0, 0}).first - found.at({1, 0}).first), 40, 1e-2);
  }
}

TEST(PageScene, CountsInstances) {
  Part part;
  part.name = "plate";
  part.mesh = grid(10, 1);
  Scene scene = single_part_scene(std::move(part), "test");
  scene.nodes.push_back(scene.nodes[0]);
  scene.roots.push_back(1);
  const Json json = page_scene(scene, "plate.glb", {}, {}).json;
  EXPECT_EQ(json["triangles"], 400);
  EXPECT_EQ(json["triangles_shown"], 400);
  EXPECT_EQ(json["instances"].size(), 2U);
  EXPECT_NEAR(json["parts"][0]["distortion"]["stretch_l2"].get<double>(), 1, 1e-9);
}

TEST(PageFile, MarkupInNamesStaysText) {
  const std::string evil = "</script><img src=x onerror=alert(1)>";
  const PageContent content{evil, {{"parts", {{{"name", evil}, {"bytes", "AAAA"}}}}}, nullptr};
  const std::string plain = plain_page(content);
  EXPECT_EQ(plain.find("<img"), std::string::npos);
  EXPECT_NE(plain.find("&lt;img"), std::string::npos);
  EXPECT_EQ(plain.find("AAAA"), std::string::npos);

  const auto file = std::filesystem::path(testing::TempDir()) / "papilla_page_test.html";
  const std::size_t bytes = write_page(content, file);
  EXPECT_EQ(bytes, std::filesystem::file_size(file));
  EXPECT_EQ(read_file(file).find("<img src=x"), std::string::npos);
  std::filesystem::remove(file);
  EXPECT_THROW(write_page(content, "/nowhere/page.html"), IoError);
}

TEST(PageFile, OnlyAPageThatFollowsMayAskItsServer) {
  PageContent content{"plate", {{"parts", Json::array()}}, nullptr};
  EXPECT_EQ(page_html(content).find("connect-src"), std::string::npos);
  EXPECT_EQ(page_html(content).find(k_connect_marker), std::string::npos);
  content.live = true;
  EXPECT_EQ(page_html(content).find("; connect-src 'self'\">") != std::string::npos, !page_template().empty());
}

}  // namespace
}  // namespace papilla::app
