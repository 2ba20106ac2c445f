// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "papilla/core/error.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

constexpr unsigned k_bump = 1U << static_cast<unsigned>(Channel::bump);

std::vector<float> bump_of(const std::string& recipe, int size, CompileOptions options = {}) {
  return test::rendered(recipe, size, RecipeLibrary::builtin(), std::move(options), k_bump).values[Channel::bump];
}
double at(const std::vector<float>& picture, int size, int x, int y) {
  return static_cast<double>(picture[static_cast<std::size_t>(y * size + x)]);
}
/// Share of a disc of radius 1 that lies beyond a line at distance d from its centre, on the centre's side for d > 0.
double share_of_disc(double d) {
  d = std::clamp(d, -1.0, 1.0);
  return 0.5 + (d * std::sqrt(1 - d * d) + std::asin(d)) / std::numbers::pi;
}

TEST(Neighbourhood, MeanAndDeviationOfAStepFollowTheDisc) {
  // Radii below and above those where the grid is coarser than the texels.
  for (const double radius : {0.03, 0.1, 0.2}) {
    const std::string near = "(step(x,.5)," + std::to_string(radius) + ")";
    const auto mean = bump_of("base|bumpfunction=nearmean" + near, 200);
    const auto deviation = bump_of("base|bumpfunction=neardeviation" + near, 200);
    for (int x = 45; x < 155; x += 3) {
      const double share = share_of_disc(((x + 0.5) / 200 - 0.5) / radius);
      EXPECT_NEAR(at(mean, 200, x, 100), share, 0.03) << radius << ' ' << x;
      EXPECT_NEAR(at(deviation, 200, x, 100), std::sqrt(share * (1 - share)), 0.07) << radius << ' ' << x;
    }
  }
}

TEST(Neighbourhood, LeastAndMostReachARadiusFar) {
  const auto most = bump_of("base|bumpfunction=nearmax(step(x,.5),.1)", 200),
             least = bump_of("base|bumpfunction=nearmin(step(x,.5),.1)", 200);
  for (const int y : {20, 100}) {
    EXPECT_EQ(at(most, 200, 75, y), 0);  // 0.1225 from the edge.
    EXPECT_EQ(at(most, 200, 84, y), 1);  // 0.0775.
    EXPECT_EQ(at(least, 200, 124, y), 1);
    EXPECT_EQ(at(least, 200, 115, y), 0);
  }
}

TEST(Neighbourhood, SlopeOfAPlaneIsItsGradientUpToTheBorders) {
  for (const char* radius : {".02", ".15"}) {
    const auto slope = bump_of("base|bumpfunction=nearslope(.6*x-.8*y," + std::string(radius) + ")", 96);
    for (const int x : {0, 40, 95})
      for (const int y : {0, 50, 95}) EXPECT_NEAR(at(slope, 96, x, y), 1, 0.02) << radius << ' ' << x << ' ' << y;
  }
  // In the units of the texture: a quarter of the size, four times as steep a picture.
  const auto scaled = bump_of("base|scale=.25|bumpfunction=nearslope(x,.2)", 96);
  EXPECT_NEAR(at(scaled, 96, 40, 40), 1, 0.02);
}

TEST(Neighbourhood, EqualsSumsOverAllTexelsNearby) {
  constexpr int size = 40;
  constexpr double radius = 6;
  const auto value = bump_of("noise|scale=.3|bumpfunction=main", size);
  const auto mean = bump_of("noise|scale=.3|afunction=0|bumpfunction=nearmean(main,.5)", size),
             least = bump_of("noise|scale=.3|bumpfunction=nearmin(main,.5)", size);
  for (const int y : {3, 17, 38})
    for (const int x : {0, 20, 33}) {
      double sum = 0, weight = 0, smallest = 1e30;
      for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) {
          const double d = std::hypot(i - x, j - y), w = std::clamp(radius - d + 0.5, 0.0, 1.0);
          sum += w * at(value, size, i, j), weight += w;
          if (d <= radius) smallest = std::min(smallest, at(value, size, i, j));
        }
      EXPECT_NEAR(at(mean, size, x, y), sum / weight, 1e-5);
      EXPECT_NEAR(at(least, size, x, y), smallest, 1e-6);
    }
}

TEST(Neighbourhood, StaysSeamless) {
  // The same picture, shifted by half of itself; the largest radius takes blocks of four texels.
  for (const char* radius : {".04", ".2", ".9"}) {
    const std::string recipe =
        "fbm|seamless=true|scale=.5|bumpfunction=nearmean(main," + std::string(radius) + ")+nearmax(main,.1)";
    const auto one = bump_of(recipe, 64), other = bump_of(recipe + "|du=1|dv=1", 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        ASSERT_NEAR(at(one, 64, x, y), at(other, 64, (x + 32) % 64, (y + 32) % 64), 1e-6) << radius;
  }
}

TEST(Neighbourhood, TheMeanOfASlantedPlaneIsThePlaneInAPictureThatIsNotSquare) {
  // The radius is 4.2 texels: every block is one.
  RenderOptions render;
  render.width = 48, render.height = 21, render.channels = k_bump;
  const std::vector<float> mean =
      render_texture(compile_texture("base|bumpfunction=nearmean(x+3*y,.2)", {}), render).values[Channel::bump];
  for (int y = 10; y < 12; ++y)
    for (int x = 12; x < 36; ++x)
      EXPECT_NEAR(at(mean, 48, x, y), (x + 0.5) / 21 + 3 * (y + 0.5) / 21, 0.01) << x << ' ' << y;
}

TEST(Neighbourhood, AnUprightMirrorImageHasTheSameMeansUpsideDown) {
  // A radius of 58.5 texels takes blocks of 8: nine of them in 65 rows, which are not quite as high.
  RenderOptions render;
  render.width = 128, render.height = 65, render.channels = k_bump;
  const std::vector<float> mean =
      render_texture(compile_texture("base|bumpfunction=nearmean((2*y-1)^2,.9)", {}), render).values[Channel::bump];
  for (const int x : {20, 64, 110})
    for (int y = 0; y < 32; ++y) EXPECT_NEAR(at(mean, 128, x, y), at(mean, 128, x, 64 - y), 0.01) << x << ' ' << y;
  EXPECT_GT(at(mean, 128, 64, 32), at(mean, 128, 64, 0) + 0.02);
}

TEST(Neighbourhood, LayersReadWhatTheLayersBelowGive) {
  // The second statistic rests on the first one, through a layer.
  const std::string base = "[base|bumpfunction=step(x,.5)]",
                    first = "[base|bumpblend=interpolate|bumpfunction=nearmax(lowerbump,.1)]",
                    second = "[base|bumpblend=interpolate|bumpfunction=nearmin(lowerbump,.1)]";
  const auto grown = bump_of("multi|textures=" + base + "," + first, 100);
  EXPECT_EQ(at(grown, 100, 45, 50), 1);
  EXPECT_EQ(at(grown, 100, 35, 50), 0);
  const auto back = bump_of("multi|textures=" + base + "," + first + "," + second, 100);
  for (int x = 20; x < 80; ++x) {
    if (x > 46 && x < 54) continue;  // The grid has 2 texels.
    EXPECT_EQ(at(back, 100, x, 50), x < 50 ? 0 : 1) << x;
  }
}

TEST(Neighbourhood, ScatteredPointsOfARasterKnowTheirNeighbours) {
  // The points in any order, half of them missing: the others are no neighbours.
  const auto texture = compile_texture("base|bumpfunction=nearmean(x,.2)", RecipeLibrary::builtin());
  std::vector<double> x, y;
  std::vector<std::uint32_t> place;
  for (std::uint32_t k = 0; k < 1600; ++k)
    if (k % 40 < 20) place.push_back(k);
  std::shuffle(place.begin(), place.end(), std::mt19937(1));
  for (const std::uint32_t k : place) x.push_back((k % 40 + 0.5) / 40), y.push_back((k / 40 + 0.5) / 40);
  TexturePoints points{x, y, {}, {}, {}, {}};
  points.raster = {40, 40, false, place};
  const TextureValues values = evaluate_texture(texture, points, k_bump, 1.0 / 40);
  for (std::size_t i = 0; i < place.size(); ++i) {
    EXPECT_GT(values[Channel::bump][i], 0.05);
    EXPECT_LT(values[Channel::bump][i], 0.45);
    if (place[i] % 40 == 10 && place[i] / 40 == 20) {
      EXPECT_NEAR(values[Channel::bump][i], 10.5 / 40, 0.02);
    }
  }
  points.raster = {};
  EXPECT_FLOAT_EQ(evaluate_texture(texture, points, k_bump, 1.0 / 40)[Channel::bump][0], static_cast<float>(x[0]));
  const std::vector<std::uint32_t> outside(x.size(), 1600);
  points.raster = {40, 40, false, outside};
  EXPECT_THROW(evaluate_texture(texture, points, k_bump, 1.0 / 40), InvalidInput);
}

TEST(Neighbourhood, RefusesWhatItCannotDo) {
  const auto refused = [](const char* recipe, const char* words) {
    try {
      compile_texture(recipe, RecipeLibrary::builtin());
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      return;
    }
    ADD_FAILURE() << recipe;
  };
  refused("base|bumpfunction=nearmean(x,x)", "line 1, column 19: the radius of 'nearmean'");
  refused("base|bumpfunction=nearmean(x,0)", "the radius of 'nearmean'");
  refused("base|seamless=true|mainfunction=nearmean(x,.1)", "four corners");
  refused("image|basetexture=[base|mainfunction=nearmean(x,.1)]", "rendered once");
  RenderOptions options;
  options.width = options.height = 16384, options.channels = k_bump;
  EXPECT_THROW(render_texture(compile_texture("base|bumpfunction=nearmean(x,.1)", {}), options), InvalidInput);
}

TEST(Neighbourhood, GrimeLiesInHollowsAndWearOnEdges) {
  const std::string ground = "[base|bumpfunction=.5+.4*s(x*40)]";
  for (const auto& [layer, in_hollows] : {std::pair{"grime", true}, std::pair{"edge_wear", false}}) {
    const auto cover = test::rendered("multi|textures=" + ground + ",[base|alphafunction=0|mainfunction=0],[" + layer +
                                          "|mainfunction=.5|frictionfunction=9]",
                                      128, RecipeLibrary::builtin(), test::at_time(0.8),
                                      1U << static_cast<unsigned>(Channel::friction))
                           .values[Channel::friction];
    double low = 0, high = 0;
    for (int i = 0; i < 128; ++i) {
      const double height = std::sin((i + 0.5) / 128 * 40);
      (height < 0 ? low : high) += at(cover, 128, i, 64);
    }
    EXPECT_GT(in_hollows ? low / high : high / low, 1.5) << layer;
  }
}

}  // namespace
}  // namespace papilla
