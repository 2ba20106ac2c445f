// SPDX-License-Identifier: MIT
#include "papilla/texture/wave_bands.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"
#include "papilla/texture/roughness.hpp"

namespace papilla {
namespace {

template <class Height>
HeightMap relief_of(int width, int height, double pitch_x, double pitch_y, Height&& at) {
  HeightMap relief{width, height, {}, pitch_x, pitch_y, true};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      relief.mm.push_back(static_cast<float>(at((x + 0.5) * pitch_x, (y + 0.5) * pitch_y)));
  return relief;
}

double total(const std::vector<WaveBand>& bands) {
  double sum = 0;
  for (const WaveBand& band : bands) sum += band.variance_mm2;
  return sum;
}

const WaveBand& strongest(const std::vector<WaveBand>& bands) {
  return *std::max_element(bands.begin(), bands.end(),
                           [](const WaveBand& a, const WaveBand& b) { return a.variance_mm2 < b.variance_mm2; });
}

TEST(WaveBands, AWaveIsInItsBandWhateverItsDirection) {
  constexpr double two_pi = 2 * std::numbers::pi;
  const auto along = wave_bands(
      relief_of(128, 64, 0.1, 0.2, [](double x, double) { return 0.03 * std::sin(two_pi * x / 0.8); }), true);
  const auto down = wave_bands(
      relief_of(128, 64, 0.1, 0.2, [](double, double y) { return 0.03 * std::sin(two_pi * y / 1.6); }), true);
  const auto oblique = wave_bands(
      relief_of(128, 64, 0.1, 0.2, [](double x, double y) { return 0.03 * std::sin(two_pi * (x / 0.8 + y / 1.6)); }),
      true);
  for (const auto& [bands, wave] :
       {std::pair{&along, 0.8}, std::pair{&down, 1.6}, std::pair{&oblique, 1 / std::hypot(1 / 0.8, 1 / 1.6)}}) {
    const WaveBand& band = strongest(*bands);
    EXPECT_LE(band.shortest_mm, wave);
    EXPECT_GT(band.longest_mm, wave);
    EXPECT_NEAR(band.variance_mm2, 0.5 * 0.03 * 0.03, 1e-8);
    EXPECT_NEAR(total(*bands), 0.5 * 0.03 * 0.03, 1e-8);
    EXPECT_NEAR(band.longest_mm / band.shortest_mm, std::cbrt(2), 1e-12);
  }
}

TEST(WaveBands, TheirSumIsTheVariance) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.2, 0.05);
  for (const auto& [width, height] : {std::pair{64, 48}, std::pair{31, 77}, std::pair{1, 40}, std::pair{50, 1}}) {
    const HeightMap relief = relief_of(width, height, 0.1, 0.15, [&](double, double) { return normal(random); });
    const double rms = rms_height_mm(relief);
    for (const bool repeats : {false, true}) {
      const auto bands = wave_bands(relief, repeats);
      EXPECT_NEAR(total(bands), rms * rms, 1e-6 * rms * rms) << width << " " << repeats;
      for (std::size_t i = 1; i < bands.size(); ++i) EXPECT_NEAR(bands[i].shortest_mm, bands[i - 1].longest_mm, 1e-12);
    }
  }
}

TEST(WaveBands, ASlopeThatDoesNotRepeatHasNoStepAtItsBorder) {
  const HeightMap slope = relief_of(256, 256, 0.1, 0.1, [](double x, double) { return x; });
  const auto fine = [&](bool repeats) {
    double sum = 0;
    for (const WaveBand& band : wave_bands(slope, repeats)) sum += band.longest_mm < 2 ? band.variance_mm2 : 0;
    return sum;
  };
  EXPECT_LT(fine(false), 1e-3 * fine(true));
}

TEST(WaveBands, RoughnessSpreadsByItsPowerLaw) {
  std::vector<WaveBand> bands;
  const RoughnessModel roughness{.hurst = 0.5, .rms_mm = 0.01, .shortest_mm = 0.25, .longest_mm = 1};
  add_roughness(bands, roughness);
  EXPECT_NEAR(total(bands), 1e-4, 1e-12);
  ASSERT_EQ(bands.size(), 7U);  // Two octaves, and the band that begins at 1 mm, empty.
  EXPECT_EQ(bands.back().variance_mm2, 0);
  EXPECT_NEAR(bands[5].variance_mm2 / bands[2].variance_mm2, 2, 1e-9);  // An octave apart: 2^2H.
  auto more = wave_bands(relief_of(64, 64, 0.1, 0.1, [](double x, double) { return std::sin(x); }), false);
  const double before = total(more);
  add_roughness(more, roughness);
  EXPECT_NEAR(total(more) - before, 1e-4, 1e-10);
}

TEST(WaveBands, RefusesWhatIsNoRelief) {
  EXPECT_TRUE(wave_bands(relief_of(8, 8, 1, 1, [](double, double) { return 2.0; }), true).empty());
  EXPECT_THROW(wave_bands({}, true), InvalidInput);
  EXPECT_THROW(wave_bands(relief_of(8, 8, 1, 0, [](double, double) { return 2.0; }), true), InvalidInput);
  const auto nan = [](double, double) { return std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_THROW(wave_bands(relief_of(8, 8, 1, 1, nan), true), InvalidInput);
}

}  // namespace
}  // namespace papilla
