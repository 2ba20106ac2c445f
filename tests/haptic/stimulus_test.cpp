// SPDX-License-Identifier: MIT
#include "papilla/haptic/stimulus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/haptic_tick.hpp"

namespace papilla {
namespace {

constexpr double k_size = 0.1, k_scale = 1e-4;
constexpr int k_pixels = 500;  // Of 0.2 mm.

/// Grey levels rise along x by 256 over the plate: 0.512 a pixel.
HeightField ramp() {
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < k_pixels; ++x)
      samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * (x + 0.5) / k_pixels)));
  HeightFieldOptions options;
  options.scale_m = k_scale;
  options.interpolation = Interpolation::bilinear;
  return HeightField(k_pixels, 4, samples, options);
}

ContactSurface plate_with(ForceModel model, double amplitude, bool literal = false) {
  ContactMaterial material;
  material.stiffness = 500;
  material.model = model;
  material.stimulus = 0;
  material.amplitude = amplitude;
  material.literal_sign = literal;
  return ContactSurface(testing::plate(8, 8, k_size, k_size), {material}, {ramp()}, 0);
}

/// Force while a probe 0.5 mm deep moves at `velocity`, after `ticks`.
Vec3 felt(const ContactSurface& surface, Vec3 velocity, double rate_hz, int ticks) {
  SafetyLimits limits{.max_force_n = 100, .slew_n_per_s = 1e9, .soft_start_s = 0};
  HapticTick tick(surface, limits, 1 / rate_hz);
  DeviceState state;
  state.position = {0.03, 0.05, 1e-3};
  tick(state);
  Vec3 force;
  for (int i = 0; i < ticks; ++i) {
    state.position = Vec3{0.03, 0.05, -5e-4} + (i / rate_hz) * velocity;
    force = tick(state);
  }
  return force;
}

TEST(Stimulus, NamesGoBothWays) {
  for (int i = 0; i <= static_cast<int>(ForceModel::textured_normal); ++i) {
    const auto model = static_cast<ForceModel>(i);
    EXPECT_FALSE(name_of(model).empty());
    EXPECT_EQ(force_model(name_of(model)), model);
  }
  EXPECT_EQ(force_model("spoon"), std::nullopt);
}

TEST(Stimulus, OrthogonalIsAmplitudeTimesChangeWhateverTheRate) {
  const ContactSurface surface = plate_with(ForceModel::orthogonal, 0.02);
  // At 0.1 m/s half a pixel in a millisecond: 0.256 grey levels.
  for (const double rate : {1000.0, 4000.0, 10000.0})
    EXPECT_NEAR(felt(surface, {0.1, 0, 0}, rate, static_cast<int>(0.05 * rate)).z, 0.25 + 0.02 * 0.256, 2e-4) << rate;
  EXPECT_NEAR(felt(surface, {0, 0.1, 0}, 1000, 50).z, 0.25, 1e-6);
  EXPECT_NEAR(felt(surface, {}, 1000, 50).z, 0.25, 1e-6);
}

TEST(Stimulus, LateralPushesDownhillAndLiterallyUphill) {
  const Vec3 down = felt(plate_with(ForceModel::lateral, 0.01), {0.1, 0, 0}, 1000, 50);
  EXPECT_NEAR(down.x, -0.01 * 0.512 * std::sqrt(k_size / 4 / (k_size / k_pixels)), 0.3 * std::abs(down.x));
  EXPECT_NEAR(down.y, 0, 1e-9);
  EXPECT_NEAR(down.z, 0.25, 1e-6);
  EXPECT_NEAR(felt(plate_with(ForceModel::lateral, 0.01, true), {0.1, 0, 0}, 1000, 50).x, -down.x, 1e-9);
}

TEST(Stimulus, IsotropicActsAlongBothTangents) {
  const Vec3 force = felt(plate_with(ForceModel::lateral_isotropic, 0.02), {0.1, 0, 0}, 1000, 50);
  EXPECT_NEAR(force.x, -0.02 * 0.256, 2e-4);
  EXPECT_NEAR(force.y, force.x, 1e-9);
}

TEST(Stimulus, GraphFollowsTheDistance) {
  const ContactSurface surface = plate_with(ForceModel::graph_orthogonal, 0.01);
  const Stimulus stimulus(surface);
  double low = 1e9, high = -1e9;
  for (const double value : stimulus.graph()) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  EXPECT_EQ(low, 0);
  EXPECT_EQ(high, 256);
  EXPECT_NEAR(felt(surface, {}, 1000, 50).z, 0.25, 1e-6);
  EXPECT_NE(felt(surface, {0.1, 0, 0}, 1000, 50).z, felt(surface, {0.1, 0, 0}, 1000, 80).z);
  EXPECT_NEAR(felt(plate_with(ForceModel::graph_lateral, 0.01), {}, 1000, 50).x, 0, 1e-12);
}

TEST(Stimulus, TexturedNormalPointsToTheNearestTexturedPoint) {
  const ContactSurface surface = plate_with(ForceModel::textured_normal, 0);
  const Vec3 force = felt(surface, {}, 1000, 50);
  // A ramp of slope 1e-3: the depth below it is 0.5 mm + 0.1 mm · 0.3.
  EXPECT_NEAR(norm(force), 500 * (5e-4 + k_scale * 0.3), 500 * 1e-6);
  EXPECT_GT(force.z, 0);
}

}  // namespace
}  // namespace papilla
