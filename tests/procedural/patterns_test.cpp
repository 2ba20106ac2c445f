// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "papilla/procedural/texture.hpp"

namespace papilla {
namespace {

constexpr unsigned k_main = 1U << static_cast<unsigned>(Channel::main);

/// A picture of three columns and two rows whose channels are all different.
RecipePicture oblong_picture() {
  return {3, 2, {.1F, .2F, .3F, .4F, .5F, .6F, .7F, .8F, .9F, .9F, .1F, .5F, .6F, .4F, .2F, .3F, .7F, .1F}};
}

std::vector<float> main_at(const std::string& recipe, const std::vector<double>& x, const std::vector<double>& y,
                           double texel = 0, std::uint32_t seed = 0) {
  CompileOptions options;
  options.seed = seed;
  options.read_picture = [](const std::string&) { return oblong_picture(); };
  return evaluate_texture(compile_texture(recipe, RecipeLibrary::builtin(), options), {x, y, {}, {}, {}, {}}, k_main,
                          texel)
      .channels[0];
}
double main_at(const std::string& recipe, double x, double y, double texel = 0) {
  return static_cast<double>(main_at(recipe, std::vector{x}, std::vector{y}, texel)[0]);
}

double luminance(int column, int row) {
  const auto picture = oblong_picture();
  const auto* rgb = &picture.rgb[static_cast<std::size_t>(3 * (3 * row + column))];
  return 0.2126 * static_cast<double>(rgb[0]) + 0.7152 * static_cast<double>(rgb[1]) +
         0.0722 * static_cast<double>(rgb[2]);
}

TEST(Image, AnOblongPictureHasItsRowsAndColumnsAndRepeatsInBothDirections) {
  const std::string recipe = "image|picpath=p.png|ipol=0";
  for (int row = -2; row < 4; ++row)
    for (int column = -3; column < 6; ++column) {
      const double x = (column + 0.5) / 3, y = (row + 0.5) / 2;
      EXPECT_NEAR(main_at(recipe, x, y), luminance((column + 3) % 3, (row + 2) % 2), 1e-6) << column << ' ' << row;
      EXPECT_NEAR(main_at(recipe + "|repeat=false", x, y), luminance(std::clamp(column, 0, 2), std::clamp(row, 0, 1)),
                  1e-6)
          << column << ' ' << row;
    }
}

TEST(Image, ValuesBetweenRowsAreThoseOfBothRows) {
  const std::string recipe = "image|picpath=p.png|ipol=1";
  EXPECT_NEAR(main_at(recipe, 0.5 / 3, 0.5), (luminance(0, 0) + luminance(0, 1)) / 2, 1e-6);
  EXPECT_NEAR(main_at(recipe, 0.5 / 3, 0.375), 0.75 * luminance(0, 0) + 0.25 * luminance(0, 1), 1e-6);
  EXPECT_NEAR(main_at(recipe, 0.5 / 3, 0.125), 0.75 * luminance(0, 0) + 0.25 * luminance(0, 1), 1e-6);  // Above is 1.
}

TEST(Image, ARenderedRecipeFillsAnOblongPicture) {
  for (const auto& [width, height] : {std::pair(16, 40), std::pair(40, 16)}) {
    const std::string recipe = "image|fit2screen=false|ipol=0|width=" + std::to_string(width) +
                               "|height=" + std::to_string(height) + "|basetexture=[base|mainfunction=x+10*y]";
    for (const int k : {0, 7, 15}) {
      const double x = (k + 0.5) / width, y = (k + 0.5) / height;
      EXPECT_NEAR(main_at(recipe, x, y), x + 10 * y, 1e-5) << width << ' ' << k;
    }
    EXPECT_NEAR(main_at(recipe, 0.999, 0.999), (width - 0.5) / width + 10 * (height - 0.5) / height, 1e-5);
  }
}

TEST(Text, SlantedLettersLeanToTheRight) {
  std::vector<double> x, y;
  for (int row = 0; row < 90; ++row)
    for (int column = 0; column < 60; ++column) x.push_back((column + 0.5) / 60), y.push_back((row + 0.5) / 90);
  const auto middle = [&](const std::vector<float>& ink, int first, int last) {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < ink.size(); ++i) {
      if (static_cast<int>(i) / 60 < first || static_cast<int>(i) / 60 >= last) continue;
      sum += static_cast<double>(ink[i]) * x[i], weight += static_cast<double>(ink[i]);
    }
    return sum / weight;
  };
  const auto plain = main_at("txt|txt=H|modifier=0", x, y), slanted = main_at("txt|txt=H|modifier=2", x, y);
  EXPECT_NEAR(middle(plain, 10, 30), middle(plain, 50, 70), 1e-6);
  EXPECT_GT(middle(slanted, 10, 30), middle(slanted, 50, 70) + 0.05);
}

TEST(Text, ATexelOnACornerOfADotIsCoveredByAQuarter) {
  // One character: 6 dots wide, 9 high, in a unit of 9 dots. The dash is row 3 of the letter, whose rows begin at 1.
  const double left = 0.5 - 3.0 / 9, top = 4.0 / 9;
  EXPECT_EQ(main_at("txt|txt=-", left + 0.1, top, 0.02), 0.5);
  EXPECT_EQ(main_at("txt|txt=-", left, top + 0.05, 0.02), 0.5);
  EXPECT_EQ(main_at("txt|txt=-", left, top, 0.02), 0.25);
  EXPECT_EQ(main_at("txt|txt=-", left + 0.1, top + 0.05, 0.02), 1);
}

TEST(Weave, AMatrixOfUnequalRowsAndColumnsIsReadRowByRow) {
  const std::string matrix = "100111";  // Two rows of three.
  const std::string recipe = "weave|rows=2|columns=3|matrix=" + matrix + "|shadecrossings=true|roundthreads=false";
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 3; ++column) {
      const bool across = matrix[static_cast<std::size_t>(3 * row + column)] == '1';
      // A fifth of a crossing away from its middle, along the thread that runs across: only that one dives there.
      EXPECT_NEAR(main_at(recipe, (column + 0.7) / 3, (row + 0.5) / 2),
                  across ? 0.6 + 0.4 * std::cos(0.2 * std::numbers::pi) : 1, 1e-6)
          << column << ' ' << row;
      EXPECT_NEAR(main_at(recipe, (column + 0.5) / 3, (row + 0.7) / 2),
                  across ? 1 : 0.6 + 0.4 * std::cos(0.2 * std::numbers::pi), 1e-6)
          << column << ' ' << row;
    }
}

TEST(Weave, ThreadsHaveTheirOwnWidths) {
  // Those that run down fill 0.9 of a crossing, those across half of one.
  const std::string recipe = "weave|rows=1|columns=1|matrix=1|xwidth=9|xgap=1|ywidth=5|ygap=5|shadecrossings=false";
  EXPECT_NEAR(main_at(recipe, 0.96, 0.5), 1, 1e-6);
  EXPECT_NEAR(main_at(recipe, 0.96, 0.78), 0, 1e-6);
  EXPECT_NEAR(main_at(recipe, 0.9, 0.78), 0.2, 1e-6);
  EXPECT_NEAR(main_at(recipe, 0.9, 0.74), 1, 1e-6);
}

TEST(Block, NumbersAreThoseOfReadingOrder) {
  // Five columns and two rows, every other one divided into three by two.
  const std::string recipe = "block|subx=5|suby=2|subx2=3|suby2=2|mainfunction=get(10)";
  std::set<double> numbers;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 5; ++column) {
      const double x = (column + 0.9) / 5, y = (row + 0.6) / 2;
      const int part = (row + column) % 2 == 1 ? 3 + 2 : 0;  // Third column and second row of its parts.
      EXPECT_EQ(main_at(recipe, x, y), (5 * row + column) * 6 + part) << column << ' ' << row;
      numbers.insert(main_at(recipe, x, y));
    }
  EXPECT_EQ(numbers.size(), 10U);
}

TEST(Noise, SlopesAlongTheThreeAxesHaveNothingToDoWithEachOther) {
  const auto slopes = [](const char* formula) {
    std::vector<double> x, y;
    for (int i = 0; i < 30; ++i)
      for (int j = 0; j < 30; ++j) x.push_back(i), y.push_back(j);
    return main_at("base|mainfunction=" + std::string(formula), x, y);
  };
  const std::vector<float> along[] = {slopes("noise3d(x+.01,y,3)"), slopes("noise3d(x,y+.01,3)"),
                                      slopes("noise3d(x,y,3.01)")};
  const auto product = [&](int a, int b) {
    return std::inner_product(along[a].begin(), along[a].end(), along[b].begin(), 0.0);
  };
  for (int a = 0; a < 3; ++a) {
    EXPECT_GT(product(a, a), 0) << a;
    for (int b = 0; b < a; ++b)
      EXPECT_LT(std::abs(product(a, b)), 0.15 * std::sqrt(product(a, a) * product(b, b))) << a << ' ' << b;
  }
}

TEST(Fbm, WhereHybridTerrainIsHighEveryOctaveHasItsFullWeight) {
  // With a large offset all weights are cut to 1, and the sum is that of plain fbm but for scale and offset.
  std::vector<double> x, y;
  for (int i = 0; i < 500; ++i) x.push_back(0.137 * i), y.push_back(0.731 * i);
  const std::string octaves = "|octaves=2|weights=1 .5";
  const auto hybrid = main_at("fbm|type=hybridmultifractal|offset=20" + octaves, x, y),
             plain = main_at("fbm|type=fbm" + octaves, x, y);
  double sh = 0, sp = 0, hh = 0, pp = 0, hp = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double h = static_cast<double>(hybrid[i]), p = static_cast<double>(plain[i]);
    if (h <= 0 || h >= 1) continue;  // Cut off.
    sh += h, sp += p, hh += h * h, pp += p * p, hp += h * p, ++count;
  }
  const auto n = static_cast<double>(count);
  ASSERT_GT(count, 300U);
  EXPECT_NEAR((hp - sh * sp / n) / std::sqrt((hh - sh * sh / n) * (pp - sp * sp / n)), 1, 1e-5);
}

TEST(SeamlessCells, PointsRepelEachOtherAcrossBothBorders) {
  // Places of the points, by the number of the next point to a grid of places.
  std::vector<double> x, y;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) x.push_back((i + 0.5) / 60), y.push_back((j + 0.5) / 60);
  double least = 1;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const std::string recipe = "voronoiseamless|points=9|smoothiterations=200|mainfunction=";
    const auto px = main_at(recipe + "get(0)", x, y, 0, seed), py = main_at(recipe + "get(1)", x, y, 0, seed);
    std::set<std::pair<double, double>> found;
    for (std::size_t i = 0; i < px.size(); ++i) found.emplace(static_cast<double>(px[i]), static_cast<double>(py[i]));
    ASSERT_EQ(found.size(), 9U) << seed;
    const std::vector<std::pair<double, double>> sites(found.begin(), found.end());
    const auto wrapped = [](double d) { return d - std::round(d); };
    for (std::size_t i = 0; i < sites.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        least = std::min(
            least, std::hypot(wrapped(sites[i].first - sites[j].first), wrapped(sites[i].second - sites[j].second)));
  }
  // Points of a hexagonal lattice would lie 0.358 apart.
  EXPECT_GT(least, 0.2);
}

}  // namespace
}  // namespace papilla
