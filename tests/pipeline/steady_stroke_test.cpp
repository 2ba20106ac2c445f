// SPDX-License-Identifier: MIT
// Force along a stroke: no probe is caught, and a micrometre of the hand makes a small difference.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "papilla/haptic/sim_device.hpp"
#include "pipeline/felt_strokes.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

constexpr double k_most_difference = 0.02;
/// A probe of friction μ that climbs a slope of 1/(3μ) feels at most 1.5·μ + 1/(2μ) along over across.
constexpr double k_most_ratio = 2.5;

void expect_steady(const MaterialRule& rule) {
  SCOPED_TRACE(rule.name);
  const DeviceCaps device = device_preset("touch").caps();
  const testing::FeltPlate plate = testing::felt_plate(rule, device);
  for (const MaterialWarning& warning : plate.haptic.warnings)
    EXPECT_EQ(warning.warning.code, "") << warning.warning.message;
  const GrainHeight& height = plate.baked.grains.at(rule.name).height;
  EXPECT_LE(height.slopes.steepest_after, height.max_slope * (1 + 1e-6));
  EXPECT_EQ(height.slopes.share_after, 0);
  for (const testing::Stroke& stroke : {testing::Stroke{.depth_m = 5e-4, .speed_m_per_s = 0.02, .way_m = 0.02},
                                        testing::Stroke{.depth_m = 1e-3, .speed_m_per_s = 0.1, .way_m = 0.06}}) {
    const testing::Steadiness found = testing::steadiness(plate.surface, device, stroke, 2);
    EXPECT_LE(found.worst, k_most_difference) << stroke.speed_m_per_s;
    EXPECT_LE(found.extremes.lag_m, 3e-3);
    EXPECT_LE(found.extremes.lateral_ratio, k_most_ratio);
    EXPECT_LE(found.extremes.largest_step_n, 0.02 * device.max_force_n * (1 + 1e-9));
    EXPECT_EQ(found.extremes.lost, 0);
  }
}

TEST(SteadyStroke, MaterialsOfTheDemo) {
  const fs::path folder = fs::temp_directory_path() / ("papilla-steady-" + std::to_string(::getpid()));
  const Materials rules = testing::demo_rules(PAPILLA_DATA, folder);
  int felt = 0;
  for (const auto& [name, rule] : rules.materials) {
    if (rule.texture.empty()) continue;
    expect_steady(rule);
    ++felt;
  }
  EXPECT_EQ(felt, 4);
  fs::remove_all(folder);
}

TEST(SteadyStroke, MaterialsOfTheRecipes) {
  const Materials rules = testing::recipe_rules();
  EXPECT_GE(rules.materials.size(), 15U);
  for (const auto& [name, rule] : rules.materials) expect_steady(rule);
}

/// What it was like: a point on the leather as steep as its picture gives it.
TEST(SteadyStroke, ASteepReliefCatchesAPoint) {
  const fs::path folder = fs::temp_directory_path() / ("papilla-steep-" + std::to_string(::getpid()));
  MaterialRule leather = testing::demo_rules(PAPILLA_DATA, folder).materials.at("leather");
  leather.height.max_slope = 1000;
  leather.height.relief.height.method = HeightMethod::intensity;
  leather.height.relief.part = false;
  const DeviceCaps device = device_preset("omega3").caps();
  const testing::FeltPlate steep = testing::felt_plate(leather, device, {.probe_radius_m = 0, .felt_depth_m = 0});
  bool found = false;
  for (const MaterialWarning& warning : steep.haptic.warnings)
    found = found || (warning.material == "leather" && warning.warning.code == "relief_steep" &&
                      warning.warning.message.find("% of the map is steeper than 2") != std::string::npos);
  EXPECT_TRUE(found);
  const testing::Stroke stroke{.depth_m = 5e-4, .speed_m_per_s = 0.02, .way_m = 0.06};
  const testing::StrokeForces caught = testing::stroke_forces(steep.surface, device, stroke);
  EXPECT_GT(caught.lag_m, 10e-3);
  EXPECT_GT(caught.lateral_ratio, 10);

  leather.height.max_slope.reset();
  const testing::FeltPlate limited = testing::felt_plate(leather, device);
  const testing::StrokeForces free = testing::stroke_forces(limited.surface, device, stroke);
  EXPECT_LT(free.lag_m, 2e-3);
  EXPECT_LT(free.lateral_ratio, 2);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace papilla
