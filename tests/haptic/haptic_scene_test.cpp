// SPDX-License-Identifier: MIT
#include "papilla/io/haptic_scene.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "haptic/grids_glb.hpp"
#include "haptic/tagged_glb.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/haptic/proxy.hpp"
#include "papilla/haptic/sha256.hpp"
#include "papilla/io/gltf_reader.hpp"

namespace papilla {
namespace {

nlohmann::json tag() {
  const std::string png = testing::sine_png();
  return {{"version", 1},
          {"stiffness", 300},
          {"height",
           {{"image", "haptic.height.grain"},
            {"sha256", sha256_hex(std::as_bytes(std::span(png.data(), png.size())))},
            {"scale", 2e-4},
            {"offset", -1e-4},
            {"metresPerUV", {0.04, 0.04}}}}};
}

class File {
 public:
  explicit File(const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }
  ~File() { std::filesystem::remove(path); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("papilla-scene-test-" + std::to_string(::getpid()) + ".glb");
};

TEST(HapticScene, LeavesOutWhatIsOutOfReach) {
  const File file(testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  const HapticScene all = load_haptic_scene(file.path);
  EXPECT_EQ(all.mesh.triangles.size(), 200U);
  EXPECT_EQ(all.triangles_out_of_reach, 0U);
  HapticSceneOptions options;
  options.reach_around = {{0.05, 0, -0.05}};
  options.reach_m = 0.02;
  const HapticScene near = load_haptic_scene(file.path, options);
  EXPECT_EQ(near.mesh.triangles.size() + near.triangles_out_of_reach, 200U);
  EXPECT_GT(near.mesh.triangles.size(), 20U);
  EXPECT_LT(near.mesh.triangles.size(), 60U);
  options.reach_around = {{5, 0, 0}};
  EXPECT_THROW(load_haptic_scene(file.path, options), InvalidInput);
}

/// Primitive by primitive and as a whole: the same surface. Turned, mirrored, scaled unevenly, oblong, rough.
TEST(HapticScene, FromAFileFeelsAsFromAScene) {
  nlohmann::json plain = {{"version", 2}, {"stiffness", 500}, {"forceShading", true}};
  const File file(testing::grids_glb(23, 41, {{"haptic", tag()}}, {{"haptic", plain}}, testing::sine_png()));
  const HapticScene by_primitive = load_haptic_scene(file.path);
  const HapticScene whole = haptic_scene(read_gltf(file.path, {.tag_channel = true}), file.path);
  EXPECT_TRUE(by_primitive.warnings.empty());
  EXPECT_EQ(by_primitive.mesh.triangles.size(), 3U * 2 * 2 * 23 * 41);
  EXPECT_EQ(whole.mesh.triangles.size(), by_primitive.mesh.triangles.size());
  EXPECT_EQ(by_primitive.names, whole.names);
  const auto surface = [](const HapticScene& scene) {
    return ContactSurface(scene.mesh, scene.materials, scene.heights, scene.probe_radius_m);
  };
  const ContactSurface a = surface(by_primitive), b = surface(whole);
  EXPECT_EQ(a.bytes(), b.bytes());
  EXPECT_NEAR(norm(a.low() - b.low()) + norm(a.high() - b.high()), 0, 1e-9);
  EXPECT_NEAR(a.tallest_relief_m(), b.tallest_relief_m(), 1e-9);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  int with_relief = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 size = a.high() - a.low();
    const Vec3 p = a.low() + Vec3{share(random) * size.x, share(random) * size.y, share(random) * size.z};
    const auto x = a.closest_point(p, 3), y = b.closest_point(p, 3);
    ASSERT_TRUE(x && y);
    ASSERT_NEAR(x->distance_m, y->distance_m, 1e-7);
    if (norm(x->point - y->point) > 1e-7 || x->material != y->material) continue;  // Two are equally near.
    EXPECT_NEAR(x->height_m, y->height_m, 1e-8);
    with_relief += x->height_m > 0;
    const Vec3 normal = x->face_normal;
    EXPECT_NEAR(norm(a.shaded_normal(x->point + a.contact_radius_m() * normal, normal) -
                     b.shaded_normal(y->point + b.contact_radius_m() * normal, normal)),
                0, 1e-3);
  }
  EXPECT_GT(with_relief, 500);
}

TEST(HapticScene, HalvesMapsThatTheRateCantCarry) {
  const File file(testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  HapticSceneOptions options;
  options.shortest_wave_m = 2e-3;  // Texels of 40/128 = 0.31 mm: 0.625 mm still carries 1.25 mm.
  const HapticScene scene = load_haptic_scene(file.path, options);
  EXPECT_EQ(scene.maps_coarsened, 1);
  ASSERT_EQ(scene.heights.size(), 1U);
  EXPECT_EQ(scene.heights[0].width(), 64);
  EXPECT_EQ(load_haptic_scene(file.path).heights[0].width(), 128);
}

/// The map has 128 × 4 texels, here of 2.5 by 0.31 mm.
nlohmann::json upright_tag() {
  nlohmann::json upright = tag();
  upright["height"]["metresPerUV"] = {0.32, 0.00125};
  return upright;
}

TEST(HapticScene, TheFinerSideOfATexelSaysWhatTheRateCanCarry) {
  const File file(testing::plate_glb({{"haptic", upright_tag()}}, testing::sine_png()));
  HapticSceneOptions options;
  options.shortest_wave_m = 2e-3;
  EXPECT_EQ(load_haptic_scene(file.path, options).maps_coarsened, 1);
}

/// A map repeated four times as often along v over a unit of uv four times as long: its texels are as large as before.
TEST(HapticScene, AnUnevenChangeOfScaleLeavesTexelsAsLargeAsTheyWere) {
  const File file(testing::plate_glb({{"haptic", upright_tag()}}, testing::sine_png()));
  Scene scene = read_gltf(file.path);
  TextureReference reference;
  reference.transform = UvTransform{{0, 0}, 0, {1, 4}};
  scene.materials[0].normal_texture = reference;
  HapticSceneOptions options;
  options.shortest_wave_m = 1e-3;  // Four texels are 1.25 mm.
  EXPECT_EQ(haptic_scene(scene, file.path, options).maps_coarsened, 0);
}

/// An oblique triangle with its own normal, turned about all axes, scaled unevenly and mirrored: that normal is its own
/// afterwards, too. Its relief lies on the second coordinates.
TEST(HapticScene, NormalsStayUprightAndTheSecondCoordinatesAreFelt) {
  const File file(testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  Scene scene = read_gltf(file.path);
  scene.materials[0].haptic->force_shading = true;
  scene.materials[0].haptic->height->tex_coord = 1;
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh = {};
  mesh.positions = {{10, 20, 30}, {50, 10, 40}, {20, 70, 10}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.values = {
      normalized(cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]))};
  mesh.normals.indices = {{0, 0, 0}};
  mesh.uv.values = {{0.1, 0.1}, {0.2, 0.1}, {0.1, 0.2}};
  mesh.uv.indices = mesh.uv1.indices = {{0, 1, 2}};
  mesh.uv1.values = {{0.7, 0.2}, {0.9, 0.3}, {0.8, 0.6}};
  for (const double side : {1.0, -1.0}) {
    // 2, 3 and 5 along axes turned by the quaternion (0.1, -0.5, 0.7, 0.5).
    scene.nodes[instances(scene)[0].node].local = {side * 2 * -0.48, 3 * -0.8, 5 * -0.36, 7,  //
                                                   side * 2 * 0.6,   3 * 0,    5 * -0.8,  8,  //
                                                   side * 2 * 0.64,  3 * -0.6, 5 * 0.48,  9, 0, 0, 0, 1};
    const HapticScene felt = haptic_scene(scene, file.path);
    ASSERT_EQ(felt.mesh.triangles.size(), 1U);
    const Vec3 a = felt.mesh.corner(0, 0);
    const Vec3 face = normalized(cross(felt.mesh.corner(0, 1) - a, felt.mesh.corner(0, 2) - a));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(norm(felt.mesh.normal(0, k) - face), 1e-6) << side;
    // As glTF counts them, v down; a mirrored triangle begins with its third corner.
    EXPECT_LT(norm(felt.mesh.uv(0, 0) - Vec2{0.7, 0.8}), 1e-12);
    EXPECT_LT(norm(felt.mesh.uv(0, side > 0 ? 1 : 2) - Vec2{0.9, 0.7}), 1e-12);
    EXPECT_LT(norm(felt.mesh.uv(0, side > 0 ? 2 : 1) - Vec2{0.8, 0.4}), 1e-12);
  }
}

/// A triangle whose corners have a normal each, in a copy that is mirrored along x.
TEST(HapticScene, AMirroredCopyHasEachNormalAtItsCorner) {
  const File file(testing::plate_glb({{"haptic", tag()}}, testing::sine_png()));
  Scene scene = read_gltf(file.path);
  scene.materials[0].haptic->force_shading = true;
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh = {};
  mesh.positions = {{10, 0, 0}, {50, 0, 0}, {10, 70, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals.values = {{0, 0, 1}, {0.6, 0, 0.8}, {0, 0.28, 0.96}};
  mesh.uv.values = {{0, 0}, {1, 0}, {0, 1}};
  mesh.normals.indices = mesh.uv.indices = {{0, 1, 2}};
  scene.nodes[instances(scene)[0].node].local = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const HapticScene felt = haptic_scene(scene, file.path);
  ASSERT_EQ(felt.mesh.triangles.size(), 1U);
  int found = 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = mesh.positions[i], n = mesh.normals.values[i];
      if (norm(felt.mesh.corner(0, k) - 1e-3 * Vec3{-p.x, p.y, p.z}) > 1e-9) continue;
      ++found;
      EXPECT_LT(norm(felt.mesh.normal(0, k) - Vec3{-n.x, n.y, n.z}), 1e-6) << i;
    }
  EXPECT_EQ(found, 3);
}

TEST(LargestMaterial, CentreIsTheMeanOverItsArea) {
  HapticScene scene;
  scene.materials.resize(2);
  scene.mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 2, 0}, {0, 0, 6}, {1, 0, 0}, {0, 1, 0}};
  scene.mesh.triangles = {{0, 4, 5}, {0, 1, 2}, {0, 2, 3}};
  scene.mesh.material = {0, 1, 1};
  const LargestMaterial found = largest_material(scene);
  EXPECT_EQ(found.material, 1U);
  // Areas of 4 and 6.
  const Vec3 expected = 0.1 * (4 * Vec3{4.0 / 3, 2.0 / 3, 0} + 6 * Vec3{0, 2.0 / 3, 2});
  EXPECT_LT(norm(found.centre - expected), 1e-12);
}

TEST(LargestMaterial, TrianglesWithoutNumbersHaveTheFirst) {
  HapticScene scene;
  scene.materials.resize(2);
  scene.mesh.positions = {{0, 0, 1}, {6, 0, 1}, {0, 3, 1}};
  scene.mesh.triangles = {{0, 1, 2}};
  const LargestMaterial found = largest_material(scene);
  EXPECT_EQ(found.material, 0U);
  EXPECT_LT(norm(found.centre - Vec3{2, 1, 1}), 1e-12);
}

TEST(HapticScene, LaysRoughnessOverTheMap) {
  nlohmann::json rough = tag();
  rough["version"] = 2;
  rough["roughness"] = {{"hurst", 0.4}, {"rms", 5e-6}, {"wavelength_range", {3e-4, 1e-3}}, {"overlay", true}};
  const File file(testing::plate_glb({{"haptic", rough}}, testing::sine_png()));
  const HapticScene felt = load_haptic_scene(file.path, {.probe_radius_m = 0, .felt_depth_m = 0});
  const HapticScene plain = load_haptic_scene(file.path, {.probe_radius_m = 0, .felt_depth_m = 0, .overlay = false});
  EXPECT_TRUE(felt.warnings.empty());
  EXPECT_EQ(felt.roughness_overlays, 1);
  EXPECT_EQ(plain.roughness_overlays, 0);
  EXPECT_EQ(plain.heights[0].width(), 128);
  EXPECT_GE(felt.heights[0].width(), 5 * 128);  // Texels of 0.31 mm: four to 0.3 mm need a fifth.
  const double rise = felt.heights[0].sample({0.3, 0.6}).height_m - plain.heights[0].sample({0.3, 0.6}).height_m;
  EXPECT_NE(rise, 0);
  EXPECT_LT(std::abs(rise), 3e-5);
}

/// The tag of the plate with maps of 4 x 1 texels: stiffness 100 to 400 N/m along u, friction the other way.
nlohmann::json mapped_tag() {
  std::vector<std::uint16_t> values;
  for (int i = 0; i < 4; ++i)
    for (const int v : {i * 21845, (3 - i) * 21845, 0}) values.push_back(static_cast<std::uint16_t>(v));
  const std::string png = testing::png16(4, 1, 3, values);
  const auto bytes = std::as_bytes(std::span(png.data(), png.size()));
  nlohmann::json mapped = tag();
  mapped["version"] = 2;
  mapped["staticFriction"] = 0.4, mapped["dynamicFriction"] = 0.2;
  mapped["backing"] = {{"stiffness", 1200}, {"depth", 5e-4}};
  mapped["maps"] = {{"uri", "data:image/png;base64," + encode_base64(bytes)},
                    {"sha256", sha256_hex(bytes)},
                    {"size", {4, 1}},
                    {"channels",
                     {{"r", {{"quantity", "stiffness"}, {"scale", 300}, {"offset", 100}}},
                      {"g", {{"quantity", "dynamic_friction"}, {"scale", 0.3}, {"offset", 0}}}}}};
  return mapped;
}

TEST(HapticScene, ReadsMapsAndBacking) {
  const File file(testing::plate_glb({{"haptic", mapped_tag()}}, testing::sine_png()));
  const HapticScene scene = load_haptic_scene(file.path);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0].warning.message;
  EXPECT_EQ(scene.channels_loaded, 1);
  EXPECT_EQ(scene.channels_missing, 0);
  ASSERT_EQ(scene.channels.size(), 1U);
  EXPECT_EQ(scene.materials[0].channels, 0U);
  EXPECT_EQ(scene.materials[0].backing_stiffness, 1200);
  EXPECT_EQ(scene.materials[0].backing_depth_m, 5e-4);
  for (int i = 0; i < 4; ++i) {
    ContactConstants there = scene.materials[0];
    scene.channels[0].apply({(i + 0.5) / 4, 0.5}, there);
    EXPECT_NEAR(there.stiffness, 100 * (i + 1), 0.01);
    EXPECT_NEAR(there.dynamic_friction, 0.1 * (3 - i), 1e-5);
    EXPECT_NEAR(there.static_friction, 0.2 * (3 - i), 1e-5);
  }
  // A place of the surface: 2.5 repeats over 0.1 m, so that u is 0.375 at 15 mm, on the second texel.
  const ContactSurface surface(scene.mesh, scene.materials, scene.heights, scene.probe_radius_m, scene.channels);
  Proxy proxy(surface);
  proxy.reset({0.015, 0.005, -0.05});
  proxy.update({0.015, -0.002, -0.05}, 1e-3);
  EXPECT_NEAR(proxy.state().constants.stiffness, 200, 25);
}

TEST(HapticScene, LostMapsLeaveTheConstants) {
  nlohmann::json other = mapped_tag(), torn = mapped_tag(), missing = mapped_tag();
  other["maps"]["sha256"] = std::string(64, '0');
  torn["maps"]["uri"] = "data:image/png;base64,AAAA";
  torn["maps"]["sha256"] = sha256_hex(std::as_bytes(std::span("\0\0\0", 3)));
  missing["maps"].erase("uri");
  missing["maps"]["image"] = "maps";
  for (const auto& [tagged, code] :
       {std::pair(other, "maps_sha256"), std::pair(torn, "maps_image"), std::pair(missing, "maps_image")}) {
    const File file(testing::plate_glb({{"haptic", tagged}}, testing::sine_png()));
    const HapticScene scene = load_haptic_scene(file.path);
    EXPECT_EQ(scene.channels_missing, 1);
    EXPECT_TRUE(scene.channels.empty());
    EXPECT_FALSE(scene.materials[0].channels);
    EXPECT_EQ(scene.materials[0].stiffness, 300);
    ASSERT_EQ(scene.warnings.size(), 2U);
    EXPECT_EQ(scene.warnings[0].warning.code, code);
    EXPECT_EQ(scene.warnings[1].warning.code, "maps_lost");
  }
}

TEST(HapticScene, MapsFollowTheTextureTransformOfPackers) {
  const Scene before = [&] {
    const File file(testing::plate_glb({{"haptic", mapped_tag()}}, testing::sine_png()));
    return read_gltf(file.path);
  }();
  Scene packed = before;
  TextureReference reference;
  reference.transform = UvTransform{{0, 0}, 0, {16, 16}};
  packed.materials[0].normal_texture = reference;
  const HapticScene plain = haptic_scene(before, "a.glb"), moved = haptic_scene(packed, "a.glb");
  for (const Vec2 uv : {Vec2{0.3, 0.2}, Vec2{1.7, -0.4}}) {
    ContactConstants one, other;
    plain.channels[0].apply(uv, one);
    moved.channels[0].apply((1.0 / 16) * uv, other);
    EXPECT_NEAR(one.stiffness, other.stiffness, 1e-9);
  }
}

TEST(HapticScene, FollowsTheTextureTransformOfPackers) {
  // As gltfpack: coordinates are scaled down, the transform of the texture scales them up, the tag is unchanged.
  std::string glb = testing::plate_glb({{"haptic", tag()}}, testing::sine_png());
  const Scene before = [&] {
    const File file(glb);
    return read_gltf(file.path);
  }();
  Scene scene = before;
  TextureReference reference;
  reference.transform = UvTransform{{0, 0}, 0, {16, 16}};
  scene.materials[0].normal_texture = reference;
  const HapticSceneOptions raw{.probe_radius_m = 0, .felt_depth_m = 0};
  const HapticScene plain = haptic_scene(before, "a.glb", raw), packed = haptic_scene(scene, "a.glb", raw);
  ASSERT_EQ(packed.warnings.size(), 1U);
  EXPECT_EQ(packed.warnings[0].warning.code, "uv_transform");
  for (const Vec2 uv : {Vec2{0.3, 0.2}, Vec2{1.7, -0.4}})
    EXPECT_NEAR(packed.heights[0].sample((1.0 / 16) * uv).height_m, plain.heights[0].sample(uv).height_m, 1e-12);
}

}  // namespace
}  // namespace papilla
