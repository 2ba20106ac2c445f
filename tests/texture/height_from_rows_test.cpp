// SPDX-License-Identifier: MIT
// A picture outside the memory against the same picture in it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/texture/height_from_image.hpp"
#include "papilla/texture/light_direction.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/tiling.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

/// Waves of 171, 47 and 18 pixels, which tile, lit.
GreyImage lit_waves(int width, int height) {
  const HeightMap relief = test::make_relief(width, height, 1, [&](int x, int y) {
    double sum = 0;
    for (const int n : {3, 11, 29})
      sum += std::sin(2 * std::numbers::pi * n * x / width + n) *
             std::sin(2 * std::numbers::pi * (n + 1) * y / height) * width / (20.0 * n);
    return sum;
  });
  return render_lambert(relief, {-1, -0.5, 1.5});
}

struct Case {
  HeightMethod method;
  bool periodic;
  double most;                ///< Root mean square of the difference over the depth.
  std::array<int, 2> pieces;  ///< Of 512 x 384 pixels at 256 pixels a side.
};

class HeightRowsOf : public testing::TestWithParam<Case> {};

TEST_P(HeightRowsOf, AgreeWithTheHeightsInMemory) {
  const Case& c = GetParam();
  const GreyImage image = lit_waves(512, 384);
  const SamplesInMemory picture(image.pixels, image.width, image.height);
  HeightOptions options;
  options.method = c.method;
  options.periodic = c.periodic;
  options.light = Vec3{-1, -0.5, 1.5};
  options.iterations = 40;
  options.pitch_mm = 0.1;
  const HeightResult whole = height_from_image(image, options);
  options.largest_piece_px = 256;
  const HeightResult pieces = height_from_image(image, options);
  const TemporaryFolder folder("papilla-test");
  SampleFile samples(512, 384, folder.path());
  const HeightRows rows = height_from_rows(picture, transfer_curve(options.transfer, image.bits), options, samples);
  const ScaledSamples relief(samples, rows.scale, rows.lowest);

  double squares = 0, most_off_pieces = 0;
  std::vector<float> row(512);
  for (int y = 0; y < 384; ++y) {
    relief.read(0, y, 512, row.data());
    for (int x = 0; x < 512; ++x) {
      const double height = static_cast<double>(row[static_cast<std::size_t>(x)]);
      squares += std::pow(height - static_cast<double>(whole.map.at(x, y)), 2);
      most_off_pieces = std::max(most_off_pieces, std::abs(height - static_cast<double>(pieces.map.at(x, y))));
    }
  }
  EXPECT_LE(std::sqrt(squares / (512 * 384)) / options.depth_mm, c.most);
  EXPECT_LE(most_off_pieces / options.depth_mm, 1e-6) << "the same pieces in memory, but for the rounding to floats";
  EXPECT_EQ(rows.result.depth_mm, whole.depth_mm);
  EXPECT_NEAR(rows.result.rms_mm, pieces.rms_mm, 1e-6);
  EXPECT_NEAR(rows.result.guessed_share, pieces.guessed_share, 1e-5);
  EXPECT_EQ(whole.pieces, (std::array{1, 1}));
  EXPECT_EQ(pieces.pieces, c.pieces);
  EXPECT_EQ(rows.result.pieces, c.pieces);
}

INSTANTIATE_TEST_SUITE_P(Methods, HeightRowsOf,
                         testing::Values(Case{HeightMethod::intensity, false, 1e-6, {1, 1}},
                                         Case{HeightMethod::tsai_shah, false, 1e-6, {2, 2}},
                                         Case{HeightMethod::tsai_shah, true, 1e-6, {2, 2}},
                                         Case{HeightMethod::pentland, false, 0.02, {4, 3}},
                                         Case{HeightMethod::pentland, true, 0.02, {4, 3}},
                                         Case{HeightMethod::wiener, false, 0.03, {4, 3}},
                                         Case{HeightMethod::wiener, true, 0.03, {4, 3}},
                                         Case{HeightMethod::variational, false, 0.05, {4, 3}},
                                         Case{HeightMethod::variational, true, 0.02, {4, 3}}));

TEST(HeightFromRows, NamesTheSampleThatIsNoNumber) {
  const GreyImage middle = lit_waves(64, 64);
  const TemporaryFolder folder("papilla-test");
  SampleFile samples(64, 64, folder.path());
  for (const HeightMethod method :
       {HeightMethod::intensity, HeightMethod::tsai_shah, HeightMethod::pentland, HeightMethod::variational})
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      GreyImage image = middle;
      image.at(3, 61) = value;
      const SamplesInMemory picture(image.pixels, 64, 64);
      try {
        height_from_rows(picture, transfer_curve(Transfer::automatic, middle.bits),
                         {.method = method, .periodic = false}, samples);
        ADD_FAILURE() << to_string(method);
      } catch (const InvalidInput& error) {
        EXPECT_STREQ(error.what(), "height_from_rows: sample [3, 61] is not a finite number");
      }
    }
}

TEST(HeightFromRows, RefusesWhatNeedsThePictureInMemory) {
  const GreyImage image = lit_waves(64, 64);
  const SamplesInMemory picture(image.pixels, 64, 64);
  const TemporaryFolder folder("papilla-test");
  SampleFile samples(64, 64, folder.path());
  EXPECT_THROW(height_from_rows(picture, {}, {.tile = true}, samples), InvalidInput);
  EXPECT_THROW(height_from_rows(picture, {}, {.roughness = HeightRoughness::none}, samples), InvalidInput);
}

TEST(SampleFile, GivesBackPartsOfRowsAndLeavesNoName) {
  const TemporaryFolder folder("papilla-test");
  SampleFile file(3, 2, folder.path());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  file.write(1, std::vector<float>{4, 5, 6});
  file.write(0, std::vector<float>{1, 2, 3});
  float two[2] = {};
  file.read(1, 1, 2, two);
  EXPECT_EQ(two[0], 5);
  EXPECT_EQ(two[1], 6);
  EXPECT_THROW(SampleFile(3, 2, folder.path() / "none"), IoError);
}

}  // namespace
}  // namespace papilla
