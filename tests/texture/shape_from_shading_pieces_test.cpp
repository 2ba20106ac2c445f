// SPDX-License-Identifier: MIT
// Pictures too large for one solve, in small: the pieces against the whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/texture/shading.hpp"
#include "papilla/texture/shape_from_shading.hpp"
#include "texture/fixtures.hpp"

namespace papilla {
namespace {

using Method = ShadingResult (*)(const GreyImage&, const ShadingOptions&);

/// A smooth periodic relief of many wavelengths, lit.
GreyImage lit_waves(int width, int height, Vec3 light) {
  const auto wave = [](double position, int count, int side, double phase) {
    return std::sin(2 * std::numbers::pi * count * position / side + phase);
  };
  const HeightMap relief = test::make_relief(width, height, 1, [&](int x, int y) {
    double sum = 0;
    for (const int n : {3, 11, 29}) sum += wave(x, n, width, n) * wave(y, n + 1, height, 2 * n) * width / (20.0 * n);
    return sum;
  });
  return render_lambert(relief, light);
}

/// Root mean square of the difference over the range of the second field.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  const auto [low, high] = std::minmax_element(b.begin(), b.end());
  return std::sqrt(squares / static_cast<double>(a.size())) / (*high - *low);
}

/// Largest step between the columns x − 1 and x over the largest one in the picture, x wrapped.
double step_across(const std::vector<double>& field, int width, int height, int x) {
  double here = 0, most = 0;
  for (int y = 0; y < height; ++y)
    for (int k = 0; k < width; ++k) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
      const double step = std::abs(field[row + static_cast<std::size_t>(k)] -
                                   field[row + static_cast<std::size_t>((k + width - 1) % width)]);
      most = std::max(most, step);
      if (k == x) here = std::max(here, step);
    }
  return here / most;
}

struct Case {
  Method method;
  bool periodic;
  double most;
};

class Pieces : public testing::TestWithParam<Case> {};

TEST_P(Pieces, AgreeWithTheWhole) {
  const Case& c = GetParam();
  const GreyImage image = lit_waves(512, 384, {-1, -0.5, 1.5});
  ShadingOptions options;
  options.light = {-1, -0.5, 1.5};
  options.albedo = 1;
  options.periodic = c.periodic;
  options.iterations = 40;
  const ShadingResult whole = c.method(image, options);
  options.largest_piece_px = 256;
  const ShadingResult pieces = c.method(image, options);
  EXPECT_LE(difference(pieces.height_px, whole.height_px), c.most);
  if (c.periodic) {
    EXPECT_LE(step_across(pieces.height_px, 512, 384, 0), 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Pieces,
                         testing::Values(Case{shape_from_shading_tsai_shah, false, 0},
                                         Case{shape_from_shading_tsai_shah, true, 0},
                                         Case{shape_from_shading_pentland, false, 0.02},
                                         Case{shape_from_shading_pentland, true, 0.02},
                                         Case{shape_from_shading_variational, false, 0.05},
                                         Case{shape_from_shading_variational, true, 0.02}));

TEST(ShapeFromShadingPieces, NarrowPeriodicPicturesAreThatOfTheWhole) {
  for (const auto& [width, height] : {std::pair{40, 600}, {600, 40}, {1, 500}}) {
    ShadingOptions options;
    options.periodic = true;
    options.iterations = 100;
    const GreyImage image = test::noise_image(width, height, 8);
    const std::vector<double> whole = shape_from_shading_tsai_shah(image, options).height_px;
    options.largest_piece_px = 256;
    EXPECT_EQ(shape_from_shading_tsai_shah(image, options).height_px, whole) << width;
  }
}

TEST(ShapeFromShadingPieces, StripsAndOddSidesGiveAsManyHeights) {
  for (const Method method :
       {shape_from_shading_tsai_shah, shape_from_shading_pentland, shape_from_shading_variational})
    for (const auto& [width, height] : {std::pair{1, 1000}, {1000, 1}, {129, 7}, {257, 131}})
      for (const bool periodic : {false, true}) {
        ShadingOptions options;
        options.largest_piece_px = 64;
        options.iterations = 3;
        options.periodic = periodic;
        const GreyImage image = test::noise_image(width, height, 5);
        const std::vector<double> heights = method(image, options).height_px;
        ASSERT_EQ(heights.size(), image.pixels.size());
        EXPECT_TRUE(std::all_of(heights.begin(), heights.end(), [](double z) { return std::isfinite(z); }));
      }
}

TEST(ShapeFromShadingPieces, ProgressRisesToOne) {
  for (const Method method :
       {shape_from_shading_tsai_shah, shape_from_shading_pentland, shape_from_shading_variational}) {
    double last = 0;
    bool falls = false;
    ShadingOptions options;
    options.largest_piece_px = 64;
    options.iterations = 5;
    options.progress = [&](const Progress& done) {
      falls |= done.fraction < last;
      last = done.fraction;
      return true;
    };
    method(test::noise_image(200, 150, 6), options);
    EXPECT_FALSE(falls);
    EXPECT_DOUBLE_EQ(last, 1);
  }
}

/// Without a tolerance a descent goes on until no step lowers the energy any more.
TEST(ShapeFromShadingPieces, SayThatTheLineSearchStalled) {
  ShadingOptions options{.iterations = 100'000, .relative_tolerance = 1e-300, .smoothness = 1};
  const GreyImage image = test::noise_image(100, 80, 9);
  ASSERT_EQ(shape_from_shading_variational(image, options).stop, StopReason::line_search_stalled);
  options.largest_piece_px = 64;
  EXPECT_EQ(shape_from_shading_variational(image, options).stop, StopReason::line_search_stalled);
}

TEST(ShapeFromShadingPieces, RefusesPiecesWithoutRoom) {
  ShadingOptions options;
  options.largest_piece_px = 63;
  EXPECT_THROW(shape_from_shading_variational(test::noise_image(80, 80, 7), options), InvalidInput);
}

}  // namespace
}  // namespace papilla
