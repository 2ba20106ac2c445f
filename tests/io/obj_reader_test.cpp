// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <vector>

#include "io/png_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::message_of;
using test::TemporaryFolder;

const std::string k_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ObjReader : public testing::Test {
 protected:
  Scene read(const std::string& text, const ReadOptions& options = {}) const {
    return read_obj(folder_.write("a.obj", text), options);
  }
  std::string refusal(const std::string& text) const {
    return message_of<InvalidInput>([&] { read(text); });
  }
  void write_png(const std::string& name) const {
    folder_.write(name, {reinterpret_cast<const char*>(test::k_grey8_png), sizeof test::k_grey8_png});
  }
  const TemporaryFolder folder_;
};

TEST_F(ObjReader, PolygonsAndNegativeIndices) {
  const Scene scene = read(k_square + "f 1 2 3 4\nf -4 -3 -2\n");
  const TriangleMesh& mesh = scene.parts.at(0).mesh;
  EXPECT_EQ(mesh.triangles, (Values<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(mesh.positions[2], (Vec3{1, 1, 0}));
  EXPECT_EQ(scene.up, UpAxis::y);
}

TEST_F(ObjReader, AttributesAreIndexedByThemselves) {
  const Scene scene =
      read(k_square + "vt 0.25 0.5\nvt 1\nvt 0 0 0\nvn 0 0 2\nf 1/1/1 2/2/1 3/3/1\nf 1//1 3//1 4//1\nf 1/3 2/2 3/1\n");
  const TriangleMesh& mesh = scene.parts.at(0).mesh;
  const Triangle none = {k_no_value, k_no_value, k_no_value};
  EXPECT_EQ(mesh.uv.values, (Values<Vec2>{{0.25, 0.5}, {1, 0}, {0, 0}}));
  EXPECT_EQ(mesh.uv.indices, (Values<Triangle>{{0, 1, 2}, none, {2, 1, 0}}));
  EXPECT_EQ(mesh.normals.values, (Values<Vec3>{{0, 0, 1}}));
  EXPECT_EQ(mesh.normals.indices, (Values<Triangle>{{0, 0, 0}, {0, 0, 0}, none}));
}

TEST_F(ObjReader, CornersThatLackWhatTheirFaceHasAreNeutral) {
  const TriangleMesh mesh = read(k_square + "vt 1 1\nf 1/1 2 3/1\n").parts.at(0).mesh;
  EXPECT_EQ(mesh.uv.values, (Values<Vec2>{{1, 1}, {0, 0}}));
  EXPECT_EQ(mesh.uv.indices, (Values<Triangle>{{0, 1, 0}}));
}

TEST_F(ObjReader, ObjectsBecomePartsAndGroupsFaceNumbers) {
  const Scene scene =
      read(k_square + "o first one\ng a\nf 1 2 3\ng b\nf 1 3 4\no ünïcode\nf 2 3 4\no first one\nf 1 2 4\n");
  ASSERT_EQ(scene.parts.size(), 2U);
  EXPECT_EQ(scene.parts[0].name, "first one");
  EXPECT_EQ(scene.parts[1].name, "ünïcode");
  ASSERT_EQ(scene.parts[0].mesh.face.size(), 3U);
  EXPECT_NE(scene.parts[0].mesh.face[0], scene.parts[0].mesh.face[1]);
  EXPECT_EQ(scene.parts[1].mesh.positions, (Values<Vec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(instances(scene).size(), 2U);
}

TEST_F(ObjReader, GroupsBecomePartsWithoutObjects) {
  const Scene scene = read(k_square + "f 1 2 3\ng x\nf 1 3 4\n");
  ASSERT_EQ(scene.parts.size(), 2U);
  EXPECT_EQ(scene.parts[0].name, "a");
  EXPECT_EQ(scene.parts[1].name, "x");
}

TEST_F(ObjReader, ContinuedLinesCommentsAndForwardIndices) {
  const Scene scene = read("f 1 2 \\\n 3 # comment\nv 0 0 0 # origin\r\nv +1 0 0\nv 0 1.5e0 0 1\n");
  EXPECT_EQ(scene.parts.at(0).mesh.corner(0, 2), (Vec3{0, 1.5, 0}));
}

TEST_F(ObjReader, ErrorsNameTheLine) {
  EXPECT_NE(refusal("v 0 0 0\nv 1 abc 0\n").find("line 2: 'abc'"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nv 1 0,5 0\n").find("line 2"), std::string::npos);
  EXPECT_NE(refusal("v 0 0\n").find("line 1"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 nan\n").find("line 1"), std::string::npos);
  EXPECT_NE(refusal(k_square + "f 1 2 5\n").find("line 5: vertex 5"), std::string::npos);
  EXPECT_NE(refusal(k_square + "f 0 1 2\n").find("line 5"), std::string::npos);
  EXPECT_NE(refusal(k_square + "f -5 1 2\n").find("line 5"), std::string::npos);
  EXPECT_NE(refusal(k_square + "f 1/1 2/1 3/1\n").find("texture vertex 1"), std::string::npos);
  EXPECT_NE(refusal(k_square + "f 1 2 99999999999999999999\n").find("line 5"), std::string::npos);
  EXPECT_NE(refusal("hello world\n").find("line 1"), std::string::npos);
  EXPECT_NE(refusal("# nothing\n"), "");
}

TEST_F(ObjReader, OddThingsAreWarnings) {
  const Scene scene = read(k_square + "vn nan 0 0\nf 1 2\nl 1 2\nusemtl none\nmtllib no.mtl\nf 1//1 2//1 3//1\n");
  EXPECT_EQ(scene.parts.at(0).mesh.triangles.size(), 1U);
  EXPECT_EQ(scene.warnings.size(), 4U);
  EXPECT_EQ(scene.losses.size(), 1U);
  EXPECT_EQ(scene.materials.at(0).name, "none");
}

TEST_F(ObjReader, VertexColoursAreLinear) {
  const Scene scene = read("v 0 0 0 1 0 0.5\nv 1 0 0 nan 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto& colors = scene.parts.at(0).mesh.colors;
  ASSERT_EQ(colors.values.size(), 3U);
  EXPECT_FLOAT_EQ(colors.values[0].r, 1);
  EXPECT_NEAR(colors.values[0].b, 0.21404, 1e-5) << "sRGB 0.5";
  EXPECT_EQ(colors.values[1], Color{});
}

TEST_F(ObjReader, MaterialsAndTextures) {
  write_png("wood grain.png");
  folder_.write("my lib.mtl",
                "newmtl dark wood\nKd 0.1 0.2 0.3\nKa 0 0 0\nKs 1 1 1\nd 0.5\nNs 250\nmap_Kd -s 2 3 1 -o 0.5 0.25 wood "
                "grain.png\nnewmtl pbr\nTr 0.25\nNs 10\nPr 0.4\nPm 1\nKe 1 0 0\nmap_Kd gone.png\nmap_d x.png\n");
  const Scene scene = read("mtllib my lib.mtl\n" + k_square + "usemtl dark wood\nf 1 2 3\nusemtl pbr\nf 1 3 4\n");
  ASSERT_EQ(scene.materials.size(), 2U);
  const Material& wood = scene.materials[0];
  EXPECT_EQ(wood.base_color, (std::array<double, 4>{0.1, 0.2, 0.3, 0.5}));
  EXPECT_EQ(wood.alpha_mode, "BLEND");
  EXPECT_DOUBLE_EQ(wood.roughness, 0.5);
  ASSERT_TRUE(wood.base_color_texture && wood.base_color_texture->transform);
  // OBJ: v' = 3 v + 0.25. The lower left corner goes to (0.5, 0.25), the upper right to (2.5, 3.25).
  const UvTransform& transform = *wood.base_color_texture->transform;
  EXPECT_EQ(transform_uv(transform, {0, 0}), (Vec2{0.5, 0.25}));
  EXPECT_EQ(transform_uv(transform, {1, 1}), (Vec2{2.5, 3.25}));
  EXPECT_EQ(scene.images.at(0).bytes.size(), sizeof test::k_grey8_png);
  EXPECT_EQ(scene.images[0].uri, "wood grain.png");
  const Material& pbr = scene.materials[1];
  EXPECT_EQ(pbr.base_color[3], 0.75);
  EXPECT_EQ(pbr.roughness, 0.4);
  EXPECT_EQ(pbr.metallic, 1);
  EXPECT_FALSE(pbr.base_color_texture);
  EXPECT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.losses.size(), 1U);
  EXPECT_EQ(scene.parts.at(0).mesh.material, (Values<std::uint32_t>{0, 1}));
}

TEST_F(ObjReader, ASingleScaleIsThatOfUAndGlowingPicturesAreScaledToo) {
  write_png("a.png");
  folder_.write("a.mtl", "newmtl a\nmap_Kd -s 2 a.png\nKe 1 1 1\nmap_Ke -s 3 5 1 -o 0.5 0.25 a.png\n");
  const Scene scene = read("mtllib a.mtl\n" + k_square + "usemtl a\nf 1 2 3\n");
  const Material& material = scene.materials.at(0);
  ASSERT_TRUE(material.base_color_texture && material.base_color_texture->transform);
  EXPECT_EQ(transform_uv(*material.base_color_texture->transform, {1, 1}), (Vec2{2, 1}));
  ASSERT_TRUE(material.emissive_texture && material.emissive_texture->transform);
  EXPECT_EQ(transform_uv(*material.emissive_texture->transform, {1, 1}), (Vec2{3.5, 5.25}));
}

TEST_F(ObjReader, MtlErrorsNameTheLine) {
  folder_.write("bad.mtl", "newmtl a\nKd 1 x 1\n");
  EXPECT_NE(refusal("mtllib bad.mtl\n" + k_square + "usemtl a\nf 1 2 3\n").find("bad.mtl: line 2"), std::string::npos);
  folder_.write("bad.mtl", "Kd 1 1 1\n");
  EXPECT_NE(refusal("mtllib bad.mtl\n" + k_square + "usemtl a\nf 1 2 3\n").find("bad.mtl: line 1"), std::string::npos);
}

TEST_F(ObjReader, LibrariesAndMapsLieInTheFolderOfTheFileThatNamesThem) {
  std::filesystem::create_directory(folder_ / "inside");
  folder_.write("outside.mtl", "newmtl a\nKd 1 0 0\n");
  write_png("outside.png");
  write_png("inside/known.png");
  std::filesystem::create_symlink("../outside.png", folder_ / "inside/link.png");
  const auto read_inside = [&](const std::string& library, const std::string& map) {
    folder_.write("inside/a.mtl", "newmtl a\nKd 1 1 1\nmap_Kd " + map + "\n");
    return read_obj(folder_.write("inside/a.obj", "mtllib " + library + "\n" + k_square + "usemtl a\nf 1 2 3\n"));
  };
  for (const std::string& library : {std::string("../outside.mtl"), (folder_ / "outside.mtl").string()}) {
    const std::string message = message_of<InvalidInput>([&] { read_inside(library, "known.png"); });
    EXPECT_NE(message.find("inside/a.obj: line 1: '" + library + "' leads out of the folder"), std::string::npos);
  }
  for (const std::string& map : {std::string("../outside.png"), std::string("..\\outside.png"),
                                 (folder_ / "outside.png").string(), std::string("link.png")}) {
    const std::string message = message_of<InvalidInput>([&] { read_inside("a.mtl", map); });
    EXPECT_NE(message.find("inside/a.mtl: line 3: '"), std::string::npos) << map << ": " << message;
    EXPECT_NE(message.find("leads out of the folder"), std::string::npos) << map << ": " << message;
  }
  // The paths of the machine that wrote the file: the picture lies beside it.
  for (const std::string& map : {std::string("/home/artist/known.png"), std::string("..\\textures\\known.png")}) {
    const Scene scene = read_inside("a.mtl", map);
    EXPECT_EQ(scene.images.size(), 1U) << map;
    EXPECT_TRUE(scene.warnings.empty()) << map;
  }
}

TEST_F(ObjReader, TextIsNoPictureAndNoLibrary) {
  folder_.write("passwd", "root:x:0:0:root\nuser words\n");
  folder_.write("a.mtl", "newmtl a\nmap_Kd passwd\n");
  const std::string obj = k_square + "usemtl a\nf 1 2 3\n";
  const std::string picture = refusal("mtllib a.mtl\n" + obj);
  EXPECT_NE(picture.find("a.mtl: line 2: "), std::string::npos) << picture;
  EXPECT_NE(picture.find("no picture"), std::string::npos) << picture;
  const std::string library = refusal("mtllib passwd\n" + obj);
  EXPECT_NE(library.find("is it a material library?"), std::string::npos) << library;
  EXPECT_EQ((picture + library).find("root:"), std::string::npos);
  folder_.write("a.webp", std::string("RIFF\x04\0\0\0WEBPVP8L", 16));
  folder_.write("a.mtl", "newmtl a\nmap_Kd a.webp\n");
  EXPECT_EQ(read("mtllib a.mtl\n" + obj).warnings.size(), 1U) << "a picture of a known format that can't be decoded";
}

TEST_F(ObjReader, EveryPrefixThrowsOrSucceeds) {
  const std::string whole = k_square + "vt 0 0\nvn 0 0 1\no part\nusemtl m\nf 1/1/1 2/1/1 3/1/1 4/1/1\n";
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try {
      for (const Part& part : read(whole.substr(0, length)).parts)
        for (const Triangle& triangle : part.mesh.triangles)
          for (const Index index : triangle) ASSERT_LT(index, part.mesh.positions.size());
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

/// Quads that stand alone, several blocks of a reader's lines of them: corners count back, every 7th face goes on in
/// the next line, and every part has quads at the beginning of the file and at its end.
class LargeObj {
 public:
  static constexpr int k_quads = 12000, k_parts = 3;

  static Vec3 corner(int quad, int k) { return {quad + (k == 1 || k == 2) * 0.5, 2.0 * (k > 1), quad % 5 * 0.25}; }
  static Vec2 uv(int quad, int k) { return {quad * 0.125, k * 0.25}; }
  static int part_of(int quad) { return quad / 700 % k_parts; }

  std::string text() {
    lines_ = 0;
    std::string text;
    const auto add = [&](const std::string& line) { text += line + (++lines_ % 3 == 0 ? "\r\n" : "\n"); };
    for (int q = 0; q < k_quads; ++q) {
      if (q % 700 == 0) add("o part " + std::to_string(part_of(q)));
      for (int k = 0; k < 4; ++k) {
        const Vec3 p = corner(q, k);
        add(fmt::format("v {} {} {}{}", p.x, p.y, p.z, q >= 11000 ? " 1 0 0" : ""));
        add(fmt::format("vt {} {}", uv(q, k).x, uv(q, k).y));
      }
      if (q % 7 == 0) {
        add("f -4/-4 -3/-3 \\");
        add(" -2/-2 -1/-1");
      } else {
        add(fmt::format("f {0}/{0} {1}/-3 -2/{2} {3}/{3}", 4 * q + 1, 4 * q + 2, 4 * q + 3, 4 * q + 4));
      }
    }
    return text;
  }
  int lines() const { return lines_; }

 private:
  int lines_ = 0;
};

TEST_F(ObjReader, ALargeFileIsReadInBlocksAsAWhole) {
  const std::string text = LargeObj().text();
  ASSERT_GT(text.size(), std::size_t{3} << 19);
  for (const std::size_t threads : {1, 4}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    const Scene scene = read(text);
    ASSERT_EQ(scene.parts.size(), std::size_t{LargeObj::k_parts});
    std::vector<std::size_t> seen(LargeObj::k_parts, 0);
    for (int q = 0; q < LargeObj::k_quads; ++q) {
      const int part = LargeObj::part_of(q);
      ASSERT_EQ(scene.parts[part].name, "part " + std::to_string(part));
      const TriangleMesh& mesh = scene.parts[part].mesh;
      const std::size_t t = 2 * seen[part]++;
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(mesh.corner(t, k), LargeObj::corner(q, static_cast<int>(k))) << q;
        ASSERT_EQ(mesh.uv.values[mesh.uv.indices[t][k]], LargeObj::uv(q, static_cast<int>(k))) << q;
        ASSERT_EQ(mesh.corner(t + 1, k), LargeObj::corner(q, k == 0 ? 0 : static_cast<int>(k) + 1)) << q;
      }
      const Color colour = mesh.colors.values[mesh.colors.indices[t][0]];
      ASSERT_EQ(colour.g, q >= 11000 ? 0.0F : Color{}.g) << q;
    }
    for (int part = 0; part < LargeObj::k_parts; ++part)
      EXPECT_EQ(scene.parts[part].mesh.triangles.size(), 2 * seen[part]);
  }
}

TEST_F(ObjReader, FaultsOfALargeFileNameTheirLine) {
  LargeObj large;
  const std::string text = large.text();
  const std::string line = "line " + std::to_string(large.lines() + 2) + ": ";
  const auto refused = [&](const std::string& fault, const std::string& reason) {
    EXPECT_NE(refusal(text + "# a comment\n" + fault + "\nf 1 2 what\n").find(line + reason), std::string::npos)
        << fault;
  };
  refused("f 1 2 -48001", "vertex -48001 does not exist");
  refused("f 1/1 2/2 3/-48001", "texture vertex -48001 does not exist");
  refused("f 1 -48001", "vertex -48001 does not exist");
  refused("v 1 nan 2", "a vertex is not finite");
  EXPECT_NE(refusal(text + "\nf 1 2 48001\n").find(line + "vertex 48001 of 48000 does not exist"), std::string::npos);
  const Scene scene = read(text + "# a comment\nf 1 -48000\nf 2 3\nvn 1 nan 2\n");
  ASSERT_EQ(scene.warnings.size(), 2U);
  EXPECT_NE(scene.warnings[0].find("2 faces of fewer"), std::string::npos) << scene.warnings[0];
  EXPECT_NE(scene.warnings[0].find("line " + std::to_string(large.lines() + 2)), std::string::npos);
  EXPECT_NE(scene.warnings[1].find("line " + std::to_string(large.lines() + 4)), std::string::npos);
}

}  // namespace
}  // namespace papilla
