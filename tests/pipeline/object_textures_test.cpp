// SPDX-License-Identifier: MIT
#include "papilla/pipeline/object_textures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "object_textures/box_clip.hpp"
#include "object_textures/carrier_frame.hpp"
#include "object_textures/part_picture.hpp"
#include "object_textures/shown_picture.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/environment.hpp"

namespace papilla {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr Vec3 k_down{0, 0, -1}, k_north{0, 1, 0};

ProjectorBox box_at(Vec3 at, Vec3 direction, Vec3 up, double width, double height, double depth) {
  return {at, direction, up, width, height, depth};
}

/// n × n squares over [0, side]² at z = 0, upwards, split along alternating diagonals.
TriangleMesh plane(Index n, double side) {
  TriangleMesh mesh;
  for (Index y = 0; y <= n; ++y)
    for (Index x = 0; x <= n; ++x) mesh.positions.push_back({side * x / n, side * y / n, 0});
  for (Index y = 0; y < n; ++y)
    for (Index x = 0; x < n; ++x) {
      const Index a = y * (n + 1) + x, b = a + n + 1;
      if ((x + y) % 2 == 0)
        mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
      else
        mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, b}, {a + 1, b + 1, b}});
    }
  return mesh;
}

/// Upright cylinder of radius r, n facets, h high, with smooth normals.
TriangleMesh cylinder(Index n, double r, double h) {
  TriangleMesh mesh;
  for (Index i = 0; i < n; ++i) {
    const double a = 2 * k_pi * i / n;
    for (const double z : {0.0, h}) {
      mesh.positions.push_back({r * std::cos(a), r * std::sin(a), z});
      mesh.normals.values.push_back({std::cos(a), std::sin(a), 0});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const Index a = 2 * i, b = 2 * ((i + 1) % n);
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
  }
  mesh.normals.indices = mesh.triangles;
  return mesh;
}

TriangleMesh cube(double side) {
  TriangleMesh mesh;
  for (const double z : {0.0, side})
    for (const double y : {0.0, side})
      for (const double x : {0.0, side}) mesh.positions.push_back({x, y, z});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

DecalPatch cut(const TriangleMesh& mesh, const ProjectorBox& box, double angle = 75, double offset = 0,
               const Transform& world = k_identity) {
  return cut_decal(mesh, {0}, world, BoxFrame(box), angle, offset);
}

double uv_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.uv.indices)
    area += 0.5 * cross(mesh.uv.values[t[1]] - mesh.uv.values[t[0]], mesh.uv.values[t[2]] - mesh.uv.values[t[0]]);
  return area;
}

/// Length of the edges of one triangle.
double border_length(const TriangleMesh& mesh) {
  std::map<std::pair<Index, Index>, int> uses;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  double length = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_LE(count, 2);
    if (count == 1) length += norm(mesh.positions[edge.first] - mesh.positions[edge.second]);
  }
  return length;
}

TEST(CutDecal, OfAPlaneIsTheRectangle) {
  for (const Index n : {1U, 7U, 23U}) {
    const DecalPatch patch = cut(plane(n, 100), box_at({47, 52, 0}, k_down, k_north, 31, 17, 10));
    EXPECT_NEAR(patch.area_mm2, 31 * 17, 1e-9);
    EXPECT_NEAR(uv_area(patch.mesh), 1, 1e-12);                        // Not mirrored: seen from above, u to the right.
    EXPECT_NEAR(border_length(patch.mesh), 2 * (31 + 17), 1e-9) << n;  // One piece without gaps within.
    EXPECT_EQ(patch.turned_off, 0U);
  }
}

TEST(CutDecal, HasExactUvAtItsCorners) {
  const DecalPatch patch = cut(plane(9, 100), box_at({47, 52, 0}, k_down, k_north, 31, 17, 10));
  const auto uv_at = [&](double x, double y) {
    for (std::size_t i = 0; i < patch.mesh.positions.size(); ++i)
      if (norm(patch.mesh.positions[i] - Vec3{x, y, 0}) < 1e-9) return patch.mesh.uv.values[i];
    return Vec2{-1, -1};
  };
  EXPECT_EQ(uv_at(47 - 15.5, 52 - 8.5), (Vec2{0, 0}));
  EXPECT_EQ(uv_at(47 + 15.5, 52 - 8.5), (Vec2{1, 0}));
  EXPECT_EQ(uv_at(47 + 15.5, 52 + 8.5), (Vec2{1, 1}));
  EXPECT_EQ(uv_at(47 - 15.5, 52 + 8.5), (Vec2{0, 1}));
}

TEST(CutDecal, GoesAroundACylinderByItsArc) {
  const double r = 20, w = 24;
  const Index n = 720;
  const DecalPatch patch = cut(cylinder(n, r, 50), box_at({r, 0, 25}, {-1, 0, 0}, {0, 0, 1}, w, 10, 20));
  // The facets' share of the arc 2·asin(w / 2r) is that of a polygon of 720 sides.
  EXPECT_NEAR(patch.area_mm2, 2 * r * std::asin(w / (2 * r)) * 10, 1e-3 * w * 10);
  EXPECT_NEAR(uv_area(patch.mesh), 1, 1e-12);  // Its projection covers the picture.
  for (std::size_t i = 0; i < patch.mesh.positions.size(); ++i)
    EXPECT_NEAR(patch.mesh.uv.values[i].x, 0.5 + patch.mesh.positions[i].y / w, 1e-12);
  EXPECT_EQ(patch.mesh.normals.indices.size(), patch.mesh.triangles.size());
  for (std::size_t t = 0; t < patch.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = patch.mesh.positions[patch.mesh.triangles[t][k]];
      EXPECT_LT(norm(patch.mesh.normals.values[patch.mesh.normals.indices[t][k]] - normalized(Vec3{p.x, p.y, 0})),
                1e-4);
    }
}

TEST(CutDecal, IsContinuousOverACylinder) {
  const DecalPatch patch = cut(cylinder(37, 20, 50), box_at({20, 0, 25}, {-1, 0.2, 0.3}, {0, 0, 1}, 24, 10, 60));
  std::set<Vec3> places(patch.mesh.positions.begin(), patch.mesh.positions.end());
  EXPECT_EQ(places.size(), patch.mesh.positions.size());  // A place is one vertex with one uv, bit for bit.
  // The border is the four sides of the picture: its uv lie on them.
  std::map<std::pair<Index, Index>, int> uses;
  for (const Triangle& t : patch.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  for (const auto& [edge, count] : uses) {
    if (count != 1) continue;
    const Vec2 a = patch.mesh.uv.values[edge.first], b = patch.mesh.uv.values[edge.second];
    EXPECT_TRUE((a.x == b.x && (a.x == 0 || a.x == 1)) || (a.y == b.y && (a.y == 0 || a.y == 1)));
  }
}

TEST(CutDecal, FoldsOverACubesCorner) {
  // Down the diagonal every face is turned by acos(1/√3), so that what is seen through the box is its area times √3.
  const double s = 6;
  const ProjectorBox box = box_at({10, 10, 10}, {-1, -1, -1}, {0, 0, 1}, s, s, 20);
  const DecalPatch patch = cut(cube(10), box);
  EXPECT_NEAR(patch.area_mm2, std::sqrt(3.0) * s * s, 1e-9);
  EXPECT_NEAR(uv_area(patch.mesh), 1, 1e-12);
  EXPECT_EQ(cut(cube(10), box, 54).mesh.triangles.size(), 0U);  // acos(1/√3) is 54.7°.
  EXPECT_GT(cut(cube(10), box, 55).mesh.triangles.size(), 0U);
}

TEST(CutDecal, LeavesBacksAndWhatIsDeeper) {
  const TriangleMesh mesh = cube(10);
  const DecalPatch top = cut(mesh, box_at({5, 5, 10}, k_down, k_north, 4, 4, 40));
  EXPECT_NEAR(top.area_mm2, 16, 1e-12);  // The bottom looks away.
  EXPECT_EQ(top.turned_off, 2U);
  EXPECT_EQ(cut(mesh, box_at({5, 5, 13}, k_down, k_north, 4, 4, 4)).mesh.triangles.size(), 0U);
}

TEST(CutDecal, FollowsTheUse) {
  // A quarter turn about z, a factor of 2 and a shift; mirrored along x.
  const Transform world{0, -2, 0, 30, -2, 0, 0, 40, 0, 0, 2, 50, 0, 0, 0, 1};
  ASSERT_LT(determinant(world), 0);
  const TriangleMesh mesh = plane(5, 20);  // Still looks up: glTF turns the sense of triangles that are mirrored.
  const ProjectorBox box = box_at({10, 20, 50}, k_down, k_north, 8, 6, 4);
  const DecalPatch patch = cut(mesh, box, 75, 0.5, world);
  EXPECT_NEAR(patch.area_mm2, 48, 1e-9);
  for (std::size_t i = 0; i < patch.mesh.positions.size(); ++i) {
    const Vec3 p = transform_point(world, patch.mesh.positions[i]);
    EXPECT_NEAR(p.z, 50.5, 1e-12);
    EXPECT_NEAR(patch.mesh.uv.values[i].x, 0.5 + (p.x - 10) / 8, 1e-12);
    EXPECT_NEAR(patch.mesh.uv.values[i].y, 0.5 + (p.y - 20) / 6, 1e-12);
  }
}

TEST(ProjectorAxes, RefuseADirectionAlongUp) {
  EXPECT_THROW(projector_axes({0, 0, 2}, {0, 0, -1}), InvalidInput);
  EXPECT_THROW(projector_axes({}, {0, 0, -1}), InvalidInput);
}

std::vector<Index> all_of(const TriangleMesh& mesh) {
  std::vector<Index> all(mesh.triangles.size());
  for (Index t = 0; t < all.size(); ++t) all[t] = t;
  return all;
}

TEST(FitCarrier, FindsThePlaneOfAPlate) {
  // A plate of 30 × 12 mm that leans: its plane, size and front are known.
  const Vec3 right = normalized({1, 0.3, 0}), normal = normalized(cross(right, Vec3{0.1, 0.2, 1}));
  const Vec3 up = cross(normal, right);
  TriangleMesh mesh = plane(4, 1);
  for (Vec3& p : mesh.positions) p = Vec3{5, 6, 7} + 30 * p.x * right + 12 * p.y * up;
  const CarrierFrame frame = fit_carrier(mesh, all_of(mesh), {std::nullopt, up, {}});
  EXPECT_LT(norm(frame.axes.forward + normal), 1e-9);
  EXPECT_LT(norm(frame.axes.up - up), 1e-9);
  EXPECT_NEAR(frame.width_mm, 30, 1e-9);
  EXPECT_NEAR(frame.height_mm, 12, 1e-9);
  EXPECT_LT(norm(frame.middle - (Vec3{5, 6, 7} + 15 * right + 6 * up)), 1e-9);
}

TEST(FitCarrier, TurnsAClosedBodyToWhereItIsSeenFrom) {
  TriangleMesh mesh = cube(1);
  for (Vec3& p : mesh.positions) p = {20 * p.x, 10 * p.y, 2 * p.z};
  for (const double z : {-50.0, 50.0}) {
    const CarrierFrame frame = fit_carrier(mesh, all_of(mesh), {std::nullopt, k_north, {10, 5, z}});
    EXPECT_NEAR(frame.axes.forward.z, z > 0 ? -1 : 1, 1e-12);
    EXPECT_LT(norm(frame.middle - Vec3{10, 5, 1}), 1e-12);
    EXPECT_NEAR(frame.width_mm, 20, 1e-12);
    EXPECT_NEAR(frame.height_mm, 10, 1e-12);
  }
}

TEST(CarrierMesh, LooksAgainstTheProjection) {
  const TriangleMesh mesh = carrier_mesh({{1, 2, 3}, projector_axes(k_down, k_north), 4, 2});
  ASSERT_EQ(mesh.triangles.size(), 2U);
  for (std::size_t t = 0; t < 2; ++t)
    EXPECT_EQ(normalized(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0))),
              (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh.positions[0], (Vec3{-1, 1, 3}));
  EXPECT_NEAR(uv_area(mesh), 1, 1e-15);
}

/// A step of 2 mm: red below on the left half, green on top on the right.
Scene step_scene() {
  Part part;
  part.name = "step";
  part.mesh.positions = {{0, 0, 0}, {5, 0, 0}, {5, 10, 0}, {0, 10, 0}, {5, 0, 2}, {10, 0, 2}, {10, 10, 2}, {5, 10, 2}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  part.mesh.material = {0, 0, 1, 1};
  part.materials = {0, 1};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.materials.resize(2);
  scene.materials[0].base_color = {1, 0, 0, 1};
  scene.materials[1].base_color = {0, 1, 0, 1};
  scene.materials[0].name = "red", scene.materials[1].name = "green";
  return scene;
}

TEST(PictureOfPart, HasColourHeightAndNormals) {
  const Scene scene = step_scene();
  Pyramids pyramids(scene);
  const Part& part = scene.parts[0];
  const CarrierFrame frame{{5, 5, 1}, projector_axes(k_down, k_north), 12, 10};  // 1 mm free on both sides.
  const PartPicture picture =
      picture_of_part(scene, pyramids, part.mesh, all_of(part.mesh), part.materials, frame, 120);
  ASSERT_EQ(picture.color.width, 120);
  ASSERT_EQ(picture.color.height, 100);
  const auto pixel = [&](int x) { return picture.color.at(x, 50); };
  EXPECT_EQ(pixel(5)[3], 0);
  EXPECT_EQ(pixel(114)[3], 0);
  EXPECT_EQ(pixel(9)[0], 255);  // The colour goes on beyond the edge, where it is transparent.
  EXPECT_TRUE(pixel(30)[0] == 255 && pixel(30)[1] == 0 && pixel(30)[3] == 255);
  EXPECT_TRUE(pixel(90)[0] == 0 && pixel(90)[1] == 255 && pixel(90)[3] == 255);
  EXPECT_NEAR(static_cast<double>(picture.relief.at(30, 50)), -1, 1e-6);
  EXPECT_NEAR(static_cast<double>(picture.relief.at(90, 50)), 1, 1e-6);
  EXPECT_NEAR(static_cast<double>(picture.relief.at(2, 50)), -1, 1e-6);  // Nothing: as low as the lowest.
  EXPECT_NEAR(picture.relief.pitch_mm_x, 0.1, 1e-12);
  EXPECT_EQ(picture.normals.pixels[3 * (50 * 120 + 30) + 2], 255);
}

TEST(PictureOfPart, ShowsTheSlopeOfTheGeometry) {
  Scene scene = step_scene();
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 10}, {10, 10, 10}, {0, 10, 0}};  // Rises to the right by 45°.
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material = {0, 0};
  Pyramids pyramids(scene);
  const CarrierFrame frame{{5, 5, 5}, projector_axes(k_down, k_north), 10, 10};
  const PartPicture picture = picture_of_part(scene, pyramids, mesh, all_of(mesh), {0, 1}, frame, 32);
  const unsigned char* n = &picture.normals.pixels[3 * (16 * 32 + 16)];
  EXPECT_EQ(n[0], std::lround(255 * 0.5 * (1 - std::sqrt(0.5))));
  EXPECT_EQ(n[1], std::lround(255 * 0.5));
  EXPECT_EQ(n[2], std::lround(255 * 0.5 * (1 + std::sqrt(0.5))));
}

class ObjectTexturesTest : public testing::Test {
 protected:
  ObjectTexturesTest() {
    // Opaque red left of the middle, transparent right of it.
    RgbaImage image{8, 4, {}};
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x)
        image.pixels.insert(image.pixels.end(), {255, 0, 0, static_cast<unsigned char>(x < 4 ? 255 : 0)});
    const std::vector<std::byte> png = encode_png(image);
    write_atomically(picture_, {reinterpret_cast<const char*>(png.data()), png.size()});
  }

  /// A plate of `n`² squares of 100 mm with a material, used twice, 200 mm apart.
  static Scene plates(Index n) {
    Part part;
    part.name = "plate";
    part.mesh = plane(n, 100);
    part.materials = {0};
    Scene scene = single_part_scene(std::move(part), "test");
    scene.nodes[0].name = "left";
    scene.nodes.push_back(scene.nodes[0]);
    scene.nodes[1].name = "right";
    scene.nodes[1].local[3] = 200;
    scene.roots = {0, 1};
    scene.materials.resize(1);
    scene.materials[0].name = "skin";
    scene.materials[0].roughness = 0.7;
    assign_part_ids(scene);
    return scene;
  }

  DecalRule decal() const {
    DecalRule rule;
    rule.name = "logo";
    rule.picture = picture_;
    rule.box = box_at({50, 50, 0}, k_down, k_north, 40, 20, 5);
    rule.offset_mm = 0.1;
    return rule;
  }

  static ObjectTextures apply(Scene& scene, const Materials& rules, const ObjectTextureOptions& options = {}) {
    return apply_object_textures(scene, rules, find_object_textures(scene, rules), options);
  }

  static std::size_t drawn(const Scene& scene) {
    std::size_t triangles = 0;
    for (const Instance& use : instances(scene)) triangles += scene.parts[use.part].mesh.triangles.size();
    return triangles;
  }

  const TemporaryFolder folder_{"papilla-object-textures"};
  const std::filesystem::path picture_ = folder_.path() / "logo.png";
};

TEST_F(ObjectTexturesTest, PutsADecalBelowTheNodeThatShowsTheSurface) {
  Scene scene = plates(4);
  Materials rules;
  rules.decals = {decal()};
  const ObjectTextures made = apply(scene, rules);
  ASSERT_EQ(made.decals.size(), 1U);
  EXPECT_EQ(made.decals[0].surfaces, 1U);  // The other use is 200 mm away.
  EXPECT_NEAR(made.decals[0].area_mm2, 800, 1e-9);
  EXPECT_EQ(made.mm_per_uv, (std::vector<Vec2>{{40, 20}}));
  ASSERT_EQ(scene.nodes[0].children.size(), 1U);
  EXPECT_TRUE(scene.nodes[1].children.empty());
  const Part& part = scene.parts[scene.nodes[scene.nodes[0].children[0]].part.value()];
  EXPECT_EQ(part.name, "logo");
  for (const Vec3& p : part.mesh.positions) EXPECT_NEAR(p.z, 0.1, 1e-12);
  const Material& material = scene.materials[part.materials.at(0)];
  EXPECT_EQ(material.alpha_mode, "MASK");
  EXPECT_EQ(material.roughness, 0.7);
  EXPECT_FALSE(material.haptic);  // It is only seen: what is below is felt.
  const Texture& texture = scene.textures[material.base_color_texture->texture];
  EXPECT_EQ(texture.wrap_s, 33071);
  EXPECT_TRUE(has_alpha(decode_rgba_image(scene, texture.image.value())));
}

TEST_F(ObjectTexturesTest, RaisesTheReliefFromTheSurfaceBelow) {
  Scene scene = plates(1);
  Materials rules;
  rules.decals = {decal()};
  ObjectRelief& relief = rules.decals[0].height.emplace();
  relief.depth_mm = 0.6, relief.max_slope = 100;
  ObjectTextureOptions options;
  options.constants = [](std::uint32_t, std::uint32_t) {
    MaterialTag tag;
    tag.stiffness = 777;
    return std::optional(tag);
  };
  const ObjectTextures made = apply(scene, rules, options);
  EXPECT_NEAR(made.decals[0].relief_mm, 0.6, 1e-6);
  const Material& material = scene.materials.back();
  ASSERT_TRUE(material.haptic && material.haptic->height);
  EXPECT_EQ(material.haptic->stiffness, 777);
  const HeightTag& height = *material.haptic->height;
  EXPECT_NEAR(height.offset_m, -0.1e-3, 1e-9);  // The picture is 0.1 mm above what its lowest place is level with.
  EXPECT_NEAR(height.scale_m, 0.6e-3, 1e-9);
  EXPECT_EQ(height.wrap, (std::array{Wrap::clamp, Wrap::clamp}));
  EXPECT_NEAR(height.metres_per_uv.x, 0.04, 1e-12);
  EXPECT_TRUE(material.normal_texture);
}

TEST_F(ObjectTexturesTest, KeepsUnfeltSurfacesUnfeltUnlessTheirPictureHasRelief) {
  ObjectTextureOptions options;
  options.constants = [](std::uint32_t, std::uint32_t) { return std::optional<MaterialTag>(); };
  Materials rules;
  rules.decals = {decal()};
  rules.decals[0].height.emplace().depth_mm = 0.6;
  CarrierRule rule;
  rule.name = "picture";
  rule.node = "right";
  rule.picture = picture_;
  rules.replace = {rule};
  Scene scene = plates(1);
  apply(scene, rules, options);
  const auto material_at = [&](std::uint32_t node) -> const Material& {
    return scene.materials[scene.parts[scene.nodes[node].part.value()].materials.at(0)];
  };
  EXPECT_FALSE(material_at(1).haptic);
  EXPECT_TRUE(material_at(scene.nodes[0].children.at(0)).haptic);
}

TEST_F(ObjectTexturesTest, TellsPicturesOfOneNameApart) {
  Scene scene = plates(1);
  Materials rules;
  rules.decals = {decal(), decal()};
  rules.decals[1].box.at.x = 40;
  rules.decals[1].box.width_mm = 20;
  rules.decals[0].height.emplace().depth_mm = 0.1;
  rules.decals[1].height.emplace().depth_mm = 0.1;
  apply(scene, rules);
  ASSERT_EQ(scene.images.size(), 4U);
  EXPECT_NE(scene.images[1].bytes, scene.images[3].bytes);  // Steeper where it is narrower.
}

TEST_F(ObjectTexturesTest, PushesOutByAShareOfTheScene) {
  Scene scene = plates(1);
  Materials rules;
  rules.decals = {decal()};
  rules.decals[0].offset_mm.reset();
  EXPECT_NEAR(apply(scene, rules).decals[0].offset_mm, 1e-4 * std::hypot(300, 100), 1e-12);
}

TEST_F(ObjectTexturesTest, SaysWhyADecalIsNowhere) {
  for (const auto& [direction, reason] : {std::pair{Vec3{0, 0, 1}, "turned away"}, {Vec3{1, 0, 0}, "turned away"}}) {
    Scene scene = plates(1);
    Materials rules;
    rules.decals = {decal()};
    rules.decals[0].box.direction = direction;
    apply(scene, rules);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find(reason), std::string::npos) << scene.warnings[0];
  }
  Scene scene = plates(1);
  Materials rules;
  rules.decals = {decal()};
  rules.decals[0].box.at = {50, 50, 900};
  apply(scene, rules);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("lies in its box"), std::string::npos);
  rules.decals[0].part = "plato";
  EXPECT_NE(find_object_textures(scene, rules).decal_uses[0].problem.find("did you mean 'plate'"), std::string::npos);
}

TEST_F(ObjectTexturesTest, NamesTheRuleWhosePictureIsMissing) {
  Scene scene = plates(1);
  Materials rules;
  rules.source = "m.json";
  rules.decals = {decal()};
  rules.decals[0].picture = folder_.path() / "none.png";
  try {
    apply(scene, rules);
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("m.json: /decals/0 'logo': "), std::string::npos) << error.what();
  }
}

TEST_F(ObjectTexturesTest, ReplacesEveryUseByTwoTriangles) {
  Scene scene = plates(10);
  Materials rules;
  CarrierRule rule;
  rule.name = "plate picture";
  rule.part = "plate";
  rule.picture = picture_;
  rules.replace = {rule};
  const std::size_t before = drawn(scene);
  const ObjectTextures made = apply(scene, rules);
  ASSERT_EQ(made.carriers.size(), 1U);
  EXPECT_EQ(made.carriers[0].triangles, 400U);
  EXPECT_EQ(made.carriers[0].carriers, 2U);
  EXPECT_EQ(made.carriers[0].saved(), 396);
  EXPECT_EQ(before - drawn(scene), 396U);
  EXPECT_EQ(scene.nodes[0].part, scene.nodes[1].part);  // Instances share a carrier.
  const Part& part = scene.parts[scene.nodes[0].part.value()];
  Vec3 low{1e9, 1e9, 1e9}, high = -low;
  for (const Vec3& p : part.mesh.positions)
    low = {std::min(low.x, p.x), std::min(low.y, p.y), 0}, high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
  EXPECT_NEAR(high.x - low.x, 100, 1e-9);
  EXPECT_NEAR(high.y - low.y, 100, 1e-9);
  EXPECT_TRUE(scene.parts[0].mesh.triangles.empty());
  Scene planned = plates(10);
  EXPECT_EQ(apply(planned, rules, {.pictures = false, .constants = {}}).carriers[0].saved(), 396);
}

TEST_F(ObjectTexturesTest, ReplacesAMarkedRegionOfOneUse) {
  Scene scene = plates(10);
  Materials rules;
  CarrierRule rule;
  rule.name = "badge";
  rule.picture = picture_;
  rule.box = box_at({250, 50, 0.5}, k_down, k_north, 40.001, 20.001, 4);  // 4 × 2 squares of the right plate.
  rules.replace = {rule};
  const ObjectTextures made = apply(scene, rules);
  EXPECT_EQ(made.carriers[0].triangles, 16U);
  EXPECT_EQ(made.carriers[0].carriers, 1U);
  EXPECT_EQ(drawn(scene), 400U - 16U + 2U);
  EXPECT_EQ(scene.parts[scene.nodes[0].part.value()].mesh.triangles.size(), 200U);
  EXPECT_EQ(scene.parts[scene.nodes[1].part.value()].mesh.triangles.size(), 184U);
  ASSERT_EQ(scene.roots.size(), 3U);
  const Part& carrier = scene.parts[scene.nodes[scene.roots[2]].part.value()];
  for (const Vec3& p : carrier.mesh.positions) EXPECT_NEAR(p.z, 0.5, 1e-12);
}

TEST_F(ObjectTexturesTest, RendersAPartOntoItsCarrier) {
  Scene scene = step_scene();
  Materials rules;
  CarrierRule rule;
  rule.name = "step picture";
  rule.part = "step";
  rule.direction = k_down;
  rule.up = k_north;
  rule.pixels = 64;
  rules.replace = {rule};
  const ObjectTextures made = apply(scene, rules);
  EXPECT_EQ(made.carriers[0].saved(), 2);
  const Material& material = scene.materials.back();
  EXPECT_EQ(material.alpha_mode, "OPAQUE");
  const RgbaImage picture = decode_rgba_image(scene, *scene.textures[material.base_color_texture->texture].image);
  EXPECT_EQ(picture.at(10, 30)[0], 255);
  EXPECT_EQ(picture.at(54, 30)[1], 255);
  ASSERT_TRUE(material.haptic && material.haptic->height && material.normal_texture);
  EXPECT_GT(made.carriers[0].relief_mm, 1);  // Of 2 mm, less what the slope limit rounds off.
  EXPECT_LE(made.carriers[0].relief_mm, 2 + 1e-3);
}

TEST_F(ObjectTexturesTest, GoThroughAFile) {
  const std::filesystem::path input = folder_.path() / "in.glb", output = folder_.path() / "out.glb";
  Scene plates_up = plates(4);
  plates_up.up = UpAxis::y;  // So that places stay as they are.
  write_scene(plates_up, input, {});
  Materials rules;
  rules.materials["skin"].name = "skin";
  rules.materials["skin"].stiffness = 640;
  rules.assign.emplace_back().part = "plate";
  rules.assign.back().material = "skin";
  rules.decals = {decal()};
  rules.decals[0].height.emplace().depth_mm = 0.5;
  rules.decals[0].box = box_at({50, 50, 0}, k_down, k_north, 40, 20, 5);
  const BakeFileResult result = bake_file(input, output, rules, {});
  EXPECT_FALSE(result.way.in_place);
  EXPECT_NEAR(result.object_textures.decals.at(0).area_mm2, 800, 1e-3);
  EXPECT_EQ(plan_file(input, rules, {}).object_textures_made.decals.at(0).triangles,
            result.object_textures.decals[0].triangles);
  const Scene scene = read_scene(output, {});
  const auto found =
      std::find_if(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.name == "logo"; });
  ASSERT_NE(found, scene.materials.end());
  EXPECT_EQ(found->alpha_mode, "MASK");
  ASSERT_TRUE(found->haptic && found->haptic->height);
  EXPECT_EQ(found->haptic->stiffness, 640);
}

TEST_F(ObjectTexturesTest, AMaterialsEnvironmentIsEditedInPlace) {
  const std::filesystem::path input = folder_.path() / "in.glb", output = folder_.path() / "out.glb";
  write_scene(plates(2), input, {});
  const std::filesystem::path sky = folder_.path() / "sky.png";
  write_color_image(sky, {4, 2, Values<unsigned char>(3 * 8, 200)});
  Materials rules;
  rules.materials["skin"].name = "skin";
  rules.materials["skin"].environment = sky;
  rules.assign.emplace_back().part = "plate";
  rules.assign.back().material = "skin";
  EXPECT_TRUE(bake_file(input, output, rules, {}).way.in_place);
  const Scene scene = read_scene(output, {});
  EXPECT_EQ(environment_of(scene.materials.at(0)), read_environment(sky, k_material_environment_width));
  rules.materials["skin"].environment.clear();
  bake_file(output, input, rules, {});
  EXPECT_FALSE(environment_of(read_scene(input, {}).materials.at(0)));
}

TEST(ReadCarrierPicture, CropsCutsOutAndChangesContrast) {
  const TemporaryFolder folder("papilla-carrier");
  CarrierRule rule;
  rule.picture = folder.path() / "p.png";
  ColorImage image{4, 2, {}};
  for (int i = 0; i < 8; ++i)
    for (int c = 0; c < 3; ++c) image.pixels.push_back(static_cast<unsigned char>(i % 4 == 3 ? 255 : 64 * (i % 4)));
  write_color_image(rule.picture, image);
  rule.crop = {0.5, 0, 1, 0.5};
  rule.cut_out = {CutOut::By::color, {1, 1, 1}, 0.1};
  rule.contrast = 2;
  rule.brightness = 0.1;
  const RgbaImage picture = read_carrier_picture(rule);
  ASSERT_EQ(picture.width, 2);
  ASSERT_EQ(picture.height, 1);
  EXPECT_EQ(picture.at(0, 0)[0], std::lround(255 * (0.5 + 2 * (128 / 255.0 - 0.5) + 0.1)));
  EXPECT_EQ(picture.at(0, 0)[3], 255);
  EXPECT_EQ(picture.at(1, 0)[3], 0);  // White is cut out.
}

}  // namespace
}  // namespace papilla
