// SPDX-License-Identifier: MIT
#include "glb_compression.hpp"

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <span>

#include "haptic/tagged_glb.hpp"
#include "io/temporary_folder.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/rgba_image.hpp"
#include "papilla/io/scene_file.hpp"

namespace papilla {
namespace {

using nlohmann::json;
using test::content_of;
using test::message_of;
using test::TemporaryFolder;

constexpr double k_side_mm = 120;     ///< Of the patch of compressible_scene().
constexpr double k_repeats = 37;      ///< Of its grain along that side.
constexpr int k_texels = 512;         ///< Of the grain's normal map.
constexpr std::size_t k_cells = 24;   ///< Along a side.
constexpr double k_cad_range = 2.25;  ///< Of the CAD (u,v).

EncodedImage grain_picture() {
  ColorImage image{k_texels, k_texels, {}};
  std::minstd_rand random(7);
  for (int y = 0; y < k_texels; ++y)
    for (int x = 0; x < k_texels; ++x)
      for (const double value : {0.5 + 0.3 * std::sin(0.13 * x), 0.5 + 0.3 * std::sin(0.07 * (x + y)), 0.95})
        image.pixels.push_back(static_cast<unsigned char>(std::lround(250 * value) + static_cast<long>(random() % 5)));
  EncodedImage encoded;
  encoded.name = "normal.grain";
  encoded.mime_type = "image/png";
  encoded.bytes = encode_png(image);
  return encoded;
}

HeightTag grain_height() {
  const std::string png = testing::sine_png();
  const auto bytes = std::as_bytes(std::span(png.data(), png.size()));
  HeightTag height;
  height.uri = "data:image/png;base64," + encode_base64(bytes);
  height.sha256 = sha256_hex(bytes);
  height.size = {128, 4};
  height.scale_m = 2e-4;
  height.offset_m = -1e-4;
  height.metres_per_uv = {1e-3 * k_side_mm / k_repeats, 1e-3 * k_side_mm / k_repeats};
  return height;
}

Material grain_material(const std::string& name, double red) {
  Material material;
  material.name = name;
  material.base_color = {red, 0.3, 0.2, 1};
  material.normal_texture = TextureReference{0, 0, 1, {}};
  material.haptic.emplace();
  material.haptic->stiffness = 600;
  material.haptic->height = grain_height();
  return material;
}

/// A bent patch of two materials of the same grain, 40 mm from its part's origin, with all attributes; corners of a
/// triangle have a colour of their own, by which it is known. A level of detail of two triangles. Two nodes show it,
/// one below the other, turned and of other sizes.
Scene compressible_scene() {
  Scene scene;
  scene.format = "test";
  scene.up = UpAxis::y;
  scene.images = {grain_picture()};
  scene.textures.resize(1);
  scene.textures[0].image = 0;
  scene.materials = {grain_material("red", 0.9), grain_material("brown", 0.4)};
  Part part;
  part.name = "patch";
  part.materials = {0, 1};
  TriangleMesh& mesh = part.mesh;
  const auto add_vertex = [](TriangleMesh& into, double u, double v) {
    const double x = k_side_mm * u, z = -k_side_mm * v;
    into.positions.push_back({40 + x, 6 * std::sin(3 * u + 2 * v), z});
    into.normals.values.push_back(normalized(Vec3{-0.15 * std::cos(3 * u + 2 * v), 1, 0.1 * std::cos(3 * u + 2 * v)}));
    into.uv.values.push_back({k_repeats * u - 3.3, k_repeats * v});
    into.uv1.values.push_back({0.9 * u, 0.9 * v});
    into.cad_uv.values.push_back({k_cad_range * u - 1, k_cad_range * v});
  };
  const auto add_triangle = [](TriangleMesh& into, Triangle corners) {
    const auto number = static_cast<float>(into.triangles.size() + 1);
    const Color color{number / 65535, 0.25F, 1, 1};
    into.colors.values.push_back(color);
    const auto c = static_cast<Index>(into.colors.values.size() - 1);
    into.colors.indices.push_back({c, c, c});
    into.triangles.push_back(corners);
    for (auto* indices : {&into.normals.indices, &into.uv.indices, &into.uv1.indices, &into.cad_uv.indices})
      indices->push_back(corners);
  };
  for (std::size_t y = 0; y <= k_cells; ++y)
    for (std::size_t x = 0; x <= k_cells; ++x)
      add_vertex(mesh, static_cast<double>(x) / k_cells, static_cast<double>(y) / k_cells);
  for (std::size_t y = 0; y < k_cells; ++y)
    for (std::size_t x = 0; x < k_cells; ++x) {
      const auto a = static_cast<Index>(y * (k_cells + 1) + x), c = static_cast<Index>(a + k_cells + 1);
      add_triangle(mesh, {a, a + 1, c + 1});
      add_triangle(mesh, {a, c + 1, c});
      mesh.material.insert(mesh.material.end(), 2, x < k_cells / 2 ? 0U : 1U);
    }
  PartLevel level;
  for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) add_vertex(level.mesh, u, v);
  add_triangle(level.mesh, {0, 1, 2});
  add_triangle(level.mesh, {0, 2, 3});
  level.mesh.material = {0, 1};
  level.screen_coverage = 0.1;
  part.levels.push_back(std::move(level));
  scene.parts = {std::move(part)};
  scene.nodes.resize(2);
  scene.nodes[0].name = "seat";
  scene.nodes[0].part = 0;
  scene.nodes[0].local = {0, 0, -1, 10, 0, 1, 0, 20, 1, 0, 0, 30, 0, 0, 0, 1};
  scene.nodes[0].children = {1};
  scene.nodes[1].name = "belt";
  scene.nodes[1].part = 0;
  scene.nodes[1].local = {0.5, 0, 0, 300, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1};
  scene.roots = {0};
  assign_part_ids(scene);
  return scene;
}

/// The JSON chunk of a GLB.
json document_of(const std::filesystem::path& glb) {
  const std::string bytes = content_of(glb);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  return json::parse(bytes.substr(20, length));
}

struct Corner {
  Vec3 position;  ///< In the world.
  Vec3 normal;
  Vec2 uv, uv1, cad_uv;
};

/// The use of the part that a node shows, or the child of it that shows its levels of detail.
Instance use_by(const Scene& scene, const std::string& node) {
  for (const Instance& instance : instances(scene))
    if (const std::string& name = scene.nodes[instance.node].name; name == node || name == node + "_LOD0")
      return instance;
  throw InvalidInput("no node " + node);
}

/// Corners of an instance's triangles by the number in their colour.
std::map<long, std::array<Corner, 3>> corners_of(const Scene& scene, const Instance& instance) {
  std::map<long, std::array<Corner, 3>> result;
  const TriangleMesh& mesh = scene.parts[instance.part].mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<Corner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = {transform_point(instance.world, mesh.corner(t, static_cast<int>(k))),
                    mesh.normals.values[mesh.normals.indices[t][k]], mesh.uv.values[mesh.uv.indices[t][k]],
                    mesh.uv1.values[mesh.uv1.indices[t][k]], mesh.cad_uv.values[mesh.cad_uv.indices[t][k]]};
    const float red = mesh.colors.values[mesh.colors.indices[t][0]].r;
    EXPECT_TRUE(result.emplace(std::lround(65535 * double{red}), corners).second);
  }
  return result;
}

/// Turned so that corner 0 lies where that of `like` does: codecs may begin a triangle with any corner, and none may
/// turn it over.
std::array<Corner, 3> turned_like(const std::array<Corner, 3>& like, std::array<Corner, 3> corners) {
  const auto distance = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += norm(corners[k].position - like[k].position);
    return sum;
  };
  std::array<Corner, 3> best = corners;
  double least = distance();
  for (int i = 0; i < 2; ++i) {
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    if (distance() < least) least = distance(), best = corners;
  }
  return best;
}

const std::map<std::string, MeshCoding> k_codings = {
    {"meshopt", MeshCoding::meshopt}, {"draco", MeshCoding::draco}, {"quantize", MeshCoding::quantize}};

class GlbCompression : public ::testing::Test {
 protected:
  /// What the file holds, CAD (u,v) with it.
  Scene written(const Scene& scene, const GlbWriteOptions& options, GlbSizes* sizes = nullptr) const {
    write_glb(scene, folder_ / "a.glb", options, sizes);
    return read_gltf(folder_ / "a.glb", {.cad_uv = true});
  }

  /// Writes the scene in every coding: the second coordinates of its seat come back to within a distance.
  void expect_second_uv_within(const Scene& scene, double most) const {
    GlbWriteOptions options;
    for (const auto& [name, coding] : k_codings) {
      SCOPED_TRACE(name);
      options.meshes = coding;
      const Scene back = written(scene, options);
      const auto here = corners_of(scene, use_by(scene, "seat")), there = corners_of(back, use_by(back, "seat"));
      for (const auto& [number, corners] : here) {
        const auto rounded = turned_like(corners, there.at(number));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(norm(rounded[k].uv1 - corners[k].uv1), most);
      }
    }
  }

  const TemporaryFolder folder_;
};

TEST_F(GlbCompression, RoundingStaysWithinWhatWasAskedFor) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> between(-4, 4);
  for (const double most : {1e-7, 2e-5, 1e-3, 0.3})
    for (const int dimensions : {1, 2, 3}) {
      const int e = grid_exponent(most, dimensions, 4);
      const double step = std::ldexp(1.0, e);
      EXPECT_LE(0.5 * step * std::sqrt(dimensions), std::max(most, 4 * std::ldexp(1.0, -21)));
      EXPECT_GT(step * std::sqrt(dimensions), most) << "no finer than needed";
      for (int i = 0; i < 100; ++i) {
        const auto value = static_cast<float>(between(random));
        const double rounded = to_grid(value, e);
        EXPECT_LE(std::abs(rounded - double{value}), 0.5 * step);
        EXPECT_EQ(rounded, std::nearbyint(rounded / step) * step);
        EXPECT_LT(std::abs(rounded / step), 0x1p23) << "24 bits with sign";
      }
    }
  EXPECT_FALSE(std::signbit(to_grid(-1e-9F, -8)));
}

TEST_F(GlbCompression, DirectionsAreTheOctahedronsAndNearlyTheNearest) {
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = normalized(Vec3{any(random), any(random), any(random)});
    const std::array<float, 3> direction = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
    const std::array<float, 3> rounded = to_octahedron(direction);
    const Vec3 r{double{rounded[0]}, double{rounded[1]}, double{rounded[2]}};
    worst = std::max(worst, std::acos(std::clamp(dot(n, r), -1.0, 1.0)));
    EXPECT_EQ(to_octahedron(rounded), rounded);
    const double length = std::abs(r.x) + std::abs(r.y) + std::abs(r.z);
    for (const double x : {r.x, r.y, r.z}) EXPECT_NEAR(127 * x / length, std::round(127 * x / length), 1e-4);
  }
  const double degrees = worst * 180 / std::numbers::pi;
  EXPECT_LT(degrees, 0.64);
  EXPECT_GT(degrees, 0.5) << "the bound is not far from what happens";
}

TEST_F(GlbCompression, EveryCodecKeepsAllAttributesWithinTheirBounds) {
  const Scene scene = compressible_scene();
  GlbWriteOptions options;
  for (const auto& [name, coding] : k_codings) {
    SCOPED_TRACE(name);
    options.meshes = coding;
    const Scene back = written(scene, options);
    ASSERT_EQ(instances(back).size(), 2U);
    ASSERT_EQ(back.parts.size(), 1U);
    EXPECT_EQ(back.parts[0].materials.size(), 2U);
    for (const char* node : {"seat", "belt"}) {
      const Instance before = use_by(scene, node);
      const double size = std::cbrt(determinant(before.world));
      const auto here = corners_of(scene, before), there = corners_of(back, use_by(back, node));
      ASSERT_EQ(here.size(), there.size());
      double moved = 0;
      for (const auto& [number, corners] : here) {
        const auto rounded = turned_like(corners, there.at(number));
        for (std::size_t k = 0; k < 3; ++k) {
          moved = std::max(moved, norm(rounded[k].position - corners[k].position));
          EXPECT_LE(norm(rounded[k].uv - corners[k].uv) * k_texels, 0.1);
          EXPECT_LE(norm(rounded[k].uv1 - corners[k].uv1), 0.1 / 4096);
          EXPECT_LE(norm(rounded[k].cad_uv - corners[k].cad_uv), 1.5 * k_cad_range / 65536);
          EXPECT_GT(dot(rounded[k].normal, corners[k].normal), std::cos(1.0 * std::numbers::pi / 180));
        }
      }
      EXPECT_LE(moved, size * k_side_mm / 16384);
      EXPECT_GT(moved, 0) << "nothing was rounded";
    }
  }
}

/// Coordinates taller than wide, and pictures on the second ones.
TEST_F(GlbCompression, SecondCoordinatesAreAsExactAsTheirPicturesNeed) {
  Scene scene = compressible_scene();
  for (Material& material : scene.materials) {
    material.haptic->height->tex_coord = 1;
    for (auto* texture : {&material.base_color_texture, &material.normal_texture})
      if (*texture) (*texture)->tex_coord = 1;
  }
  for (TriangleMesh* mesh : {&scene.parts[0].mesh, &scene.parts[0].levels[0].mesh})
    for (std::size_t i = 0; i < mesh->uv.values.size(); ++i) {
      const Vec2 wide = mesh->uv.values[i];
      mesh->uv.values[i] = mesh->uv1.values[i];
      mesh->uv1.values[i] = {0.1 * wide.y, wide.x};
    }
  expect_second_uv_within(scene, 0.1 / k_texels);
}

/// 700 repeats along v and less than one along u: 22 bits hold them in steps of 1/4096.
TEST_F(GlbCompression, ManyRepeatsAlongVAloneAreKept) {
  Scene scene = compressible_scene();
  for (TriangleMesh* mesh : {&scene.parts[0].mesh, &scene.parts[0].levels[0].mesh})
    for (Vec2& uv : mesh->uv1.values) uv.y *= 700 / 0.9;
  expect_second_uv_within(scene, 1.0 / 4096);
}

/// Positions in the part's frame in millimetres and uv by the number of the triangle, as assimp reads a file.
std::map<long, std::array<std::pair<Vec3, Vec2>, 3>> read_by_assimp(const std::filesystem::path& file,
                                                                    const std::string& mesh_name) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (scene == nullptr) throw InvalidInput(importer.GetErrorString());
  std::map<long, std::array<std::pair<Vec3, Vec2>, 3>> result;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (!std::string(mesh.mName.C_Str()).starts_with(mesh_name) || mesh.mNumFaces < 10) continue;  // Not the level.
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      std::array<std::pair<Vec3, Vec2>, 3> corners;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned v = mesh.mFaces[f].mIndices[k];
        const aiVector3D &p = mesh.mVertices[v], &uv = mesh.mTextureCoords[0][v];
        corners[k] = {1e3 * Vec3{double{p.x}, double{p.y}, double{p.z}}, {double{uv.x}, double{uv.y}}};
      }
      result[std::lround(65535 * double{mesh.mColors[0][mesh.mFaces[f].mIndices[0]].r})] = corners;
    }
  }
  return result;
}

// An independent reader. assimp 5.2.5 refuses meshopt, and takes the whole numbers of quantize for floats.
TEST_F(GlbCompression, AssimpReadsWhatDracoPacks) {
  const Scene scene = compressible_scene();
  const auto whole = corners_of(scene, use_by(scene, "seat"));
  const TriangleMesh& mesh = scene.parts[0].mesh;
  for (const MeshCoding coding : {MeshCoding::none, MeshCoding::draco}) {
    GlbWriteOptions options;
    options.meshes = coding;
    write_glb(scene, folder_ / "a.glb", options);
    const auto read = read_by_assimp(folder_ / "a.glb", "patch");
    ASSERT_EQ(read.size(), whole.size());
    double moved = 0;
    for (const auto& [number, corners] : read) {
      const auto t = static_cast<std::size_t>(number - 1);
      for (const auto& [position, uv] : corners) {  // Codecs may begin a triangle with any corner.
        double nearest = k_side_mm, drift = 0;
        for (int k = 0; k < 3; ++k)
          if (const double distance = norm(position - mesh.corner(t, k)); distance < nearest) {
            nearest = distance;
            drift = norm(uv - mesh.uv.values[mesh.uv.indices[t][static_cast<std::size_t>(k)]]);
          }
        EXPECT_LE(drift * k_texels, 0.1);
        moved = std::max(moved, nearest);
      }
    }
    EXPECT_LE(moved, coding == MeshCoding::none ? 1e-5 : k_side_mm / 16384);
  }
}

TEST_F(GlbCompression, EveryCodecGivesTheSameVertices) {
  const Scene scene = compressible_scene();
  GlbWriteOptions options;
  options.meshes = MeshCoding::meshopt;
  const Scene first = written(scene, options);
  for (const MeshCoding coding : {MeshCoding::draco, MeshCoding::quantize}) {
    options.meshes = coding;
    const Scene other = written(scene, options);
    const auto a = corners_of(first, use_by(first, "seat")), b = corners_of(other, use_by(other, "seat"));
    for (const auto& [number, corners] : a) {
      const auto same = turned_like(corners, b.at(number));
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(norm(same[k].position - corners[k].position), 0, 1e-9);
        EXPECT_EQ(same[k].uv, corners[k].uv);
        EXPECT_EQ(same[k].uv1, corners[k].uv1);
        EXPECT_EQ(same[k].cad_uv, corners[k].cad_uv);
      }
    }
  }
}

TEST_F(GlbCompression, AsksForWhatReadersNeedAndCountsBytes) {
  const Scene scene = compressible_scene();
  const std::map<MeshCoding, json> needed = {
      {MeshCoding::meshopt, {"EXT_meshopt_compression", "KHR_mesh_quantization"}},
      {MeshCoding::draco, {"KHR_draco_mesh_compression"}},
      {MeshCoding::quantize, {"KHR_mesh_quantization"}}};
  GlbSizes plain;
  written(scene, {}, &plain);
  EXPECT_EQ(plain.meshes, plain.meshes_uncompressed);
  for (const auto& [coding, names] : needed) {
    GlbWriteOptions options;
    options.meshes = coding;
    GlbSizes sizes;
    written(scene, options, &sizes);
    const json document = document_of(folder_ / "a.glb");
    EXPECT_EQ(document["extensionsRequired"], names);
    for (const json& name : names)
      EXPECT_TRUE(std::count(document["extensionsUsed"].begin(), document["extensionsUsed"].end(), name));
    std::size_t stored = 0;
    for (const json& view : document["bufferViews"])
      stored += view.contains("extensions")
                    ? view["extensions"]["EXT_meshopt_compression"]["byteLength"].get<std::size_t>()
                    : view["byteLength"].get<std::size_t>();
    EXPECT_EQ(sizes.meshes + sizes.pictures, stored);
    EXPECT_LE(sizes.meshes_uncompressed, plain.meshes);
    EXPECT_LT(sizes.meshes, (coding == MeshCoding::quantize ? 0.8 : 0.5) * static_cast<double>(plain.meshes));
  }
}

TEST_F(GlbCompression, QuantizeKeepsNodesInstancesAndLevels) {
  const Scene scene = compressible_scene();
  GlbWriteOptions options;
  options.meshes = MeshCoding::quantize;
  const Scene back = written(scene, options);
  ASSERT_EQ(back.nodes.size(), 3U) << "the child that shows the levels of a node with children";
  EXPECT_EQ(back.parts.size(), 1U);
  const json document = document_of(folder_ / "a.glb");
  std::size_t levels = 0;
  for (const json& node : document["nodes"])
    if (node.contains("extensions") && node["extensions"].contains("MSFT_lod")) {
      ++levels;
      EXPECT_EQ(node["extras"]["MSFT_screencoverage"], json({0.1, 0}));
      // The level stands where its part does: its corners are those of the patch.
      const json& level = document["nodes"][node["extensions"]["MSFT_lod"]["ids"][0].get<std::size_t>()];
      const auto box = [&](const json& shown, const char* end) {
        const json& primitive = document["meshes"][shown["mesh"].get<std::size_t>()]["primitives"];
        double x = end[1] == 'i' ? 1e9 : -1e9;
        for (const json& one : primitive) {
          const double own = document["accessors"][one["attributes"]["POSITION"].get<std::size_t>()][end][0];
          x = end[1] == 'i' ? std::min(x, own) : std::max(x, own);
        }
        return x * shown["scale"][0].get<double>();
      };
      for (const char* end : {"min", "max"}) EXPECT_NEAR(box(node, end), box(level, end), 2e-5);
    }
  EXPECT_EQ(levels, 2U);
}

TEST_F(GlbCompression, APartTooLargeFor16BitsKeepsFloats) {
  Scene scene = compressible_scene();
  GlbWriteOptions options;
  options.meshes = MeshCoding::quantize;
  options.most_rounding_mm = 1e-3;  // 120 mm are 104,000 steps of it.
  written(scene, options);
  json document = document_of(folder_ / "a.glb");
  const auto position_type = [&] {
    return document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()]
                   ["componentType"]
                       .get<int>();
  };
  EXPECT_EQ(position_type(), 5126);
  options.most_rounding_mm = 0;
  for (Vec3& p : scene.parts[0].mesh.positions) p = 100.0 * p;  // 12 m
  written(scene, options);
  document = document_of(folder_ / "a.glb");
  EXPECT_EQ(position_type(), 5123) << "what is asked for by default always fits";
}

TEST_F(GlbCompression, PrecisionIsWhatIsAskedFor) {
  const Scene scene = compressible_scene();
  for (const double most : {1e-4, 0.05, 0.8}) {
    GlbWriteOptions options;
    options.meshes = MeshCoding::meshopt;
    options.most_rounding_mm = most;
    const Scene back = written(scene, options);
    double moved = 0;
    const auto here = corners_of(scene, use_by(scene, "seat")), there = corners_of(back, use_by(back, "seat"));
    for (const auto& [number, corners] : there) {
      const auto whole = turned_like(corners, here.at(number));
      for (std::size_t k = 0; k < 3; ++k) moved = std::max(moved, norm(whole[k].position - corners[k].position));
    }
    EXPECT_LE(moved, most);
    EXPECT_GT(moved, 0.2 * most);
  }
}

TEST_F(GlbCompression, SameSceneSameBytes) {
  const Scene scene = compressible_scene();
  for (const auto& [name, coding] : k_codings) {
    GlbWriteOptions options;
    options.meshes = coding;
    options.pictures = PictureCoding::webp;
    write_glb(scene, folder_ / "a.glb", options);
    write_glb(scene, folder_ / "b.glb", options);
    EXPECT_TRUE(content_of(folder_ / "a.glb") == content_of(folder_ / "b.glb")) << name;
  }
}

TEST_F(GlbCompression, ATriangleThatRoundingCollapsesIsLeftOut) {
  Scene scene = compressible_scene();
  GlbWriteOptions options;
  for (const auto& [name, coding] : k_codings) {
    SCOPED_TRACE(name);
    options.meshes = coding;
    options.most_rounding_mm = 8;  // Steps of 7.8 mm: the cells have 5 mm.
    const std::size_t left = written(scene, options).parts[0].mesh.triangles.size();
    EXPECT_GT(left, 0U);
    EXPECT_LT(left, scene.parts[0].mesh.triangles.size() / 2);
  }
  options.most_rounding_mm = 5000;
  EXPECT_TRUE(instances(written(scene, options)).empty() || written(scene, options).parts[0].mesh.triangles.empty());
}

TEST_F(GlbCompression, TheMaterialsOfAGrainShareItsHeightMap) {
  const Scene scene = compressible_scene();
  GlbSizes sizes;
  write_glb(scene, folder_ / "a.glb", {}, &sizes);
  EXPECT_EQ(sizes.tag_pictures.uses, 2U);
  EXPECT_EQ(sizes.tag_pictures.copies, 1U);
  EXPECT_EQ(sizes.tag_pictures.bytes, scene.materials[0].haptic->height->uri.size());
  const json document = document_of(folder_ / "a.glb");
  EXPECT_TRUE(document["materials"][0]["extras"]["haptic"]["height"].contains("uri"));
  EXPECT_FALSE(document["materials"][1]["extras"]["haptic"]["height"].contains("uri"));
  const HapticScene felt = load_haptic_scene(folder_ / "a.glb");
  EXPECT_TRUE(felt.warnings.empty());
  EXPECT_EQ(felt.heights.size(), 1U);
  EXPECT_EQ(felt.maps_loaded, 1);
  ASSERT_EQ(felt.materials.size(), 2U);
  EXPECT_EQ(felt.materials[0].height, felt.materials[1].height);
  // A scene that was read can lose any of its materials.
  Scene read = read_scene(folder_ / "a.glb");
  EXPECT_EQ(read.materials[1].haptic->height->uri, scene.materials[0].haptic->height->uri);
  read.materials[0].haptic.reset();
  write_glb(read, folder_ / "b.glb");
  EXPECT_EQ(load_haptic_scene(folder_ / "b.glb").maps_loaded, 1);
}

TEST_F(GlbCompression, GrainsThatDifferDoNotShare) {
  Scene scene = compressible_scene();
  scene.materials[1].haptic->height->scale_m = 1e-4;  // The same picture, half as high.
  write_glb(scene, folder_ / "a.glb");
  const HapticScene felt = load_haptic_scene(folder_ / "a.glb");
  EXPECT_EQ(felt.heights.size(), 2U);
  GlbSizes sizes;
  scene.materials[1].haptic->height->sha256 = std::string(64, 'b');
  write_glb(scene, folder_ / "a.glb", {}, &sizes);
  EXPECT_EQ(sizes.tag_pictures.copies, 2U);
}

/// Forces along a stroke over the patch without friction, 0.4 mm below its smooth surface. In the frame of the file.
std::vector<Vec3> forces_of(const std::filesystem::path& file, const Transform& world) {
  const HapticScene scene = load_haptic_scene(file);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0].warning.message;
  const ContactSurface surface(scene.mesh, scene.materials, scene.heights, scene.probe_radius_m, scene.channels);
  Proxy proxy(surface);
  std::vector<Vec3> forces;
  for (int i = 0; i <= 400; ++i) {
    const double u = 0.2 + 0.6 * i / 400, v = 0.37 + 0.2 * i / 400,
                 below = i == 0 ? -5 : 0.4 - scene.probe_radius_m * 1e3;
    const Vec3 place{40 + k_side_mm * u, 6 * std::sin(3 * u + 2 * v) - below, -k_side_mm * v};
    const Vec3 hand = 1e-3 * transform_point(world, place);
    if (i == 0) proxy.reset(hand);
    const ProxyState& state = proxy.update(hand, 1e-3);
    forces.push_back((state.constants.stiffness * state.load_m) * state.normal);
  }
  return forces;
}

TEST_F(GlbCompression, ForcesAreThoseOfTheFileWithoutCompression) {
  const Scene scene = compressible_scene();
  const Transform world = instances(scene)[0].world;
  write_glb(scene, folder_ / "plain.glb");
  const std::vector<Vec3> plain = forces_of(folder_ / "plain.glb", world);
  double largest = 0;
  for (const Vec3& force : plain) largest = std::max(largest, norm(force));
  ASSERT_GT(largest, 0.1);
  // A surface moved by e changes the force by k e, and by k s e where that moves its relief of slope s along it, as the
  // rounding of texture coordinates does by d.
  const double rounding_m = 1e-3 * k_side_mm / 16384, texel_m = 1e-3 * k_side_mm / k_repeats / k_texels;
  const double slope = 1e-4 * 4 * 2 * std::numbers::pi / (1e-3 * k_side_mm / k_repeats);  // Four waves a repeat.
  // Where the stroke leaves a facet the force turns by their angle, in one file a tick before the other: by the
  // curvature of the patch, at most 6 mm (3² + 2²) / side², over the diagonal of a cell.
  const double edge = 6 * 13 / (k_side_mm * k_side_mm) * std::sqrt(2) * k_side_mm / k_cells;
  const double bound = 600 * (rounding_m * (1 + slope) + slope * 0.1 * texel_m);
  for (const auto& [name, coding] : k_codings) {
    GlbWriteOptions options;
    options.meshes = coding;
    options.pictures = PictureCoding::webp;
    write_glb(scene, folder_ / "small.glb", options);
    const std::vector<Vec3> small = forces_of(folder_ / "small.glb", world);
    std::vector<double> differences;
    for (std::size_t i = 0; i < plain.size(); ++i) differences.push_back(norm(small[i] - plain[i]));
    std::sort(differences.begin(), differences.end());
    const double most = differences.back(), usual = differences[differences.size() * 9 / 10];
    EXPECT_LE(usual, bound) << name;
    EXPECT_LE(most, bound + edge * largest) << name;
    EXPECT_GT(most, 0);
    RecordProperty(name, std::to_string(most));
  }
}

TEST_F(GlbCompression, PicturesBecomeSmallerAndThoseOfTagsStay) {
  Scene scene = compressible_scene();
  EncodedImage of_tag = scene.images[0];
  of_tag.name = "haptic.height.grain";
  scene.images.push_back(of_tag);
  scene.materials[0].haptic->height->image = of_tag.name;
  for (const auto& [coding, type] :
       {std::pair{PictureCoding::webp, "image/webp"}, std::pair{PictureCoding::jpeg, "image/jpeg"}}) {
    GlbWriteOptions options;
    options.pictures = coding;
    GlbSizes sizes;
    const Scene back = written(scene, options, &sizes);
    ASSERT_EQ(back.images.size(), 2U);
    EXPECT_EQ(back.images[0].mime_type, type);
    EXPECT_EQ(back.images[1].bytes, of_tag.bytes);
    EXPECT_EQ(sizes.pictures, back.images[0].bytes.size() + of_tag.bytes.size());
    EXPECT_EQ(sizes.pictures_uncompressed, 2 * of_tag.bytes.size());
    EXPECT_LT(back.images[0].bytes.size(), of_tag.bytes.size() / 2);
    const json document = document_of(folder_ / "a.glb");
    const bool is_webp = coding == PictureCoding::webp;
    EXPECT_EQ(document.contains("extensionsRequired"), is_webp);
    if (is_webp) {
      EXPECT_EQ(document["textures"][0]["extensions"]["EXT_texture_webp"]["source"], 0);
      EXPECT_FALSE(document["textures"][0].contains("source"));
    }
    const std::filesystem::path picture = folder_ / (is_webp ? "a.webp" : "a.jpg");
    folder_.write(picture.filename(), std::string_view(reinterpret_cast<const char*>(back.images[0].bytes.data()),
                                                       back.images[0].bytes.size()));
    const ColorImage decoded = read_color_image(picture),
                     original = decode_color_image(scene.images[0].bytes, "original");
    ASSERT_EQ(decoded.pixels.size(), original.pixels.size());
    double squares = 0;
    for (std::size_t i = 0; i < decoded.pixels.size(); ++i)
      squares += std::pow(int{decoded.pixels[i]} - int{original.pixels[i]}, 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(decoded.pixels.size())), 3) << "of 255";
    // Written again as it is: nothing is coded twice.
    GlbSizes again;
    EXPECT_EQ(written(back, options, &again).images[0].bytes, back.images[0].bytes);
  }
}

TEST_F(GlbCompression, AlphaIsKept) {
  RgbaImage image{64, 64, {}};
  std::mt19937 random(1);
  for (int i = 0; i < 64 * 64; ++i)
    for (const unsigned long value : {random() % 256, random() % 256, random() % 256, i < 2048 ? 255UL : 64UL})
      image.pixels.push_back(static_cast<unsigned char>(value));
  Scene scene = compressible_scene();
  scene.images[0].bytes = encode_png(image);
  GlbWriteOptions options;
  options.pictures = PictureCoding::jpeg;
  EXPECT_EQ(written(scene, options).images[0].bytes, scene.images[0].bytes);
  options.pictures = PictureCoding::webp;
  const Scene back = written(scene, options);
  ASSERT_EQ(back.images[0].mime_type, "image/webp");
  folder_.write("a.webp", std::string_view(reinterpret_cast<const char*>(back.images[0].bytes.data()),
                                           back.images[0].bytes.size()));
  const RgbaImage decoded = read_rgba_image(folder_ / "a.webp");
  ASSERT_EQ(decoded.pixels.size(), image.pixels.size());
  for (std::size_t i = 3; i < decoded.pixels.size(); i += 4) ASSERT_EQ(decoded.pixels[i], image.pixels[i]);
}

TEST_F(GlbCompression, AGlbEndsWhere32BitsDo) {
  constexpr std::size_t k_most = std::numeric_limits<std::uint32_t>::max();
  // 12 bytes of header, 8 of each chunk's, and chunks of whole words: the longest is 2^32 − 4.
  EXPECT_EQ(glb_length("a.glb", 100, k_most - 131, 0), k_most - 3);
  EXPECT_EQ(glb_length("a.glb", 97, k_most - 131, 0), k_most - 3) << "padding counts";
  EXPECT_EQ(glb_length("a.glb", 100, 0, 0), 120U) << "no binary chunk";
  const std::string refusal = message_of<InvalidInput>([&] { glb_length("a.glb", 100, k_most - 130, 0); });
  EXPECT_EQ(refusal,
            "a.glb: 4294967296 bytes exceed the 4 GiB that a GLB can hold: write a .gltf, whose data lie in several "
            "files");
  const std::filesystem::path file = folder_ / "large.glb";
  EXPECT_THROW(write_glb_container(file, "{}", std::size_t{5} << 30, [](std::ostream&) { FAIL() << "nothing fits"; }),
               InvalidInput);
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(GlbCompression, LargeDataLieInSeveralFiles) {
  const Scene scene = compressible_scene();
  GlbWriteOptions options;
  options.largest_buffer = 60000;
  for (const MeshCoding coding : {MeshCoding::none, MeshCoding::meshopt, MeshCoding::quantize}) {
    options.meshes = coding;
    const std::filesystem::path folder = folder_ / std::to_string(static_cast<int>(coding));
    std::filesystem::create_directory(folder);
    write_gltf(scene, folder / "a.gltf", options);
    const json document = json::parse(content_of(folder / "a.gltf"));
    std::size_t files = 0, bytes = 0;
    for (const json& buffer : document["buffers"]) {
      if (!buffer.contains("uri")) continue;  // What is decoded of meshopt.
      ++files;
      const std::size_t size = std::filesystem::file_size(folder / buffer["uri"].get<std::string>());
      EXPECT_EQ(size, buffer["byteLength"].get<std::size_t>());
      EXPECT_LE(size, options.largest_buffer);
      bytes += size;
    }
    if (coding == MeshCoding::none) {
      EXPECT_GT(files, 2U);
      EXPECT_GT(bytes, 2 * options.largest_buffer);
    }
    GlbWriteOptions whole = options;
    whole.largest_buffer = GlbWriteOptions().largest_buffer;
    const Scene one = written(scene, whole), several = read_gltf(folder / "a.gltf", {.cad_uv = true});
    EXPECT_EQ(one.parts[0].mesh.positions, several.parts[0].mesh.positions);
    EXPECT_EQ(one.parts[0].mesh.uv.values, several.parts[0].mesh.uv.values);
    EXPECT_EQ(one.parts[0].mesh.triangles, several.parts[0].mesh.triangles);
  }
  options.largest_buffer = 1000;
  EXPECT_NE(
      message_of<InvalidInput>([&] { write_gltf(scene, folder_ / "b.gltf", options); }).find("more than the 1000"),
      std::string::npos);
}

}  // namespace
}  // namespace papilla
