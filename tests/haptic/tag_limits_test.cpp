// SPDX-License-Identifier: MIT
#include "papilla/haptic/tag_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "haptic/contact_shapes.hpp"

namespace papilla {
namespace {

struct Read {
  MaterialTag tag;
  std::vector<HapticWarning> warnings;
};

Read read(const nlohmann::json& height) {
  Read result;
  result.tag = parse_material_tag(nlohmann::json{{"version", 1}, {"height", height}}.dump(), result.warnings);
  std::erase_if(result.warnings, [](const HapticWarning& w) { return w.code == "tag_height_sha256"; });
  return result;
}

TEST(TagLimits, OrdinaryReliefsAreLeftAlone) {
  for (const auto& [scale, offset] : {std::pair{3e-4, 0.0},
                                      {3e-4, -1.5e-4},
                                      {3e-4, 3e-4},
                                      {3e-4, -6e-4},
                                      {-3e-4, 0.0},
                                      {0.02, 0.0},
                                      {0.04, -0.02},
                                      {0.0, 0.0}}) {
    const Read found = read({{"scale", scale}, {"offset", offset}});
    EXPECT_TRUE(found.warnings.empty()) << scale << " " << offset;
    EXPECT_EQ(found.tag.height->scale_m, scale);
    EXPECT_EQ(found.tag.height->offset_m, offset);
  }
}

/// Whatever a tag says, its relief is within 20 mm and touches or nearly touches its mesh.
TEST(TagLimits, EveryReliefIsWithinTheLimits) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> metres(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const double shrink = std::pow(10, 13 * metres(random));
    const double scale = std::clamp(shrink * metres(random), -1.0, 1.0), offset = metres(random);
    const Read found = read({{"scale", scale}, {"offset", offset}});
    const double from = found.tag.height->offset_m, to = from + found.tag.height->scale_m;
    const double low = std::min(from, to), high = std::max(from, to), range = high - low;
    EXPECT_LE(std::max(std::abs(low), std::abs(high)), k_highest_relief_m * (1 + 1e-5));
    EXPECT_LE(low, range * (1 + 1e-5));
    EXPECT_GE(high, -range * (1 + 1e-5));
    EXPECT_EQ(found.warnings.empty(), from == offset && found.tag.height->scale_m == scale);
    const Read again = read({{"scale", found.tag.height->scale_m}, {"offset", from}});
    EXPECT_EQ(again.tag, found.tag) << scale << " " << offset;
  }
}

TEST(TagLimits, WarningsNameFieldValueAndLimit) {
  const Read moved = read({{"scale", 3e-4}, {"offset", 0.01}});
  ASSERT_EQ(moved.warnings.size(), 1U);
  EXPECT_EQ(moved.warnings[0].code, "tag_offset_limit");
  EXPECT_NE(moved.warnings[0].message.find("haptic.height.offset = 0.01:"), std::string::npos);
  EXPECT_NE(moved.warnings[0].message.find("0.0003 is used"), std::string::npos);
  const Read high = read({{"scale", 1}, {"offset", 0}});
  ASSERT_EQ(high.warnings.size(), 1U);
  EXPECT_EQ(high.warnings[0].code, "tag_height_limit");
  EXPECT_NE(high.warnings[0].message.find("haptic.height.scale = 1:"), std::string::npos);
  EXPECT_NE(high.warnings[0].message.find("limit of 0.02"), std::string::npos);
}

TEST(TagLimits, RoughnessIsLimited) {
  std::vector<HapticWarning> warnings;
  const MaterialTag tag = parse_material_tag(
      R"({"version": 1, "stiffness": 500, "roughness": {"fractalDimension": 2.5, "rmsHeight": 0.08}})", warnings);
  EXPECT_EQ(tag.roughness->rms_height_m, 0.005);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, "tag_roughness_limit");
  EXPECT_NE(warnings[0].message.find("haptic.roughness.rmsHeight = 0.08: is beyond the limit of 0.005"),
            std::string::npos);
}

TEST(TagLimits, AmplitudesAreLimitedByTheDevice) {
  std::vector<ContactMaterial> materials(4);
  for (ContactMaterial& material : materials) material.stimulus = 0, material.amplitude = 0.5;
  materials[0].model = ForceModel::orthogonal;
  materials[1].model = ForceModel::lateral_isotropic;
  materials[2].model = ForceModel::textured_normal;
  materials[3].model = ForceModel::lateral;
  materials[3].amplitude = 0.01;
  HeightFieldOptions options;
  options.scale_m = 1e-4;
  ContactSurface surface(testing::plate(1, 1, 0.1, 0.1), materials, {HeightField(1, 1, {0}, options)}, 0);
  const auto clamps = clamp_amplitudes(surface, 2.56);
  ASSERT_EQ(clamps.size(), 1U + 1U);
  EXPECT_EQ(clamps[0].material, 0U);
  EXPECT_EQ(clamps[0].wanted, 0.5);
  EXPECT_DOUBLE_EQ(clamps[0].limit, 0.01);
  EXPECT_DOUBLE_EQ(surface.material(0).amplitude, 0.01);
  EXPECT_DOUBLE_EQ(surface.material(1).amplitude, 0.01 / std::sqrt(2.0));
  EXPECT_EQ(surface.material(2).amplitude, 0.5);
  EXPECT_EQ(surface.material(3).amplitude, 0.01);
  EXPECT_EQ(
      to_warning(clamps[0], 2.56).message,
      "haptic.forceModel.amplitude = 0.5: asks a device of 2.56 N for more than its largest force in a tick, 0.01 "
      "is used");
}

}  // namespace
}  // namespace papilla
