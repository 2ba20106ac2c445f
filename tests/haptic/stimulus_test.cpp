// SPDX-License-Identifier: MIT
#include "papilla/haptic/stimulus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

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
  EXPECT_EQ(force_model("graph"), ForceModel::graph_orthogonal);
  for (const auto& [model, form, name] : {std::tuple{ForceModel::lateral, StimulusForm::usual, "gradient"},
                                          std::tuple{ForceModel::lateral, StimulusForm::displacement, "displacement"},
                                          std::tuple{ForceModel::graph_lateral, StimulusForm::usual, "path"},
                                          std::tuple{ForceModel::graph_orthogonal, StimulusForm::place, "place"}}) {
    EXPECT_EQ(name_of(model, form), name);
    EXPECT_EQ(stimulus_form(model, name), form);
  }
  EXPECT_EQ(stimulus_form(ForceModel::lateral, "place"), std::nullopt);
  EXPECT_EQ(stimulus_form(ForceModel::orthogonal, ""), std::nullopt);
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

/// A sine of 25 pixels of 0.2 mm along x: g = 128 (1 + 0.8 sin(2πx/λ)).
constexpr double k_wave = 5e-3;
HeightField sine() {
  std::vector<std::uint16_t> samples;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < k_pixels; ++x) {
      const double at = (x + 0.5) / k_pixels * k_size;
      samples.push_back(
          static_cast<std::uint16_t>(std::lround(32767.5 * (1 + 0.8 * std::sin(2 * std::numbers::pi * at / k_wave)))));
    }
  HeightFieldOptions options;
  options.scale_m = k_scale;
  options.interpolation = Interpolation::bspline;  // Bicubic values are clamped beside a crest.
  return HeightField(k_pixels, 4, samples, options);
}

/// Forces of a stroke with the probe 0.5 mm deep from `from` by `step` a tick; the proxy is where the probe is.
std::vector<Vec3> stroke(const ContactSurface& surface, Vec3 from, Vec3 step, int ticks, double period = 1e-3) {
  Stimulus stimulus(surface);
  ProxyState state;
  state.normal = {0, 0, 1};
  state.in_contact = true;
  std::vector<Vec3> forces;
  for (int i = 0; i < ticks; ++i) {
    state.proxy = from + static_cast<double>(i) * step;
    forces.push_back(stimulus.force(state, state.proxy - Vec3{0, 0, 5e-4}, (1 / period) * step, period, {}));
  }
  return forces;
}

ContactSurface sine_plate(ContactMaterial material) {
  material.stimulus = 0;
  // Pixels are square in this mapping: 4 rows over 0.8 mm.
  return ContactSurface(testing::plate(8, 1, k_size, 4 * k_size / k_pixels), {material}, {sine()}, 0);
}

TEST(Stimulus, LateralFormsFollowTheClosedFormOfASine) {
  const double turn = 2 * std::numbers::pi / k_wave, pixel = k_size / k_pixels, a = 0.01;
  const auto g = [&](double x) { return 128 * (1 + 0.8 * std::sin(turn * x)); };
  for (const bool literal : {false, true})
    for (const double v : {0.05, -0.1}) {
      ContactMaterial material;
      material.model = ForceModel::lateral;
      material.amplitude = a;
      material.literal_sign = literal;
      const double sign = literal ? 1 : -1;
      const Vec3 from{0.05, 2e-4, 0}, step{1e-3 * v, 0, 0};
      const std::vector<Vec3> gradient = stroke(sine_plate(material), from, step, 60);
      material.form = StimulusForm::displacement;
      const std::vector<Vec3> displacement = stroke(sine_plate(material), from, step, 60);
      const double most = a * 0.8 * 128 * turn * pixel;
      for (int i = 0; i < 60; ++i) {
        const double x = from.x + i * step.x;
        EXPECT_NEAR(gradient[static_cast<std::size_t>(i)].x, sign * most * std::cos(turn * x), 0.02 * most);
        EXPECT_NEAR(displacement[static_cast<std::size_t>(i)].x, sign * a * pixel * (g(x) - g(x - step.x)) / step.x,
                    0.02 * most);
        EXPECT_NEAR(displacement[static_cast<std::size_t>(i)].y, 0, 1e-12);
      }
    }
}

TEST(Stimulus, QuotientsOfADisplacementAcrossBothAxesAreThoseOfTheSource) {
  ContactMaterial material;
  material.model = ForceModel::lateral;
  material.amplitude = 0.01;
  material.form = StimulusForm::displacement;
  const ContactSurface surface = sine_plate(material);
  const double turn = 2 * std::numbers::pi / k_wave, pixel = k_size / k_pixels;
  const auto g = [&](double x) { return 128 * (1 + 0.8 * std::sin(turn * x)); };
  const Vec3 from{0.05, 2e-4, 0}, step{4e-5, 2e-5, 0};
  const Vec3 force = stroke(surface, from, step, 1).front();
  const double difference = g(from.x) - g(from.x - step.x);
  EXPECT_NEAR(force.x, -0.01 * difference * pixel / step.x, 0.02 * std::abs(force.x));
  EXPECT_NEAR(force.y, -0.01 * difference * pixel / step.y, 0.02 * std::abs(force.y));
  // A component is 0 below a hundredth of a pixel, all of them at rest.
  EXPECT_EQ(stroke(surface, from, {4e-5, 1e-6, 0}, 1).front().y, 0);
  EXPECT_EQ(norm(stroke(surface, from, {}, 1).front()), 0);
  // No steeper than a picture can be.
  EXPECT_LE(norm(stroke(surface, from, {2e-3, 3e-6, 0}, 1).front()), 0.01 * 256 * (1 + 1e-12));
}

ContactMaterial graph_material(ForceModel model, StimulusForm form, double hurst = 0.5) {
  ContactMaterial material;
  material.model = model;
  material.amplitude = 0.01;
  material.form = form;
  material.hurst = hurst;
  return material;
}

TEST(Stimulus, GraphIsThatOfTheMaterialsHurstExponentOverTheDistance) {
  for (const double hurst : {0.1, 0.8}) {
    const ContactSurface surface = sine_plate(graph_material(ForceModel::graph_orthogonal, StimulusForm::usual, hurst));
    const GreyGraph graph(hurst);
    const Vec3 step{3e-5, 0, 0};
    const std::vector<Vec3> forces = stroke(surface, {0.03, 2e-4, 0}, step, 100);
    for (int i = 0; i < 100; ++i)
      EXPECT_NEAR(forces[static_cast<std::size_t>(i)].z, 0.01 * (graph.at((i + 1) * 0.15) - graph.at(i * 0.15)), 1e-4)
          << hurst << ' ' << i;
  }
  const ContactSurface still = sine_plate(graph_material(ForceModel::graph_lateral, StimulusForm::usual));
  EXPECT_EQ(norm(stroke(still, {0.03, 2e-4, 0}, {}, 1).front()), 0);
}

TEST(Stimulus, GraphOverPlaceIsTheSameBackwards) {
  for (const ForceModel model : {ForceModel::graph_orthogonal, ForceModel::graph_lateral})
    for (const StimulusForm form : {StimulusForm::usual, StimulusForm::place}) {
      const ContactSurface surface = sine_plate(graph_material(model, form));
      constexpr int ticks = 80;
      const Vec3 from{0.03, 2e-4, 0}, step{7e-5, 0, 0};
      std::vector<Vec3> there, back;
      {
        // One stimulus for both ways.
        Stimulus stimulus(surface);
        ProxyState state;
        state.normal = {0, 0, 1};
        state.in_contact = true;
        for (int i = 0; i < 2 * ticks; ++i) {
          const bool forth = i < ticks;
          state.proxy = from + static_cast<double>(forth ? i : 2 * ticks - i - 2) * step;
          const Vec3 velocity = (forth ? 1e3 : -1e3) * step;
          (forth ? there : back).push_back(stimulus.force(state, state.proxy, velocity, 1e-3, {}));
        }
      }
      // From place p to p − w and back: the change of g is the opposite, and so is the way.
      const double sign = model == ForceModel::graph_orthogonal ? -1 : 1;
      double differs = 0;
      for (int i = 1; i < ticks - 1; ++i) {
        const Vec3 forward = there[static_cast<std::size_t>(i)],
                   backward = back[static_cast<std::size_t>(ticks - 1 - i)];
        differs = std::max(differs, norm(backward - sign * forward));
      }
      if (form == StimulusForm::place) {
        EXPECT_LT(differs, 2e-3) << name_of(model);
      } else {
        EXPECT_GT(differs, 0.02) << name_of(model);
      }
    }
}

TEST(Stimulus, GraphNeedsNoRelief) {
  ContactMaterial material = graph_material(ForceModel::graph_orthogonal, StimulusForm::place);
  const ContactSurface surface(testing::plate(8, 8, k_size, k_size), {material}, {}, 0);
  ProxyState state;
  state.in_contact = true;
  EXPECT_TRUE(Stimulus(surface).acts(state));
  const GreyGraph graph(0.5);
  const std::vector<Vec3> forces = stroke(surface, {0.05, 0.05, 0}, {5e-5, 0, 0}, 9);
  EXPECT_NEAR(forces[8].z, 0.01 * (graph.at(4.5) - graph.at(4)), 1e-9);
}

}  // namespace
}  // namespace papilla
