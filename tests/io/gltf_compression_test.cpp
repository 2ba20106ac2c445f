// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "io/glb_fixture.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/gltf_reader.hpp"

#ifdef PAPILLA_HAVE_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#ifdef PAPILLA_HAVE_MESHOPT
#include <meshoptimizer.h>
#endif

namespace papilla {
namespace {

using test::GlbFixture;
using test::message_of;
using test::TemporaryFolder;

std::string number(std::size_t value) { return std::to_string(value); }

class GltfCompression : public testing::Test {
 protected:
  Scene read(const std::string& bytes) const { return read_gltf(folder_.write("a.glb", bytes)); }
  std::string refusal(const std::string& bytes) const {
    return message_of<InvalidInput>([&] { read(bytes); });
  }
  const TemporaryFolder folder_;
};

/// A bent grid of n × n vertices in metres with texture coordinates that tell the vertex.
struct Grid {
  std::vector<float> positions, uv;
  std::vector<std::uint32_t> corners;
};

Grid grid(unsigned n) {
  Grid g;
  const float step = 1.0F / static_cast<float>(n - 1);
  for (unsigned y = 0; y < n; ++y)
    for (unsigned x = 0; x < n; ++x) {
      const float u = static_cast<float>(x) * step, v = static_cast<float>(y) * step;
      g.positions.insert(g.positions.end(), {u, v, u * v});
      g.uv.insert(g.uv.end(), {u, v});
    }
  for (unsigned y = 0; y + 1 < n; ++y)
    for (unsigned x = 0; x + 1 < n; ++x) {
      const unsigned a = y * n + x, b = a + 1, c = a + n, d = c + 1;
      g.corners.insert(g.corners.end(), {a, b, d, a, d, c});
    }
  return g;
}

/// Every corner lies on the grid's surface where its texture coordinates say, to the tolerance in millimetres.
void expect_grid(const TriangleMesh& mesh, const Grid& expected, double tolerance_mm) {
  ASSERT_EQ(mesh.triangles.size(), expected.corners.size() / 3);
  ASSERT_EQ(mesh.uv.indices.size(), mesh.triangles.size());
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec2 uv = mesh.uv.values[mesh.uv.indices[t][static_cast<std::size_t>(k)]];
      const double u = uv.x, v = 1 - uv.y;
      EXPECT_LT(norm(mesh.corner(t, k) - 1000.0 * Vec3{u, v, u * v}), tolerance_mm);
    }
    area += cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)).z / 2;
  }
  EXPECT_NEAR(area, 1e6, 1e6 * tolerance_mm / 100) << "the projection covers the square once, facing up";
}

#ifdef PAPILLA_HAVE_DRACO

std::string draco_stream(const Grid& g, bool edgebreaker) {
  draco::TriangleSoupMeshBuilder builder;
  const auto triangles = static_cast<int>(g.corners.size() / 3);
  builder.Start(triangles);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  for (int t = 0; t < triangles; ++t) {
    std::array<const float*, 3> p, q;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t corner = g.corners[3 * static_cast<std::size_t>(t) + k];
      p[k] = &g.positions[3 * corner];
      q[k] = &g.uv[2 * corner];
    }
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(static_cast<unsigned>(t)), p[0], p[1], p[2]);
    builder.SetAttributeValuesForFace(uv, draco::FaceIndex(static_cast<unsigned>(t)), q[0], q[1], q[2]);
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, 16);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

/// @param vertices, corners  what the accessors promise.
std::string draco_glb(const std::string& stream, std::size_t vertices, std::size_t corners) {
  GlbFixture glb;
  const int view = glb.view(std::vector<char>(stream.begin(), stream.end()));
  const int position = glb.accessor(-1, 5126, vertices, "VEC3"), uv = glb.accessor(-1, 5126, vertices, "VEC2"),
            indices = glb.accessor(-1, 5125, corners, "SCALAR");
  return glb.glb(R"("extensionsRequired":["KHR_draco_mesh_compression"],)" +
                 test::mesh_of(R"({"attributes":{"POSITION":)" + std::to_string(position) + R"(,"TEXCOORD_0":)" +
                               std::to_string(uv) + R"(},"indices":)" + std::to_string(indices) +
                               R"(,"extensions":{"KHR_draco_mesh_compression":{"bufferView":)" + std::to_string(view) +
                               R"(,"attributes":{"POSITION":0,"TEXCOORD_0":1}}}})"));
}

TEST_F(GltfCompression, DracoGivesTheSurfaceBack) {
  const Grid g = grid(12);
  for (const bool edgebreaker : {true, false}) {
    const Scene scene = read(draco_glb(draco_stream(g, edgebreaker), 144, g.corners.size()));
    expect_grid(scene.parts.at(0).mesh, g, 0.1);
    EXPECT_TRUE(scene.losses.empty());
  }
}

TEST_F(GltfCompression, DracoClaimsAreHeldAgainstTheAccessors) {
  const Grid g = grid(12);
  for (const bool edgebreaker : {true, false}) {
    const std::string stream = draco_stream(g, edgebreaker);
    EXPECT_NE(refusal(draco_glb(stream, 143, g.corners.size())).find("claims 144 vertices"), std::string::npos);
    EXPECT_NE(refusal(draco_glb(stream, 144, g.corners.size() - 3)).find("triangles"), std::string::npos);
    EXPECT_NE(refusal(draco_glb(stream, 4000000000U, g.corners.size())).find("expands to more elements"),
              std::string::npos);
  }
}

TEST_F(GltfCompression, DamagedDracoIsRefusedOrRead) {
  const Grid g = grid(5);
  const std::string stream = draco_stream(g, true);
  for (std::size_t length = 0; length < stream.size(); length += 3)
    EXPECT_NE(refusal(draco_glb(stream.substr(0, length), 25, g.corners.size())), "") << length;
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = stream;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      read(draco_glb(damaged, 25, g.corners.size()));
    } catch (const InvalidInput&) {
    }
  }
}

#else

TEST_F(GltfCompression, DracoIsRefusedByName) {
  GlbFixture glb;
  EXPECT_NE(
      refusal(glb.glb(R"("extensionsRequired":["KHR_draco_mesh_compression"],)")).find("KHR_draco_mesh_compression"),
      std::string::npos);
}

#endif

#ifdef PAPILLA_HAVE_MESHOPT

template <class T>
std::vector<unsigned char> meshopt_attributes(const std::vector<T>& values, std::size_t stride) {
  const std::size_t count = values.size() * sizeof(T) / stride;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), values.data(), count, stride));
  return out;
}

std::vector<unsigned char> meshopt_triangles(const Grid& g) {
  std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(g.corners.size(), g.positions.size() / 3));
  out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), g.corners.data(), g.corners.size()));
  return out;
}

/// A view into buffer 1, which has no data, whose compressed bytes are appended to buffer 0.
int meshopt_view(GlbFixture& glb, const std::vector<unsigned char>& stream, const std::string& extension,
                 std::size_t stride, std::size_t count, const std::string& mode) {
  const std::size_t offset = glb.next_offset();
  glb.view(stream);
  return glb.described_view(R"({"buffer":1,"byteLength":)" + number(stride * count) +
                            (mode.starts_with("ATTRIBUTES") ? R"(,"byteStride":)" + number(stride) : "") +
                            R"(,"extensions":{")" + extension + R"(":{"buffer":0,"byteOffset":)" + number(offset) +
                            R"(,"byteLength":)" + number(stream.size()) + R"(,"byteStride":)" + number(stride) +
                            R"(,"count":)" + number(count) + R"(,"mode":")" + mode + R"("}}})");
}

std::string meshopt_glb(const Grid& g, const std::string& extension, std::size_t claimed_vertices) {
  const std::size_t vertices = g.positions.size() / 3;
  GlbFixture glb;
  glb.add_buffer(R"({"byteLength":100000,"extensions":{")" + extension + R"(":{"fallback":true}}})");
  const int position = glb.accessor(
      meshopt_view(glb, meshopt_attributes(g.positions, 12), extension, 12, claimed_vertices, "ATTRIBUTES"), 5126,
      vertices, "VEC3");
  const int uv = glb.accessor(meshopt_view(glb, meshopt_attributes(g.uv, 8), extension, 8, vertices, "ATTRIBUTES"),
                              5126, vertices, "VEC2");
  const int indices = glb.accessor(meshopt_view(glb, meshopt_triangles(g), extension, 4, g.corners.size(), "TRIANGLES"),
                                   5125, g.corners.size(), "SCALAR");
  return glb.glb(R"("extensionsRequired":[")" + extension + R"("],)" +
                 test::mesh_of(R"({"attributes":{"POSITION":)" + std::to_string(position) + R"(,"TEXCOORD_0":)" +
                               std::to_string(uv) + R"(},"indices":)" + std::to_string(indices) + "}"));
}

TEST_F(GltfCompression, MeshoptGivesTheSurfaceBack) {
  const Grid g = grid(12);
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    expect_grid(read(meshopt_glb(g, extension, 144)).parts.at(0).mesh, g, 1e-3);
}

TEST_F(GltfCompression, MeshoptFiltersAreUndone) {
  const std::vector<float> normals = {0, 0, 1, 0, 0.6F, 0, -0.8F, 0, 1, 0, 0, 0};
  std::vector<std::int8_t> filtered(12);
  meshopt_encodeFilterOct(filtered.data(), 3, 4, 8, normals.data());
  GlbFixture glb;
  glb.add_buffer(R"({"byteLength":100000,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})");
  const int position = glb.positions(test::row_of_points(3));
  const int normal = glb.accessor(meshopt_view(glb, meshopt_attributes(filtered, 4), "EXT_meshopt_compression", 4, 3,
                                               R"(ATTRIBUTES","filter":"OCTAHEDRAL)"),
                                  5120, 3, "VEC3", R"(,"normalized":true)");
  const TriangleMesh mesh = read(glb.glb(test::mesh_of(R"({"attributes":{"POSITION":)" + std::to_string(position) +
                                                       R"(,"NORMAL":)" + std::to_string(normal) + "}}")))
                                .parts.at(0)
                                .mesh;
  ASSERT_EQ(mesh.normals.values.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(norm(mesh.normals.values[i] - Vec3{normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]}), 0.02);
}

TEST_F(GltfCompression, MeshoptClaimsAreHeldAgainstTheBytes) {
  const std::string message = refusal(meshopt_glb(grid(12), "EXT_meshopt_compression", 2000000000U));
  EXPECT_NE(message.find("count 2000000000 is more than"), std::string::npos) << message;
  EXPECT_NE(refusal(meshopt_glb(grid(12), "EXT_meshopt_compression", 300)).find("damaged"), std::string::npos);
  for (const std::size_t claimed : {std::size_t{1} << 31, (std::size_t{1} << 32) + 144, std::size_t{1} << 63}) {
    const std::string beyond = refusal(meshopt_glb(grid(12), "KHR_meshopt_compression", claimed));
    EXPECT_NE(beyond.find("count " + std::to_string(claimed) + " is out of range"), std::string::npos) << beyond;
  }
}

#else

TEST_F(GltfCompression, MeshoptIsRefusedByName) {
  GlbFixture glb;
  EXPECT_NE(refusal(glb.glb(R"("extensionsRequired":["EXT_meshopt_compression"],)")).find("EXT_meshopt_compression"),
            std::string::npos);
}

#endif

}  // namespace
}  // namespace papilla
