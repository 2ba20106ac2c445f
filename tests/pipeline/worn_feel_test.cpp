// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/haptic/haptic_tick.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/pipeline/bake_scene.hpp"

namespace papilla {
namespace {

struct Felt {
  MaterialTag tag;
  double roughness_mm = 0;           ///< Peak to valley.
  double along_n = 0, across_n = 0;  ///< Mean force while sliding: against the motion, out of the surface.
};

/// A plate of 100 mm covered with the recipe, baked, and stroked by a probe held 0.5 mm below its plane.
Felt stroke(const std::string& recipe, double time, const RecipeLibrary& library = RecipeLibrary::builtin()) {
  Materials rules;
  MaterialRule rule;
  rule.name = "wheel", rule.recipe = recipe, rule.texture = "/nonexistent/" + recipe;
  rule.time = time, rule.size_mm[0] = rule.size_mm[1] = 40, rule.height.depth_mm = 0.2;
  rules.materials = {{"wheel", rule}};
  AssignRule assign;
  assign.part = "*", assign.material = "wheel";
  rules.assign = {assign};
  Part part;
  part.name = "wheel";
  part.mesh.positions = {{0, 0, 0}, {100, 0, 0}, {100, 100, 0}, {0, 100, 0}};
  part.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Scene scene = single_part_scene(std::move(part), "test");
  scene.up = UpAxis::y;
  BakeOptions options;
  options.library = library;
  const BakeResult baked = bake_scene(std::move(scene), rules, options);
  Felt felt;
  const Grain& grain = baked.grains.at("wheel");
  const auto [low, high] = std::minmax_element(grain.relief.mm.begin(), grain.relief.mm.end());
  felt.roughness_mm = static_cast<double>(*high - *low);
  felt.tag = baked.scene.materials.back().haptic.value();

  const HapticScene haptic = haptic_scene(baked.scene, ".");
  const ContactSurface surface(haptic.mesh, haptic.materials, haptic.heights, haptic.probe_radius_m, haptic.channels);
  HapticTick tick(surface, safety_limits(3.3), 1e-3);
  DeviceState device;
  device.position = {0.02, 0.05, 0.01};
  tick.reset(device.position);
  constexpr int ticks = 1000;
  for (int i = 0; i < ticks; ++i) {
    device.position = {0.02 + 6e-5 * i, 0.05, haptic.probe_radius_m - 0.0005};
    const Vec3 force = tick(device);
    if (i < 200) continue;
    felt.along_n -= force.x / (ticks - 200);
    felt.across_n += force.z / (ticks - 200);
  }
  return felt;
}

TEST(WornFeel, AWornWheelFeelsUnlikeANewOne) {
  const Felt fresh = stroke("worn_wheel", 0), worn = stroke("worn_wheel", 1);
  EXPECT_LT(worn.roughness_mm, 0.95 * fresh.roughness_mm) << "polished";
  EXPECT_GT(std::abs(worn.tag.dynamic_friction - fresh.tag.dynamic_friction), 0.02);
  EXPECT_GT(fresh.across_n, 0.02) << "the probe is in touch";
  EXPECT_GT(std::abs(worn.along_n - fresh.along_n), 0.05 * fresh.along_n);
}

TEST(WornFeel, FrictionAndStiffnessOfARecipeAreFelt) {
  const std::string flat = "base|bumpfunction=.5|frictionfunction=.6-.4*time|stiffnessfunction=1-.5*time";
  const Felt fresh = stroke(flat, 0), worn = stroke(flat, 1);
  EXPECT_NEAR(fresh.tag.dynamic_friction, 0.6, 1e-6);
  EXPECT_NEAR(worn.tag.dynamic_friction, 0.2, 1e-6);
  EXPECT_NEAR(worn.tag.stiffness / fresh.tag.stiffness, 0.5, 1e-6);
  EXPECT_NEAR(fresh.along_n / fresh.across_n, 0.6, 0.03);
  EXPECT_NEAR(worn.along_n / worn.across_n, 0.2, 0.03);
  EXPECT_NEAR(worn.across_n / fresh.across_n, 0.5, 0.02);
}

TEST(WornFeel, RecipesOfALibraryAreFound) {
  RecipeLibrary library = RecipeLibrary::builtin();
  library.add("my_plate", "base|frictionfunction=.37");
  EXPECT_NEAR(stroke("my_plate", 0, library).tag.dynamic_friction, 0.37, 1e-6);
  EXPECT_THROW(stroke("my_plate", 0), Error);
}

}  // namespace
}  // namespace papilla
