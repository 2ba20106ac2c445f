// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/felt_scene.hpp"

#include <gtest/gtest.h>

#include <random>

#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "turned_plate.hpp"

namespace papilla {
namespace {

const test::TurnedPlate k_plate;
constexpr const char* k_document = R"({"materials": {"grain": {"texture": "grain:leather", "size_mm": [19, 13],
  "height": {"depth_mm": 0.4}, "stiffness": 350, "staticFriction": 0.4, "unwrap": "keep"}},
  "assign": [{"part": "plate", "material": "grain"}]})";

BakeOptions options() {
  BakeOptions options;
  options.plan.sides.keep = true;
  return options;
}

/// The plate as the studio makes it, with another use of it 100 mm along its right edge.
struct Made {
  Made() {
    Scene scene = k_plate.scene(30);
    Node second = scene.nodes[scene.roots[0]];
    second.local[3] += 100 * k_plate.right.x, second.local[7] += 100 * k_plate.right.y,
        second.local[11] += 100 * k_plate.right.z;
    scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(second);
    StudioScene studio(scene, options(), false);
    const StudioPlan plan = studio.plan(k_document, "m.json", {});
    surface = std::make_shared<const StudioSurface>(studio.bake(plan, plan.wishes.at(0)));
    for (const std::uint32_t use : plan.wishes[0].uses) placed.push_back({surface, studio.uses()[use].world});
    baked = bake_scene(scene, plan.rules, options()).scene;
  }
  std::shared_ptr<const StudioSurface> surface;
  std::vector<FeltSurface> placed;
  Scene baked;
};

const Made& made() {
  static const Made made;
  return made;
}

ContactSurface surface_of(HapticScene scene) {
  return {scene.mesh, scene.materials, std::move(scene.heights), scene.probe_radius_m, std::move(scene.channels)};
}

void expect_same(const ContactSurface& a, const ContactSurface& b) {
  ASSERT_EQ(a.triangles(), b.triangles());
  EXPECT_NEAR(a.tallest_relief_m(), b.tallest_relief_m(), 1e-9);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = 1e-3 * (k_plate.at(164 * share(random), 40 * share(random)) + 4 * share(random) * k_plate.normal);
    const auto x = a.closest_point(p, 0.05), y = b.closest_point(p, 0.05);
    ASSERT_TRUE(x && y);
    EXPECT_NEAR(norm(x->point - y->point), 0, 1e-7);
    EXPECT_NEAR(x->height_m, y->height_m, 2e-7);
  }
}

TEST(FeltScene, IsWhatAPlayerLoadsOfTheBakedScene) {
  ASSERT_EQ(made().placed.size(), 2U);
  const HapticScene felt = felt_scene(made().placed, {}, "m.json", {}), played = haptic_scene(made().baked, "p.glb");
  EXPECT_EQ(felt.maps_loaded, 1) << "one surface at two places";
  ASSERT_EQ(felt.materials.size(), 1U);
  EXPECT_EQ(felt.materials[0].stiffness, 350);
  EXPECT_EQ(felt.materials[0].static_friction, 0.4);
  EXPECT_GT(surface_of(felt).tallest_relief_m(), 1e-4);
  expect_same(surface_of(felt), surface_of(played));
}

/// A tag on the second texture coordinates is felt by those, whatever the first ones are.
TEST(FeltScene, TakesTheTextureCoordinatesOfTheTag) {
  Scene scene = made().baked;
  TriangleMesh& mesh = scene.parts[0].mesh;
  mesh.uv1 = mesh.uv;
  for (Vec2& uv : mesh.uv.values) uv = {0.1, 0.2};
  for (Material& material : scene.materials)
    if (material.haptic) material.haptic->height->tex_coord = 1, material.normal_texture->tex_coord = 1;
  const StudioScene studio(scene, options(), true);
  std::vector<FeltSurface> placed;
  const auto surface = std::make_shared<const StudioSurface>(studio.as_read(0, 0));
  for (const StudioUse& use : studio.uses()) placed.push_back({surface, use.world});
  expect_same(surface_of(felt_scene(placed, {}, "m.json", {})), surface_of(haptic_scene(made().baked, "p.glb")));
}

TEST(FeltScene, TakesAnotherForceModel) {
  const ContactMaterial own = felt_scene(made().placed, {}, "m.json", {}).materials[0];
  EXPECT_EQ(own.model, ForceModel::heightfield);
  EXPECT_TRUE(own.height && !own.stimulus);
  const ContactMaterial other = felt_scene(made().placed, "lateral", "m.json", {}).materials[0];
  EXPECT_EQ(other.model, ForceModel::lateral);
  EXPECT_TRUE(other.stimulus && !other.height);
  EXPECT_EQ(other.stiffness, own.stiffness);
  EXPECT_THROW(felt_scene(made().placed, "none", "m.json", {}), InvalidInput);
  EXPECT_THROW(felt_scene({}, {}, "m.json", {}), InvalidInput);
}

TEST(FeltScene, LooksForWhatIsNear) {
  const std::vector<FeltSurface>& placed = made().placed;
  EXPECT_EQ(felt_surfaces(placed, k_plate.at(20, 20), 5).size(), 1U);
  EXPECT_EQ(felt_surfaces(placed, k_plate.at(20, 20), 500).size(), 2U);
  EXPECT_EQ(felt_surfaces(placed, k_plate.at(20, 20) + 90 * k_plate.normal, 20).size(), 0U);
  StudioSurface bare = *made().surface;
  bare.look = std::make_shared<const Scene>();
  EXPECT_TRUE(felt_surfaces({{std::make_shared<const StudioSurface>(bare), k_identity}}, k_plate.at(0, 0), 5).empty());
}

}  // namespace
}  // namespace papilla
