// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <cstring>
#include <limits>
#include <vector>

#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using test::message_of;
using test::TemporaryFolder;

std::string binary_stl(const std::vector<float>& corners, std::uint32_t claimed, const std::string& header = "") {
  std::string bytes = header;
  bytes.resize(80, '\0');
  bytes.append(reinterpret_cast<const char*>(&claimed), 4);
  for (std::size_t t = 0; t < corners.size() / 9; ++t) {
    bytes.append(12, '\0');
    bytes.append(reinterpret_cast<const char*>(&corners[9 * t]), 36);
    bytes.append(2, '\0');
  }
  return bytes;
}

const std::vector<float> k_square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};

const std::string k_ascii =
    "solid first part\r\n FACET normal 0 0 nan\r\n outer loop\r\n vertex 0 0 0\r\n vertex 1.5 0 0\r\n"
    " vertex 0 1e0 +0.25\r\n endloop\r\n endfacet\r\nendsolid first part\r\nsolid\nendsolid\n";

class StlReader : public testing::Test {
 protected:
  Scene read(const std::string& bytes, const ReadOptions& options = {}) const {
    return read_stl(folder_.write("a.stl", bytes), options);
  }
  std::string refusal(const std::string& bytes) const {
    return message_of<InvalidInput>([&] { read(bytes); });
  }
  const TemporaryFolder folder_;
};

TEST_F(StlReader, BinaryMergesEqualPositions) {
  const Scene scene = read(binary_stl(k_square, 2));
  ASSERT_EQ(scene.parts.size(), 1U);
  EXPECT_EQ(scene.parts[0].name, "a");
  const TriangleMesh& mesh = scene.parts[0].mesh;
  EXPECT_EQ(mesh.positions, (Values<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Values<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.up, UpAxis::z);
}

TEST_F(StlReader, BinaryThatBeginsWithSolid) {
  EXPECT_EQ(read(binary_stl(k_square, 2, "solid of an exporter")).parts[0].mesh.triangles.size(), 2U);
}

/// The bytes with the attribute of a triangle set.
std::string with_attribute(std::string bytes, std::size_t triangle, std::uint16_t attribute) {
  bytes.replace(84 + 50 * triangle + 48, sizeof attribute, reinterpret_cast<const char*>(&attribute), sizeof attribute);
  return bytes;
}

TEST_F(StlReader, ColoursOfVisCam) {
  const std::string bytes = with_attribute(binary_stl(k_square, 2), 1, 0x8000 | 31 << 10 | 31);
  const auto colors = read(bytes).parts[0].mesh.colors;
  ASSERT_EQ(colors.indices.size(), 2U);
  EXPECT_EQ(colors.values[colors.indices[0][0]], (Color{1, 1, 1, 1}));
  EXPECT_EQ(colors.values[colors.indices[1][2]], (Color{1, 0, 1, 1}));
}

TEST_F(StlReader, ColoursOfMaterialise) {
  std::string bytes = binary_stl(k_square, 2, std::string("made by hand COLOR=\xff\x00\x00\xff", 23));
  const auto black = read(with_attribute(bytes, 0, 0x8000)).parts[0].mesh.colors;
  EXPECT_EQ(black.values[black.indices[1][0]], (Color{0, 0, 0, 1})) << "triangle 1 has a colour of its own";
  const auto colors = read(with_attribute(with_attribute(bytes, 0, 31 << 5), 1, 0x8000)).parts[0].mesh.colors;
  EXPECT_EQ(colors.values[colors.indices[0][0]], (Color{0, 1, 0, 1}));
  EXPECT_EQ(colors.values[colors.indices[1][0]], (Color{1, 0, 0, 1})) << "the object's";
}

TEST_F(StlReader, NoAttributeNoColour) { EXPECT_TRUE(read(binary_stl(k_square, 2)).parts[0].mesh.colors.empty()); }

TEST_F(StlReader, ManyBlocksKeepTheirOrder) {
  std::vector<float> corners;
  for (int t = 0; t < 3000; ++t)
    for (const int c : {t, t + 1, t + 2}) corners.insert(corners.end(), {float(c), float(c % 7), 0});
  const TriangleMesh mesh = read(binary_stl(corners, 3000)).parts[0].mesh;
  EXPECT_EQ(mesh.positions.size(), 3002U);
  for (std::size_t t = 0; t < 3000; ++t)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(mesh.corner(t, k).x, double(t) + k);
}

TEST_F(StlReader, UnitAndAxis) {
  ReadOptions options, wrong;
  options.millimetres_per_unit = 25.4;
  options.up = UpAxis::y;
  wrong.millimetres_per_unit = -1;
  const Scene scene = read(binary_stl(k_square, 2), options);
  EXPECT_EQ(scene.parts[0].mesh.positions[1], (Vec3{25.4, 0, 0}));
  EXPECT_EQ(scene.unit, "in");
  EXPECT_EQ(scene.up, UpAxis::y);
  const Scene text = read(
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 1 3\n"
      "endloop\nendfacet\nendsolid\n",
      options);
  EXPECT_EQ(text.parts[0].mesh.corner(0, 1), (Vec3{50.8, 0, 0}));
  EXPECT_EQ(text.parts[0].mesh.corner(0, 2), (Vec3{0, 25.4, 3 * 25.4}));
  EXPECT_THROW(read(binary_stl(k_square, 2), wrong), InvalidInput);
}

TEST_F(StlReader, HugeClaimsAreRefused) {
  std::string bytes = binary_stl({}, 4000000000U);
  bytes.resize(100, '\0');
  const std::string message = refusal(bytes);
  EXPECT_NE(message.find("4000000000"), std::string::npos);
  EXPECT_NE(message.find("0 found"), std::string::npos);
}

TEST_F(StlReader, EveryPrefixOfABinaryFileIsRefused) {
  const std::string whole = binary_stl(k_square, 2);
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "") << length;
  EXPECT_EQ(read(whole + "x").warnings.size(), 1U);
}

TEST_F(StlReader, NamesTheTriangleThatIsNotFinite) {
  std::vector<float> corners = k_square;
  corners[13] = std::numeric_limits<float>::infinity();
  EXPECT_NE(refusal(binary_stl(corners, 2)).find("triangle 1"), std::string::npos);
}

TEST_F(StlReader, AsciiWithSeveralSolids) {
  const Scene scene = read(k_ascii);
  ASSERT_EQ(scene.parts.size(), 2U);
  EXPECT_EQ(scene.parts[0].name, "first part");
  EXPECT_EQ(scene.parts[1].name, "a");
  ASSERT_EQ(scene.parts[0].mesh.triangles.size(), 1U);
  EXPECT_EQ(scene.parts[0].mesh.corner(0, 2), (Vec3{0, 1, 0.25}));
  EXPECT_TRUE(scene.parts[1].mesh.triangles.empty());
}

/// Sets a locale with a decimal comma. Where none is installed it is compiled into `folder`.
bool set_decimal_comma(const std::filesystem::path& folder) {
  const auto set = [] {
    return std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr && *std::localeconv()->decimal_point == ',';
  };
  if (set()) return true;
  const std::string compile = "localedef --no-archive -c -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() + "'";
  setenv("LOCPATH", folder.c_str(), 1);
  return std::system(compile.c_str()) >= 0 && set();
}

TEST_F(StlReader, AsciiNumbersDoNotDependOnTheLocale) {
  const TemporaryFolder locales;
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (!set_decimal_comma(locales.path())) GTEST_SKIP() << "localedef or the sources of de_DE are not installed";
  const Scene scene = read(k_ascii);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(scene.parts[0].mesh.corner(0, 1), (Vec3{1.5, 0, 0}));
}

TEST_F(StlReader, EveryPrefixOfAnAsciiFileThrowsOrSucceeds) {
  std::size_t good = 0;
  for (std::size_t length = 0; length < k_ascii.size(); ++length) {
    try {
      read(k_ascii.substr(0, length));
      ++good;
    } catch (const InvalidInput&) {
    }
  }
  // Complete are only those that end behind an "endsolid".
  EXPECT_LE(good, std::string(" first part\r\n").size() + 1 + 2);
}

TEST_F(StlReader, AsciiErrorsNameTheLine) {
  EXPECT_NE(refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0").find("line 4: 'zero'"),
            std::string::npos);
  EXPECT_NE(refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0").find("triangle 0"), std::string::npos);
  EXPECT_NE(refusal("solid x\nfaucet").find("line 2"), std::string::npos);
}

TEST_F(StlReader, FacetsOfMoreThanThreeVertices) {
  const Scene scene = read(
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 1 1 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid");
  EXPECT_EQ(scene.parts[0].mesh.triangles, (Values<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.warnings.size(), 1U);
}

}  // namespace
}  // namespace papilla
