// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "io/png_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::message_of;
using test::TemporaryFolder;

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

const std::string k_vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string k_faces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string k_corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// Bytes of a number in either order.
template <class T>
std::string bytes_of(T value, bool big_endian) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  std::string bytes(raw, sizeof value);
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

class PlyReader : public testing::Test {
 protected:
  Scene read(const std::string& bytes, const ReadOptions& options = {}) const {
    return read_ply(folder_.write("a.ply", bytes), options);
  }
  TriangleMesh mesh(const std::string& bytes) const { return read(bytes).parts.at(0).mesh; }
  std::string refusal(const std::string& bytes) const {
    return message_of<InvalidInput>([&] { read(bytes); });
  }
  const TemporaryFolder folder_;
};

TEST_F(PlyReader, PolygonsInText) {
  ReadOptions inches;
  inches.millimetres_per_unit = 25.4;
  const Scene scene = read(header("ascii", k_vertices + k_faces) + k_corners + "4 0 1 2 3\n", inches);
  ASSERT_EQ(scene.parts.size(), 1U);
  EXPECT_EQ(scene.parts[0].name, "a");
  EXPECT_EQ(scene.parts[0].mesh.triangles, (Values<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.parts[0].mesh.positions[2], (Vec3{25.4, 25.4, 0}));
  EXPECT_TRUE(scene.losses.empty() && scene.warnings.empty());
}

TEST_F(PlyReader, AllTypesInBothByteOrders) {
  const std::string elements =
      "element vertex 3\nproperty uint8 flag\nproperty double x\nproperty int16 y\nproperty uint z\n"
      "property ushort red\nproperty uint8 green\nproperty float blue\nproperty int8 spare\n"
      "element face 1\nproperty list ushort uint vertex_index\n";
  for (const bool big : {false, true}) {
    std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian", elements);
    const double x[] = {0.1, -7, 1e9};
    const std::int16_t y[] = {-2, 32767, 0};
    const std::uint32_t z[] = {0, 4294967295U, 5};
    for (int i = 0; i < 3; ++i)
      bytes += bytes_of(std::uint8_t{9}, big) + bytes_of(x[i], big) + bytes_of(y[i], big) + bytes_of(z[i], big) +
               bytes_of(std::uint16_t{65535}, big) + bytes_of(std::uint8_t{0}, big) + bytes_of(1.0F, big) +
               bytes_of(std::int8_t{-1}, big);
    bytes += bytes_of(std::uint16_t{3}, big);
    for (const std::uint32_t corner : {2U, 0U, 1U}) bytes += bytes_of(corner, big);
    const Scene scene = read(bytes);
    const TriangleMesh& m = scene.parts.at(0).mesh;
    EXPECT_EQ(m.positions, (Values<Vec3>{{0.1, -2, 0}, {-7, 32767, 4294967295.0}, {1e9, 0, 5}}));
    EXPECT_EQ(m.triangles, (Values<Triangle>{{2, 0, 1}}));
    EXPECT_EQ(m.colors.values.at(0), (Color{1, 0, 1, 1}));
    EXPECT_EQ(scene.losses.size(), 2U) << "flag and spare";
  }
}

TEST_F(PlyReader, NormalsAndTextureCoordinatesOfVertices) {
  for (const auto& [u, v] : {std::pair("s", "t"), {"u", "v"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}}) {
    const TriangleMesh m =
        mesh(header("ascii", "element vertex 3\nproperty float " + std::string(v) +
                                 "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty "
                                 "float ny\nproperty float nz\nproperty float " +
                                 u + "\n" + k_faces) +
             "0 0 0 0 0 0 2 5\n0 1 0 0 0 0 2 6\n0.5 0 1 0 0 0 2 7\n3 0 1 2\n");
    EXPECT_EQ(m.uv.values, (Values<Vec2>{{5, 0}, {6, 0}, {7, 0.5}}));
    EXPECT_EQ(m.uv.indices, m.triangles);
    EXPECT_EQ(m.normals.values, (Values<Vec3>(3, Vec3{0, 0, 1})));
  }
}

TEST_F(PlyReader, TextureCoordinatesColoursAndPicturesOfFaces) {
  folder_.write("p.png", {reinterpret_cast<const char*>(test::k_grey8_png), sizeof test::k_grey8_png});
  const Scene scene =
      read(header("ascii", "comment TextureFile none.png\ncomment TextureFile p.png\n" + k_vertices +
                               "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float "
                               "texcoord\nproperty int texnumber\nproperty uchar red\nproperty uchar green\nproperty "
                               "uchar blue\n") +
           k_corners + "4 0 1 2 3 8 0 0 1 0 1 1 0 1 1 255 0 0\n3 0 1 2 0 0 0 255 0\n");
  const TriangleMesh& m = scene.parts.at(0).mesh;
  EXPECT_EQ(m.uv.indices, (Values<Triangle>{{0, 1, 2}, {0, 2, 3}, {k_no_value, k_no_value, k_no_value}}));
  EXPECT_EQ(m.uv.values, (Values<Vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_EQ(m.colors.values, (Values<Color>{{1, 0, 0, 1}, {0, 1, 0, 1}}));
  EXPECT_EQ(m.colors.indices[2], (Triangle{1, 1, 1}));
  EXPECT_EQ(m.material, (Values<std::uint32_t>{1, 1, 0}));
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_FALSE(scene.materials[0].base_color_texture);
  EXPECT_TRUE(scene.materials[1].base_color_texture);
  EXPECT_EQ(scene.warnings.size(), 1U) << "the missing picture";
}

TEST_F(PlyReader, PicturesLieInTheFolderOfTheFile) {
  std::filesystem::create_directory(folder_ / "inside");
  folder_.write("p.png", {reinterpret_cast<const char*>(test::k_grey8_png), sizeof test::k_grey8_png});
  const std::string message = message_of<InvalidInput>([&] {
    read_ply(folder_.write("inside/a.ply", header("ascii", "comment TextureFile ../p.png\n" + k_vertices + k_faces) +
                                               k_corners + "3 0 1 2\n"));
  });
  EXPECT_NE(message.find("inside/a.ply: line 3: '../p.png' leads out of the folder"), std::string::npos) << message;
}

TEST_F(PlyReader, TriangleStripsTurnAndRestart) {
  EXPECT_EQ(mesh(header("ascii", k_vertices + "element tristrips 1\nproperty list int int vertex_indices\n") +
                 k_corners + "9 0 1 3 2 2 -1 1 2 3\n")
                .triangles,
            (Values<Triangle>{{0, 1, 3}, {3, 1, 2}, {1, 2, 3}}));
}

TEST_F(PlyReader, FacesMayStandBeforeTheVertices) {
  const Scene scene =
      read(header("ascii", k_faces + "element edge 1\nproperty int a\n" + k_vertices + "element x 2\n") +
           "3 0 1 2\n7\n" + k_corners);
  EXPECT_EQ(scene.parts.at(0).mesh.triangles, (Values<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(scene.losses.size(), 2U) << "edge and x";
}

TEST_F(PlyReader, LineEndsOfAllSystems) {
  const std::string text = header("ascii", k_vertices + k_faces) + k_corners + "3 0 1 2\n";
  for (const char* end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) c == '\n' ? other += end : other += c;
    EXPECT_EQ(mesh(other).triangles.size(), 1U);
  }
}

TEST_F(PlyReader, AByteThatLooksLikeALineEndIsANumber) {
  std::string bytes =
      header("binary_little_endian", "element vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z\n");
  EXPECT_EQ(mesh(bytes + "\n\r\n").positions, (Values<Vec3>{{10, 13, 10}}));
}

TEST_F(PlyReader, WhatIsNotFiniteOrNotThere) {
  const Scene scene = read(header("ascii", k_vertices + "property float nx\nproperty float ny\nproperty float nz\n" +
                                               "element face 2\nproperty list uchar int vertex_indices\n") +
                           "0 0 0 nan 0 0\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n2 0 1\n");
  EXPECT_EQ(scene.parts.at(0).mesh.normals.values[0], (Vec3{}));
  EXPECT_EQ(scene.warnings.size(), 2U);
  EXPECT_NE(refusal(header("ascii", k_vertices) + "0 0 0\n1 inf 0\n1 1 0\n0 1 0\n").find("vertex 1"),
            std::string::npos);
}

TEST_F(PlyReader, HugeClaimsAreRefused) {
  const std::string vertices = "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\n";
  for (const char* format : {"ascii", "binary_little_endian"})
    EXPECT_NE(refusal(header(format, vertices) + "0 0 0\n").find("4000000000"), std::string::npos);
  EXPECT_NE(refusal(header("binary_little_endian",
                           "element vertex 0\nproperty float x\nproperty float y\nproperty float "
                           "z\nelement face 1\nproperty list uint int vertex_indices\n") +
                    "\xff\xff\xff\xff")
                .find("a list of 4294967295 entries"),
            std::string::npos);
}

TEST_F(PlyReader, EveryPrefixIsRefused) {
  const std::string text = header("ascii", k_vertices + k_faces) + k_corners + "4 0 1 2 3";
  for (std::size_t length = 0; length < text.size(); ++length) EXPECT_NE(refusal(text.substr(0, length)), "") << length;
}

TEST_F(PlyReader, MessagesNameThePlace) {
  EXPECT_NE(refusal("plx\n").find("line 1"), std::string::npos);
  EXPECT_NE(refusal(header("ascii", k_vertices + k_faces) + k_corners + "3 0 1 4\n").find("line 14: vertex 4 of 4"),
            std::string::npos);
  EXPECT_NE(refusal(header("ascii", k_vertices + k_faces) + k_corners + "3 0 1 -1\n").find("vertex -1"),
            std::string::npos);
  EXPECT_NE(refusal(header("ascii", k_vertices + k_faces) + k_corners + "3 0 1 1.5\n").find("vertex 1.5"),
            std::string::npos);
  EXPECT_NE(refusal(header("ascii", k_vertices) + "0 zero 0\n1 1 1\n1 1 1\n1 1 1\n").find("'zero' is not a number"),
            std::string::npos);
  EXPECT_NE(refusal(header("text", "")).find("unknown format 'text'"), std::string::npos);
  EXPECT_NE(refusal(header("ascii", "element face 0\n")).find("no element 'vertex'"), std::string::npos);
}

}  // namespace
}  // namespace papilla
