// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/haptic/contact_surface.hpp"
#include "papilla/io/haptic_scene.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/studio/parse_materials.hpp"
#include "turned_plate.hpp"

namespace papilla {
namespace {

constexpr double k_plate_mm_per_unit = 37;
const test::TurnedPlate k_plate;

/// The plate with grain whose repeat is oblong and whose rows are no columns, as hands feel it.
class Felt {
 public:
  Felt(const Vec2& phase_mm, const nlohmann::json& unwrap) : surface_(made(phase_mm, unwrap)) {}

  /// Height of the relief over a place of the plate [mm].
  double height(double x, double y) const {
    const auto found = surface_.closest_point(1e-3 * k_plate.at(x, y), 1e-3);
    return found ? 1e3 * found->height_m : -1;
  }

 private:
  static ContactSurface made(const Vec2& phase_mm, const nlohmann::json& unwrap) {
    nlohmann::json grain = {{"texture", "grain:leather"},
                            {"size_mm", {19, 13}},
                            {"height", {{"depth_mm", 0.4}}},
                            {"unwrap", unwrap},
                            {"phase_mm", {phase_mm.x, phase_mm.y}}};
    if (phase_mm == Vec2{}) grain.erase("phase_mm");
    const nlohmann::json document = {{"materials", {{"grain", grain}}},
                                     {"assign", {{{"part", "plate"}, {"material", "grain"}}}}};
    BakeOptions options;
    options.plan.sides.keep = true;
    const BakeResult baked =
        bake_scene(k_plate.scene(k_plate_mm_per_unit), parse_materials(document.dump(), "m.json"), options);
    HapticSceneOptions felt;
    felt.probe_radius_m = felt.felt_depth_m = 0;
    HapticScene scene = haptic_scene(baked.scene, "plate.glb", felt);
    EXPECT_TRUE(scene.warnings.empty());
    return {scene.mesh, scene.materials, std::move(scene.heights), 0, std::move(scene.channels)};
  }

  ContactSurface surface_;
};

/// On the plate's own uv, and on new ones with v along its upper edge: a grain that is moved is felt by so much
/// farther along u and v.
TEST(Phase, MovesTheReliefAlongTheSurface) {
  const nlohmann::json along_up = {{"method", "planar"}, {"grain", {k_plate.up.x, k_plate.up.y, k_plate.up.z}}};
  for (const nlohmann::json& unwrap : {nlohmann::json("keep"), along_up}) {
    const Felt still({}, unwrap);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.3, 0.7);
    for (const Vec2 phase : {Vec2{2.5, 0}, Vec2{0, -3.75}, Vec2{-7.25, 4.5}, Vec2{19 + 1.5, 13 * 3}}) {
      const Felt moved(phase, unwrap);
      const Vec2 within{std::remainder(phase.x, 19.0), std::remainder(phase.y, 13.0)};
      double difference = 0, spread = 0;
      for (int i = 0; i < 200; ++i) {
        const double x = test::TurnedPlate::k_width * share(random), y = test::TurnedPlate::k_height * share(random);
        difference = std::max(difference, std::abs(moved.height(x + within.x, y + within.y) - still.height(x, y)));
        spread = std::max(spread, std::abs(moved.height(x, y) - still.height(x, y)));
      }
      EXPECT_LT(difference, 2e-4) << unwrap << " " << phase.x << " " << phase.y;
      EXPECT_GT(spread, 0.05) << "it moves";
    }
  }
}

TEST(Phase, IsTwoNumbers) {
  const auto parsed = [](const std::string& value) {
    return parse_materials(R"({"materials": {"m": {"texture": "grain:leather", "size_mm": [1, 1], "phase_mm": )" +
                               value + R"(}}, "assign": []})",
                           "m.json");
  };
  EXPECT_EQ(parsed("[1.5, -2]").materials.at("m").phase_mm, (Vec2{1.5, -2}));
  for (const char* wrong : {"3", "[1]", "[1, 2, 3]", "[1, \"2\"]", "[1, 1e9]"})
    EXPECT_THROW(parsed(wrong), InvalidInput) << wrong;
}

}  // namespace
}  // namespace papilla
