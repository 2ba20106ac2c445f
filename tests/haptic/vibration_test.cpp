// SPDX-License-Identifier: MIT
#include "papilla/haptic/vibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptic/contact_shapes.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_long = 0.12, k_wide = 0.03;

/// Waves along x on an oblong plate; every sample is exact to 1/65535 of the height.
ContactSurface wavy_plate(double wave_m, double amplitude_m) {
  const int pixels = 4096;
  std::vector<std::uint16_t> samples;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < pixels; ++i)
      samples.push_back(static_cast<std::uint16_t>(
          std::lround(65535 * 0.5 * (1 + std::sin(2 * std::numbers::pi * (i + 0.5) / pixels * k_long / wave_m)))));
  HeightFieldOptions options;
  options.scale_m = 2 * amplitude_m;
  ContactMaterial material;
  material.stiffness = 500;
  material.height = 0;
  return ContactSurface(testing::plate(6, 2, k_long, k_wide), {material}, {HeightField(pixels, 4, samples, options)},
                        0);
}

struct Tone {
  double hz = 0, amplitude = 0;
};

/// Frequency by counting zero crossings, amplitude by the root mean square, of what is past the start.
Tone tone_of(const std::vector<float>& samples, double rate_hz) {
  const std::size_t first = samples.size() / 4;
  double squares = 0, begin = -1, end = -1;
  int crossings = 0;
  for (std::size_t i = first; i + 1 < samples.size(); ++i) {
    const double a = samples[i], b = samples[i + 1];
    squares += a * a;
    if (a > 0 || b <= 0) continue;
    const double at = static_cast<double>(i) + a / (a - b);
    if (begin < 0) begin = at;
    end = at;
    ++crossings;
  }
  return {(crossings - 1) * rate_hz / (end - begin),
          std::sqrt(2 * squares / static_cast<double>(samples.size() - first - 1))};
}

std::vector<float> stroke(const ContactSurface& surface, const VibrationOptions& options, double speed, double load,
                          double seconds, double touch_period_s = 0) {
  Vibration vibration(surface, options);
  std::vector<float> samples;
  const int ticks = static_cast<int>(seconds * options.rate_hz);
  for (int i = 0; i < ticks; ++i) {
    const double t = i / options.rate_hz;
    const bool touches = touch_period_s <= 0 || std::fmod(t, touch_period_s) < touch_period_s / 2;
    vibration.tick({{0.01 + speed * t, k_wide / 3, 5e-5}, load, touches}, samples);
  }
  return samples;
}

TEST(Vibration, IsTheAccelerationOfAWave) {
  struct Case {
    double wave_m, speed, rate_hz;
  };
  for (const Case c : {Case{2e-3, 0.1, 1000}, Case{1e-3, 0.1, 1000}, Case{4e-3, 0.08, 1000}, Case{5e-4, 0.1, 1000},
                       Case{2e-3, 0.13, 4000}, Case{1e-3, 0.09, 900}, Case{2.5e-4, 0.2, 1000}}) {
    constexpr double amplitude = 5e-6;
    VibrationOptions options;
    options.rate_hz = c.rate_hz;
    const auto samples = stroke(wavy_plate(c.wave_m, amplitude), options, c.speed, 100, 0.4);
    EXPECT_NEAR(static_cast<double>(samples.size()), 0.4 * options.sample_rate_hz, 60);
    const Tone tone = tone_of(samples, options.sample_rate_hz);
    const double hz = c.speed / c.wave_m, w = 2 * std::numbers::pi * hz;
    EXPECT_NEAR(tone.hz, hz, 5e-3 * hz) << c.wave_m << " " << c.speed << " " << c.rate_hz;
    EXPECT_NEAR(tone.amplitude, amplitude * w * w, 0.03 * amplitude * w * w) << c.wave_m << " " << c.speed;
  }
}

/// The filter's ripple of 0.1 dB lies as far above as below: at most half of it, 0.6 %, above.
TEST(Vibration, IsNowhereStrongerThanHalfTheRipple) {
  constexpr double amplitude = 5e-6;
  double largest = 0;
  for (double hz = 100; hz < 1000; hz *= 1.1) {
    const double wave = 0.12 / std::round(0.12 * hz / 0.1), w = 2 * std::numbers::pi * 0.1 / wave;
    VibrationOptions options;
    options.rate_hz = 4000;
    const double found =
        tone_of(stroke(wavy_plate(wave, amplitude), options, 0.1, 1000, 0.4), 48000).amplitude / (amplitude * w * w);
    largest = std::max(largest, found);
  }
  EXPECT_LT(largest, 1.0065);
  EXPECT_GT(largest, 1);
}

TEST(Vibration, WavesBeyondTheBandAreNeitherFeltNorFoldedIntoIt) {
  constexpr double amplitude = 2e-6, wave = 1e-4, speed = 0.25;  // 2500 Hz, more than twice a tick's way
  const auto samples = stroke(wavy_plate(wave, amplitude), {}, speed, 100, 0.3);
  const double w = 2 * std::numbers::pi * speed / wave;
  EXPECT_LT(tone_of(samples, 48000).amplitude, 2e-3 * amplitude * w * w);
}

TEST(Vibration, ALightHandIsThrownOffNoFasterThanItPresses) {
  constexpr double amplitude = 5e-5, load = 0.2;
  const auto samples = stroke(wavy_plate(1e-3, amplitude), {}, 0.2, load, 0.3);
  const float most = *std::max_element(samples.begin(), samples.end());
  EXPECT_LE(most, load / VibrationOptions{}.effective_mass_kg);
  EXPECT_GT(most, 0.9 * load / VibrationOptions{}.effective_mass_kg);
}

/// Waves far steeper than the hand can follow, under a load that grows by 1 N a tick: every sample is held to the load
/// of its own time, which comes two ticks late.
TEST(Vibration, StrengthFollowsTheLoadWithinATick) {
  const ContactSurface surface = wavy_plate(1e-3, 2e-4);
  VibrationOptions options;
  options.rate_hz = 100;
  Vibration vibration(surface, options);
  std::vector<float> samples;
  for (int i = 0; i < 12; ++i) vibration.tick({{0.01 + 2e-3 * i, k_wide / 3, 1e-4}, 1.0 * i, true}, samples);
  double closest = 0;
  for (std::size_t i = 480 * 4; i < samples.size(); ++i) {
    const double most = (static_cast<double>(i) / 480 - 2) / options.effective_mass_kg;
    EXPECT_LE(std::abs(static_cast<double>(samples[i])), most * (1 + 1e-6)) << i;
    closest = std::max(closest, std::abs(static_cast<double>(samples[i])) / most);
  }
  EXPECT_GT(closest, 0.9);
}

TEST(Vibration, ContactThatBeginsAndEndsClicksNot) {
  const ContactSurface flat = wavy_plate(1, 1e-9);
  for (const float a : stroke(flat, {}, 0.05, 1, 0.5, 0.04)) EXPECT_NEAR(a, 0, 1e-3);
  // Waves that are met at any height: nothing beyond their own amplitude, and half as steep as the band allows.
  constexpr double amplitude = 2e-5, wave = 1e-3, speed = 0.1, w = 2 * std::numbers::pi * speed / wave;
  const auto samples = stroke(wavy_plate(wave, amplitude), {}, speed, 100, 0.6, 0.05);
  double largest = 0, step = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(samples[i])));
    step = std::max(step, static_cast<double>(std::abs(samples[i] - samples[i - 1])));
  }
  EXPECT_LT(largest, 1.3 * amplitude * w * w);
  EXPECT_LT(step, 0.5 * amplitude * w * w * 2 * std::numbers::pi * VibrationOptions{}.high_hz / 48000);
}

TEST(Vibration, IsSilentWithoutMovementOrLoad) {
  const ContactSurface surface = wavy_plate(1e-3, 2e-5);
  for (const float a : stroke(surface, {}, 0, 1, 0.3)) EXPECT_NEAR(a, 0, 1e-6);
  for (const float a : stroke(surface, {}, 0.1, 0, 0.3)) EXPECT_EQ(a, 0);
}

TEST(Vibration, OptionsOutOfRangeAreRefused) {
  const ContactSurface surface = wavy_plate(1e-3, 1e-5);
  for (const VibrationOptions& bad :
       {VibrationOptions{.rate_hz = 50}, VibrationOptions{.sample_rate_hz = 1000}, VibrationOptions{.low_hz = 0},
        VibrationOptions{.low_hz = 2000}, VibrationOptions{.high_hz = 30000}, VibrationOptions{.effective_mass_kg = 0}})
    EXPECT_THROW(Vibration(surface, bad), InvalidInput);
}

}  // namespace
}  // namespace papilla
