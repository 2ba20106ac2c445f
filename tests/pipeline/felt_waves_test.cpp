// SPDX-License-Identifier: MIT
#include "papilla/pipeline/felt_waves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "papilla/io/image_file.hpp"
#include "papilla/texture/resample.hpp"

namespace papilla {
namespace {

/// A band around a wavelength with a single wave of that amplitude.
WaveBand band(double wave_mm, double amplitude_mm) {
  return {wave_mm * std::exp2(-1.0 / 6), wave_mm * std::exp2(1.0 / 6), 0.5 * amplitude_mm * amplitude_mm};
}

TEST(FeltWaves, ThresholdIsThePublishedCurve) {
  const double db_per_octave = 20 * std::log10(vibrotactile_threshold_m(80) / vibrotactile_threshold_m(160));
  EXPECT_NEAR(db_per_octave, 12, 0.1);                                            // Verrillo 1963.
  EXPECT_NEAR(20 * std::log10(vibrotactile_threshold_m(250) / 1e-6), -20, 1e-9);  // dB re 1 um.
  EXPECT_EQ(vibrotactile_threshold_m(1), vibrotactile_threshold_m(40));
  EXPECT_NEAR(vibrotactile_threshold_m(40), 3.9e-6, 0.01e-6);
  EXPECT_NEAR(vibrotactile_threshold_m(500), 4e-7, 1e-12);
  EXPECT_TRUE(std::isfinite(vibrotactile_threshold_m(1000)));
  EXPECT_TRUE(std::isinf(vibrotactile_threshold_m(1001)));
}

TEST(FeltWaves, ReceptorsAnswerToTheirFrequencies) {
  struct Case {
    double wave_mm;
    std::array<double, 4> share;
    double unfelt;
  };
  // At 0.1 m/s: 0.5 Hz, 5 Hz, 40 Hz, 100 Hz, 400 Hz, 1250 Hz.
  for (const Case& c : {Case{200, {0, 0, 0, 0}, 0}, Case{20, {1, 1, 0, 0}, 0}, Case{2.5, {1, 1, 1, 0}, 0},
                        Case{1, {1, 1, 1, 1}, 0}, Case{0.25, {0, 0, 0, 1}, 0}, Case{0.08, {0, 0, 0, 0}, 1}}) {
    const std::vector<WaveBand> bands = {band(c.wave_mm, 0.01)};
    const FeltWaves felt = measure_felt_waves(bands);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(felt.receptors[k].variance_share, c.share[k], 1e-12) << c.wave_mm;
    EXPECT_NEAR(felt.unfelt_share, c.unfelt, 1e-12);
    EXPECT_NEAR(std::sqrt(felt.slowest_hz * felt.fastest_hz), 100 / c.wave_mm, 1e-9);
  }
}

TEST(FeltWaves, PowersOverTheThresholdAddUp) {
  const std::vector<WaveBand> one = {band(0.4, 3e-4)};  // 250 Hz, three times the threshold.
  EXPECT_NEAR(measure_felt_waves(one).times_threshold, 3, 1e-9);
  EXPECT_NEAR(measure_felt_waves(one).roughness, 3, 1e-9);
  const std::vector<WaveBand> two = {band(0.4, 3e-4), band(0.8, 16e-4),
                                     band(4, 0.05)};  // 4 times at 125 Hz, 12.8 at 25 Hz.
  const FeltWaves felt = measure_felt_waves(two);
  EXPECT_NEAR(felt.roughness, 5, 1e-9);  // Without what is coarser than 1 mm.
  EXPECT_NEAR(felt.times_threshold, std::hypot(5, 0.05 / 3.90625e-3), 1e-6);
  EXPECT_NEAR(felt.receptors[3].times_threshold, 5, 1e-9);
  EXPECT_GE(felt.most_times_threshold, felt.times_threshold);
}

TEST(FeltWaves, WhatIsTogetherFarBelowTheThresholdMayBeLeftOut) {
  // At some of the speeds every wave is at 250 Hz, where 10 nm are a tenth of the threshold.
  EXPECT_TRUE(measure_felt_waves(std::vector{band(0.4, 0.9e-5)}).may_be_left_out);
  EXPECT_FALSE(measure_felt_waves(std::vector{band(0.4, 1.2e-5)}).may_be_left_out);
  EXPECT_TRUE(measure_felt_waves(std::vector{band(0.4, 0.9e-4)}, {.margin = 1}).may_be_left_out);
  std::vector<WaveBand> many;
  for (int i = 0; i < 9; ++i) many.push_back(band(0.3 * std::exp2(i / 30.0), 0.5e-5));
  EXPECT_FALSE(measure_felt_waves(many).may_be_left_out);
  EXPECT_TRUE(measure_felt_waves({}).may_be_left_out);
}

TEST(FeltWaves, TheFinestWaveThatIsFelt) {
  const std::vector<WaveBand> bands = {band(0.015, 1e-2), band(0.1, 1e-6), band(0.4, 1e-6), band(2, 0.02),
                                       band(5, 0.1)};
  const FeltWaves felt = measure_felt_waves(bands);  // 0.015 mm is faster than 1 kHz even at 20 mm/s.
  EXPECT_FALSE(felt.may_be_left_out);
  EXPECT_EQ(felt.finest_felt_mm, bands[3].shortest_mm);
  EXPECT_EQ(measure_felt_waves(std::vector{band(2, 0.02)}).finest_felt_mm, 0);
  EXPECT_NEAR(finest_wave_mm({}), 0.02, 1e-12);
  // A stroke of 2 mm/s brings it to 133 Hz: then nothing may be left out.
  EXPECT_EQ(measure_felt_waves(bands, {.speed_m_per_s = 0.01}).finest_felt_mm, 0);
}

HeightMap wavy(double fine_amplitude_mm) {
  HeightMap relief{512, 256, {}, 16.0 / 512, 8.0 / 256, true};
  constexpr double two_pi = 2 * std::numbers::pi;
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x)
      relief.mm.push_back(static_cast<float>(0.05 * std::sin(two_pi * 4 * (x + 0.5) / 512) +
                                             fine_amplitude_mm * std::sin(two_pi * 160 * (x + 0.5) / 512)));
  return relief;
}

TEST(FeltWaves, LeavingOutSavesSamplesAndBytesButNothingThatIsFelt) {
  const HeightMap relief = wavy(2e-6);  // 2 nm of 0.1 mm beside 50 um of 4 mm.
  const FeltWaves felt = measure_felt_waves(wave_bands(relief, true));
  EXPECT_GT(felt.finest_felt_mm, 1);
  const std::size_t bytes = encode_height_png16(relief).png.size();
  const ReliefSaving saving = measure_relief_saving(relief, felt, bytes);
  ASSERT_TRUE(saving.saves());
  EXPECT_EQ(saving.width, 512);
  EXPECT_LT(saving.needed_width, 32);
  EXPECT_GE(saving.needed_width, 16);
  EXPECT_LT(saving.needed_bytes, bytes / 10);
  const HeightMap back = resample(resample(relief, saving.needed_width, saving.needed_height), 512, 256);
  double worst = 0;
  for (std::size_t i = 0; i < back.mm.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(back.mm[i]) - static_cast<double>(relief.mm[i])));
  EXPECT_LT(worst, 2.1e-6);
}

/// 512 columns are as long as 256 rows that lie twice as far apart.
TEST(FeltWaves, RowsThatLieFartherApartAreNeededAsOften) {
  HeightMap relief = wavy(2e-6);
  ASSERT_EQ(relief.width, 2 * relief.height);
  relief.pitch_mm_y = 2 * relief.pitch_mm_x;
  const FeltWaves felt = measure_felt_waves(wave_bands(relief, true));
  const ReliefSaving saving = measure_relief_saving(relief, felt, encode_height_png16(relief).png.size());
  ASSERT_TRUE(saving.saves());
  EXPECT_GT(saving.needed_height, 1);
  EXPECT_EQ(saving.needed_height, saving.needed_width);
}

TEST(FeltWaves, WhatIsFeltIsNeeded) {
  const HeightMap relief = wavy(1e-3);
  const ReliefSaving all = measure_relief_saving(relief, measure_felt_waves(wave_bands(relief, true)), 1000);
  EXPECT_FALSE(all.saves());
  EXPECT_EQ(all.needed_width, 512);
  HeightMap flat = relief;
  for (float& h : flat.mm) h *= 1e-7F;
  const ReliefSaving none = measure_relief_saving(flat, measure_felt_waves(wave_bands(flat, true)), 1000);
  EXPECT_EQ(none.needed_bytes, 0U);
  EXPECT_EQ(none.needed_width, 0);
}

}  // namespace
}  // namespace papilla
