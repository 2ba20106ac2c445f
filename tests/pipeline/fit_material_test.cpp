// SPDX-License-Identifier: MIT
#include "papilla/pipeline/fit_material.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "fit/profile_roughness.hpp"
#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"
#include "pipeline/fit_strokes.hpp"

namespace papilla {
namespace {

using testing::HandPlan;

ContactMaterial material(double k, double b, double mu_s, double mu_d, double vs) {
  ContactMaterial m;
  m.stiffness = k, m.damping = b, m.static_friction = mu_s, m.dynamic_friction = mu_d, m.stribeck_velocity = vs;
  return m;
}

const std::vector<ContactMaterial>& materials() {
  static const std::vector<ContactMaterial> all = {
      material(900, 0.4, 0.45, 0.35, 0.01), material(300, 1.5, 0.9, 0.6, 0.02), material(2500, 0.8, 0.2, 0.12, 0.03),
      material(1500, 3, 0.6, 0.3, 0.008), material(600, 0.5, 0.3, 0.2, 0.05)};
  return all;
}

double relative(const std::optional<FittedNumber>& found, double truth) {
  return found ? std::abs(found->value / truth - 1) : std::numeric_limits<double>::infinity();
}

void expect_material(const MaterialFit& fit, const ContactMaterial& truth, double share) {
  EXPECT_LE(relative(fit.stiffness, truth.stiffness), share);
  EXPECT_LE(relative(fit.damping, truth.damping), share);
  EXPECT_LE(relative(fit.static_friction, truth.static_friction), share);
  EXPECT_LE(relative(fit.dynamic_friction, truth.dynamic_friction), share);
  for (const NotIdentified& missing : fit.not_identified)
    EXPECT_TRUE(missing.parameter == "roughness" || missing.parameter == "hurst")
        << missing.parameter << missing.reason;
}

/// The reason for what is not identified; empty when it is.
std::string reason_of(const MaterialFit& fit, const std::string& parameter) {
  for (const NotIdentified& missing : fit.not_identified)
    if (missing.parameter == parameter) return missing.reason;
  return "";
}

std::vector<StrokeSample> stroke_on(const ContactMaterial& m, const HandPlan& plan = {}) {
  return testing::record_stroke(testing::flat_plate(m), testing::hand_of(plan));
}

TEST(FitMaterial, ARecordingGivesTheMaterialBack) {
  for (const ContactMaterial& truth : materials()) {
    SCOPED_TRACE(truth.stiffness);
    const auto stroke = stroke_on(truth);
    const MaterialFit fit = fit_material(stroke, {}, "stroke");
    EXPECT_EQ(fit.surface, StrokeSurface::recorded);
    expect_material(fit, truth, 0.02);
    EXPECT_LE(relative(fit.stribeck_velocity, truth.stribeck_velocity), 0.05);
    EXPECT_FALSE(fit.roughness);
    EXPECT_TRUE(fit.warnings.empty()) << fit.warnings.front();
    EXPECT_EQ(fit.stop, StopReason::converged);
    ASSERT_FALSE(fit.trace.empty());
    EXPECT_LT(fit.trace.back().error, fit.trace.front().error);
  }
}

/// The same forces without proxies.
constexpr FitOptions k_of_player{.forces = StrokeForces::player};

/// Materials on which a proxy slides steadily, so that its slip can be found again.
const std::vector<ContactMaterial>& steady_materials() {
  static const std::vector<ContactMaterial> all = {
      material(900, 0.8, 0.4, 0.35, 0.02), material(300, 1.5, 0.7, 0.6, 0.04), material(2500, 0.8, 0.2, 0.12, 0.03),
      material(1500, 3, 0.4, 0.3, 0.03), material(600, 0.5, 0.3, 0.2, 0.05)};
  return all;
}

TEST(FitMaterial, WithoutProxiesThePlaneIsFoundToo) {
  for (const ContactMaterial& truth : steady_materials()) {
    SCOPED_TRACE(truth.stiffness);
    const MaterialFit fit = fit_material(testing::seen_from_outside(stroke_on(truth)), k_of_player, "stroke");
    EXPECT_EQ(fit.surface, StrokeSurface::plane);
    EXPECT_TRUE(fit.warnings.empty());
    expect_material(fit, truth, 0.02);
  }
  const MaterialFit unsteady =
      fit_material(testing::seen_from_outside(stroke_on(materials()[3])), k_of_player, "stroke");
  EXPECT_LE(relative(unsteady.stiffness, 1500), 0.02);
  EXPECT_LE(relative(unsteady.dynamic_friction, 0.3), 0.02);
  ASSERT_EQ(unsteady.warnings.size(), 1U);
  EXPECT_NE(unsteady.warnings[0].find("sticks and slips"), std::string::npos);
}

TEST(FitMaterial, NoiseOfTwoPercentCostsLessThanTen) {
  std::uint64_t seed = 1;
  for (const ContactMaterial& truth : steady_materials())
    for (const bool outside : {false, true}) {
      SCOPED_TRACE(truth.stiffness);
      auto stroke = stroke_on(truth);
      if (outside) stroke = testing::seen_from_outside(std::move(stroke));
      testing::add_force_noise(stroke, 0.02, seed++);
      expect_material(fit_material(stroke, outside ? k_of_player : FitOptions{}, "stroke"), truth, 0.1);
    }
}

/// Of random materials under noise, 95 of 100 intervals hold the truth: at least 85 of 100 of 60 do, by chance, all but
/// once in 500 times; intervals that are far too wide would hold all and be wide.
TEST(FitMaterial, IntervalsCover) {
  constexpr int k_materials = 60;
  std::mt19937_64 random(7);
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(random() >> 11) * 0x1p-53);
  };
  std::array<int, 4> held{}, known{};
  double widths = 0;
  for (int i = 0; i < k_materials; ++i) {
    const double mu_d = between(0.15, 0.6);
    const ContactMaterial truth =
        material(between(250, 2500), between(0.5, 3), mu_d * between(1.2, 1.6), mu_d, between(0.01, 0.04));
    auto stroke = stroke_on(truth);
    testing::add_force_noise(stroke, 0.02, 100 + static_cast<std::uint64_t>(i));
    const MaterialFit fit = fit_material(stroke, {}, "stroke");
    const auto count = [&](std::size_t k, const std::optional<FittedNumber>& found, double value) {
      if (!found) return;
      ++known[k];
      held[k] += found->low <= value && value <= found->high;
      widths += (found->high - found->low) / value;
    };
    count(0, fit.stiffness, truth.stiffness);
    count(1, fit.damping, truth.damping);
    count(2, fit.static_friction, truth.static_friction);
    count(3, fit.dynamic_friction, truth.dynamic_friction);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_GE(known[k], 57) << k;
    EXPECT_GE(held[k], 0.85 * known[k]) << k;
  }
  EXPECT_LT(held[0] + held[1] + held[2] + held[3], known[0] + known[1] + known[2] + known[3]);
  EXPECT_LT(widths / (4 * k_materials), 0.15);
}

TEST(FitMaterial, TheSameStrokeGivesTheSameBits) {
  auto stroke = stroke_on(materials()[0]);
  testing::add_force_noise(stroke, 0.02, 3);
  const MaterialFit a = fit_material(stroke, {}, "stroke"), b = fit_material(stroke, {}, "stroke");
  EXPECT_EQ(a.stiffness->value, b.stiffness->value);
  EXPECT_EQ(a.static_friction->high, b.static_friction->high);
  EXPECT_EQ(a.trace.size(), b.trace.size());
}

TEST(FitMaterial, AStrokeThatNeverPressesIsRefused) {
  HandPlan none{.presses = false, .rests = false, .crawls = false, .hurries = false};
  const auto stroke = stroke_on(materials()[0], none);
  try {
    fit_material(stroke, {}, "air.csv");
    ADD_FAILURE() << "not refused";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("air.csv: the stroke never presses"), std::string::npos) << error.what();
  }
  EXPECT_THROW(fit_material(std::span(stroke).first(20), {}, "short"), InvalidInput);
}

bool has_warning(const MaterialFit& fit, const std::string& text) {
  return std::any_of(fit.warnings.begin(), fit.warnings.end(),
                     [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST(FitMaterial, ForcesWithoutAnyDepthIdentifyNothing) {
  std::vector<StrokeSample> stroke;
  for (int i = 0; i < 100; ++i) stroke.push_back({1e-3 * i, {1, 1, 1}, {1, 1, 1}, Vec3{1, 1, 1}, {}});
  const MaterialFit fit = fit_material(stroke, {}, "r.csv");
  EXPECT_FALSE(fit.stiffness);
  EXPECT_FALSE(fit.damping);
  EXPECT_FALSE(fit.dynamic_friction);
}

TEST(FitMaterial, ForcesOnTheSurfaceAreRefused) {
  auto stroke = stroke_on(materials()[0]);
  for (StrokeSample& sample : stroke) sample.force_n = -1.0 * sample.force_n;
  try {
    fit_material(stroke, {}, "r.csv");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("r.csv: the forces point into the surface"), std::string::npos);
  }
}

TEST(FitMaterial, PlacesInMillimetresAreNoticed) {
  auto stroke = stroke_on(materials()[0], {.presses = false, .rests = false, .crawls = false, .steadily = true});
  EXPECT_FALSE(has_warning(fit_material(stroke, {}, "r.csv"), "faster than a hand"));
  for (StrokeSample& sample : stroke) sample.probe_m = 1e3 * sample.probe_m, *sample.proxy_m = 1e3 * *sample.proxy_m;
  EXPECT_TRUE(has_warning(fit_material(stroke, {}, "r.csv"), "faster than a hand"));
}

TEST(FitMaterial, APlayerThatLetTheProbeGoIsNoticed) {
  auto stroke = stroke_on(materials()[0]);
  const auto deep = std::find_if(stroke.begin(), stroke.end(), [](const StrokeSample& sample) {
    return sample.t_s > 1 && norm(*sample.proxy_m - sample.probe_m) > 1e-3;
  });
  ASSERT_NE(deep, stroke.end());
  for (auto after = deep; after != stroke.end(); ++after) after->proxy_m = after->probe_m, after->force_n = {};
  EXPECT_TRUE(has_warning(fit_material(stroke, {}, "r.csv"), "lets the probe go"));
}

TEST(FitMaterial, AModelThatLeavesMuchOfTheForceSaysSo) {
  auto stroke = stroke_on(materials()[0]);
  for (std::size_t i = 0; i < stroke.size(); ++i)
    stroke[i].force_n = (1 + 0.5 * std::sin(0.02 * static_cast<double>(i))) * stroke[i].force_n;
  EXPECT_TRUE(has_warning(fit_material(stroke, {}, "r.csv"), "of the force unexplained"));
}

TEST(FitMaterial, WithoutSlidingThereIsNoFriction) {
  const MaterialFit fit = fit_material(stroke_on(materials()[0], {.crawls = false, .hurries = false}), {}, "stroke");
  EXPECT_LE(relative(fit.stiffness, 900), 0.02);
  EXPECT_LE(relative(fit.damping, 0.4), 0.02);
  EXPECT_FALSE(fit.static_friction || fit.dynamic_friction || fit.stribeck_velocity || fit.roughness);
  for (const char* name : {"static_friction", "dynamic_friction", "stribeck_velocity", "roughness"})
    EXPECT_NE(reason_of(fit, name).find("never slid"), std::string::npos) << name << ": " << reason_of(fit, name);
}

TEST(FitMaterial, OneSpeedGivesTheFrictionAtThatSpeedOnly) {
  auto stroke = stroke_on(materials()[0], {.crawls = false, .hurries = false, .steadily = true});
  testing::add_force_noise(stroke, 0.005, 5);
  const MaterialFit fit = fit_material(stroke, {}, "stroke");
  EXPECT_LE(relative(fit.dynamic_friction, 0.35), 0.02);
  EXPECT_FALSE(fit.static_friction || fit.stribeck_velocity);
  for (const char* name : {"static_friction", "stribeck_velocity"})
    EXPECT_NE(reason_of(fit, name).find("one speed only"), std::string::npos) << reason_of(fit, name);
}

TEST(FitMaterial, FrictionThatDoesNotDependOnSpeedHasNoStribeckSpeed) {
  const MaterialFit fit = fit_material(stroke_on(material(800, 1, 0.4, 0.4, 0.01)), {}, "stroke");
  EXPECT_LE(relative(fit.dynamic_friction, 0.4), 0.02);
  EXPECT_LE(relative(fit.static_friction, 0.4), 0.02);
  EXPECT_FALSE(fit.stribeck_velocity);
  EXPECT_NE(reason_of(fit, "stribeck_velocity").find("does not change"), std::string::npos);
}

TEST(FitMaterial, AFrictionlessPlateHasNone) {
  const MaterialFit fit = fit_material(stroke_on(material(800, 1, 0, 0, 0.01)), {}, "stroke");
  ASSERT_TRUE(fit.dynamic_friction);
  EXPECT_LT(fit.dynamic_friction->value, 0.002);
  EXPECT_EQ(fit.dynamic_friction->low, 0);
  EXPECT_LE(relative(fit.stiffness, 800), 0.02);
}

TEST(FitMaterial, AStandingPressWithoutItsBeginningHasNeitherStiffnessNorDamping) {
  auto stroke = testing::seen_from_outside(
      stroke_on(materials()[4], {.presses = false, .crawls = false, .hurries = false, .steadily = true}));
  testing::add_force_noise(stroke, 0.02, 8);
  stroke.erase(stroke.begin(), stroke.begin() + 1500);
  const MaterialFit fit = fit_material(stroke, {}, "stroke");
  EXPECT_FALSE(fit.stiffness);
  EXPECT_NE(reason_of(fit, "stiffness").find("the depth of the press"), std::string::npos);
  EXPECT_FALSE(fit.damping);
  EXPECT_NE(reason_of(fit, "damping").find("too slowly"), std::string::npos) << reason_of(fit, "damping");
  EXPECT_LE(relative(fit.dynamic_friction, 0.2), 0.1);
}

TEST(FitMaterial, ForcesThatTheDeviceCutsOffAreUnderstoodWhereItsLimitIsTold) {
  constexpr double most = 0.7;
  const ContactMaterial truth = materials()[0];
  const auto stroke = testing::record_stroke(testing::flat_plate(truth), testing::hand_of({}), most);
  const MaterialFit cut = fit_material(stroke, {}, "stroke");
  const MaterialFit told = fit_material(stroke, {.max_force_n = most}, "stroke");
  EXPECT_LE(relative(told.stiffness, truth.stiffness), 0.02);
  EXPECT_LT(told.rms_residual_n, cut.rms_residual_n);
}

TEST(FitMaterial, LongRecordingsAreCutAndOptionsChecked) {
  const auto stroke = stroke_on(materials()[0]);
  const MaterialFit fit = fit_material(stroke, {.most_samples = 3000}, "stroke");
  EXPECT_EQ(fit.samples, 3000U);
  ASSERT_EQ(fit.warnings.size(), 1U);
  EXPECT_THROW(fit_material(testing::seen_from_outside(stroke), {.surface = StrokeSurface::recorded}, "stroke"),
               InvalidInput);
  EXPECT_THROW(fit_material(stroke, {}, "stroke", [](const Progress&) { return false; }), Cancelled);
}

/// A plate with waves along x.
ContactSurface wavy_plate(double wave_m, double amplitude_m) {
  const int pixels = 2048;
  std::vector<std::uint16_t> samples;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < pixels; ++i)
      samples.push_back(static_cast<std::uint16_t>(
          std::lround(65535 * 0.5 * (1 + std::sin(2 * std::numbers::pi * (i + 0.5) / pixels * 0.1 / wave_m)))));
  HeightFieldOptions options;
  options.scale_m = 2 * amplitude_m;
  ContactMaterial m = material(900, 0.4, 0.25, 0.2, 0.01);
  m.height = 0;
  return ContactSurface(testing::plate(10, 10, 0.1, 0.1), {m}, {HeightField(pixels, 4, samples, options)}, 0);
}

TEST(FitMaterial, FeelsTheRoughnessOfAWave) {
  constexpr double wave = 4e-3, amplitude = 3e-5;
  for (const bool outside : {false, true}) {
    auto stroke = testing::record_stroke(wavy_plate(wave, amplitude), testing::hand_of({}));
    if (outside) stroke = testing::seen_from_outside(std::move(stroke));
    const MaterialFit fit = fit_material(stroke, outside ? k_of_player : FitOptions{}, "stroke");
    EXPECT_LE(relative(fit.stiffness, 900), 0.02);
    ASSERT_TRUE(fit.roughness) << reason_of(fit, "roughness");
    EXPECT_NEAR(fit.roughness->rms_m.value, amplitude / std::numbers::sqrt2, 0.1 * amplitude);
    EXPECT_FALSE(fit.roughness->hurst);
    EXPECT_NE(reason_of(fit, "hurst"), "");
  }
}

/// Fractional Brownian profiles by spectral synthesis, along a way that is not evenly sampled.
std::vector<std::vector<ProfilePoint>> brownian_runs(double hurst, double noise_m, std::uint64_t seed) {
  constexpr int k_waves = 16000;  // Down to 25 um.
  constexpr double k_long_m = 0.4, k_rms_m = 2e-5;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(0.8, 1.2), turn(0, 2 * std::numbers::pi);
  std::vector<double> size, phase;
  double squares = 0;
  for (int k = 1; k <= k_waves; ++k) {
    size.push_back(std::pow(k, -hurst - 0.5));
    phase.push_back(turn(random));
    squares += 0.5 * size.back() * size.back();
  }
  std::vector<ProfilePoint> run;
  for (double way = 0; way < 0.2; way += 1e-4 * even(random)) {
    double height = 0;
    for (int k = 1; k <= k_waves; ++k)
      height += size[static_cast<std::size_t>(k - 1)] *
                std::cos(2 * std::numbers::pi * k * way / k_long_m + phase[static_cast<std::size_t>(k - 1)]);
    run.push_back({way, {way, 0, k_rms_m / std::sqrt(squares) * height + noise_m * normal(random)}, {0, 0, 1}});
  }
  return {run};
}

TEST(ProfileRoughness, FindsTheExponentOfBrownianProfiles) {
  for (const double hurst : {0.4, 0.5, 0.7}) {
    const ProfileRoughness found = profile_roughness(brownian_runs(hurst, 0, 1), 0);
    ASSERT_TRUE(found.roughness) << found.no_roughness;
    ASSERT_TRUE(found.roughness->hurst) << found.no_hurst;
    EXPECT_NEAR(found.roughness->hurst->value, hurst, 0.08);
    EXPECT_LE(found.roughness->hurst->low, hurst + 0.03);
    EXPECT_GE(found.roughness->hurst->high, hurst - 0.03);
  }
}

TEST(ProfileRoughness, NoiseIsTakenOutAndAloneIsNoRoughness) {
  const ProfileRoughness clean = profile_roughness(brownian_runs(0.5, 0, 2), 0);
  const ProfileRoughness noisy = profile_roughness(brownian_runs(0.5, 3e-7, 2), 3e-7);
  ASSERT_TRUE(clean.roughness && noisy.roughness);
  EXPECT_NEAR(noisy.roughness->rms_m.value / clean.roughness->rms_m.value, 1, 0.02);
  ASSERT_TRUE(noisy.roughness->hurst) << noisy.no_hurst;
  EXPECT_NEAR(noisy.roughness->hurst->value, 0.5, 0.1);
  auto runs = brownian_runs(0.5, 0, 2);
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal(0, 1e-6);
  for (ProfilePoint& point : runs[0]) point.place_m.z = normal(random);
  const ProfileRoughness noise = profile_roughness(runs, 1e-6);
  EXPECT_FALSE(noise.roughness);
  EXPECT_NE(noise.no_roughness.find("noise of the force"), std::string::npos) << noise.no_roughness;
  EXPECT_FALSE(profile_roughness({}, 0).roughness);
}

TEST(ProfileRoughness, FormIsNoRoughness) {
  std::vector<ProfilePoint> run;
  for (int i = 0; i < 2000; ++i) {
    const double way = 1e-4 * i, turn = way / 0.5;  // A cylinder of half a metre.
    run.push_back({way, {0.5 * std::sin(turn), 0, 0.5 * std::cos(turn)}, {std::sin(turn), 0, std::cos(turn)}});
  }
  const ProfileRoughness found = profile_roughness({run}, 1e-7);
  EXPECT_FALSE(found.roughness) << found.roughness->rms_m.value;
}

}  // namespace
}  // namespace papilla
