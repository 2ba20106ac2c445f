// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>

#include "io/scene_fixtures.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/mesh_files.hpp"
#include "papilla/io/vertex_normals.hpp"

namespace papilla {
namespace {

using test::message_of;
using test::TemporaryFolder;

const std::string k_corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string big_endian(std::uint32_t word) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(word >> shift & 0xff);
  return bytes;
}
std::string big_endian(float value) { return big_endian(std::bit_cast<std::uint32_t>(value)); }

class Off : public testing::Test {
 protected:
  Scene read(const std::string& bytes) const { return read_off(folder_.write("a.off", bytes)); }
  TriangleMesh mesh(const std::string& bytes) const { return read(bytes).parts.at(0).mesh; }
  std::string refusal(const std::string& bytes) const {
    return message_of<InvalidInput>([&] { read(bytes); });
  }
  const TemporaryFolder folder_;
};

TEST_F(Off, PolygonsCommentsAndMissingParts) {
  const Values<Triangle> expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh("OFF\n4 1 4\n" + k_corners + "4 0 1 2 3\n").triangles, expected);
  EXPECT_EQ(mesh("# a\n4 1\n\n# b\n" + k_corners + " 4 0 1 2 3 # c").triangles, expected);
  EXPECT_EQ(mesh("OFF 4 1 4\r\n" + k_corners + "4 0 1\n2 3\n").triangles, expected);
}

TEST_F(Off, ColoursOfFacesInBothForms) {
  const Scene scene =
      read("OFF\n4 4 0\n" + k_corners + "3 0 1 2 255 0 0\n3 0 2 3 0.0 0.0 1.0 0.5\n3 0 1 2\n3 0 1 2 7\n");
  const auto& colors = scene.parts.at(0).mesh.colors;
  EXPECT_EQ(colors.values, (Values<Color>{{1, 0, 0, 1}, {0, 0, 1, 0.5F}}));
  EXPECT_EQ(colors.indices[1], (Triangle{1, 1, 1}));
  EXPECT_FALSE(colors.has_value(2));
  EXPECT_EQ(scene.losses.size(), 1U) << "the number of a colour map";
}

TEST_F(Off, AttributesOfVertices) {
  const TriangleMesh m = mesh(
      "STCNOFF\n3 1 0\n0 0 0  0 0 2  255 0 0  0.25 0.5\n1 0 0  0 0 1  0 255 0  1 0\n0 1 0  0 0 1  0 0 255  0 1\n3 0 1 "
      "2\n");
  EXPECT_EQ(m.normals.values, (Values<Vec3>(3, Vec3{0, 0, 1})));
  EXPECT_EQ(m.colors.values, (Values<Color>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}));
  EXPECT_EQ(m.uv.values, (Values<Vec2>{{0.25, 0.5}, {1, 0}, {0, 1}}));
  EXPECT_EQ(m.uv.indices, m.triangles);
}

TEST_F(Off, Binary) {
  std::string bytes = "COFF BINARY\n" + big_endian(3U) + big_endian(1U) + big_endian(0U);
  for (const Vec3 p : {Vec3{0, 0, 0}, {1.5, 0, 0}, {0, -2, 0}})
    for (const double x : {p.x, p.y, p.z, 0.0, 1.0, 0.0, 1.0}) bytes += big_endian(static_cast<float>(x));
  bytes += big_endian(3U) + big_endian(2U) + big_endian(0U) + big_endian(1U) + big_endian(0U);
  const TriangleMesh m = mesh(bytes);
  EXPECT_EQ(m.positions, (Values<Vec3>{{0, 0, 0}, {1.5, 0, 0}, {0, -2, 0}}));
  EXPECT_EQ(m.triangles, (Values<Triangle>{{2, 0, 1}}));
  EXPECT_EQ(m.colors.values[1], (Color{0, 1, 0, 1}));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_NE(refusal(bytes.substr(0, length)), "") << length;
}

TEST_F(Off, RefusalsNameThePlace) {
  EXPECT_NE(refusal("OFF\n4000000000 4000000000 0\n0 0 0\n").find("4000000000 vertices promised"), std::string::npos);
  EXPECT_NE(refusal("OFF\n4 1 0\n" + k_corners + "4000000000 0 1\n").find("4000000000 corners promised"),
            std::string::npos);
  EXPECT_NE(refusal("OFF\n4 1 0\n" + k_corners + "3 0 1 4\n").find("line 7: vertex 4 of 4"), std::string::npos);
  EXPECT_NE(refusal("OFF\n1 0 0\n0 nan 0\n").find("vertex 0 is not finite"), std::string::npos);
  EXPECT_NE(refusal("4OFF\n1 0 0\n0 0 0 1\n").find("4OFF"), std::string::npos);
  EXPECT_NE(refusal("nOFF 5\n").find("nOFF"), std::string::npos);
  EXPECT_NE(refusal("{\"a\": 1}").find("is no OFF file"), std::string::npos);
}

TEST_F(Off, WhatIsWrittenIsReadAgain) {
  Part part;
  part.mesh = test::cube(0.1);
  part.mesh.uv = {};
  part.mesh.normals = vertex_normals(part.mesh, 91);
  part.mesh.colors.values = {{1, 0, 0, 1}};
  part.mesh.colors.indices.assign(12, {0, 0, 0});
  EXPECT_TRUE(write_off(single_part_scene(part, "test"), folder_ / "b.off").empty());
  const TriangleMesh m = read_off(folder_ / "b.off").parts.at(0).mesh;
  EXPECT_EQ(m.positions, part.mesh.positions) << "doubles survive";
  EXPECT_EQ(m.triangles, part.mesh.triangles);
  EXPECT_EQ(m.colors.values.at(7), (Color{1, 0, 0, 1}));
  EXPECT_NEAR(norm(m.normals.values.at(0) - part.mesh.normals.values.at(0)), 0, 1e-15);
}

}  // namespace
}  // namespace papilla
