// SPDX-License-Identifier: MIT
#include "papilla/procedural/texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"
#include "papilla/procedural/reference.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

constexpr unsigned k_main = 1U << static_cast<unsigned>(Channel::main);
constexpr unsigned k_all = (1U << k_channels) - 1;

std::vector<float> main_at(const std::string& recipe, const std::vector<double>& x, const std::vector<double>& y,
                           const CompileOptions& options = {}) {
  return evaluate_texture(compile_texture(recipe, RecipeLibrary::builtin(), options), {x, y, {}, {}, {}, {}}, k_main, 0)
      .channels[0];
}
float value(const std::string& formula, double x = 0.3, double y = 0.7) {
  return main_at("base|mainfunction=" + formula, {x}, {y})[0];
}

TEST(Formula, FollowsTheRulesOfArithmetic) {
  EXPECT_FLOAT_EQ(value("2+3*4^2/8-1"), 7);
  EXPECT_FLOAT_EQ(value("-2^2"), -4);
  EXPECT_FLOAT_EQ(value("2^3^2"), 512);
  EXPECT_FLOAT_EQ(value("-.5%2"), 1.5F);
  EXPECT_FLOAT_EQ(value("x*10+y"), 3.7F);
  EXPECT_FLOAT_EQ(value("smoothstep(0,1,x)"), 0.216F);
  EXPECT_FLOAT_EQ(value("dist(.3,.3)"), 0.4F);
  EXPECT_FLOAT_EQ(value("linedist(0,0,1,0)"), 0.7F);
  EXPECT_FLOAT_EQ(value("getgreen(hsv(1/3,1,.5))"), 0.5F);
  EXPECT_FLOAT_EQ(value("linedist(0,0,.1,0)"), std::hypot(0.2F, 0.7F));
  EXPECT_FLOAT_EQ(value("linedist(.5,0,.9,0)"), std::hypot(0.2F, 0.7F));
  EXPECT_FLOAT_EQ(value("ovaldist(.1,.3,.5,.2)"), std::hypot(0.4F, 2.0F));
  EXPECT_FLOAT_EQ(value("gethsvhue(<0,1,0>)"), 1 / 3.0F);
  EXPECT_FLOAT_EQ(value("gethsvhue(<.8,.2,.5>)"), 5.5F / 6);
  EXPECT_FLOAT_EQ(value("gethsvhue(<.2,.8,.5>)"), 2.5F / 6);
  EXPECT_FLOAT_EQ(value("gethsvhue(<.2,.5,.8>)"), 3.5F / 6);
  EXPECT_FLOAT_EQ(value("bias(.5,x)"), 0.3F);
  EXPECT_FLOAT_EQ(value("gain(.5,x)"), 0.3F);
  EXPECT_FLOAT_EQ(value("pulse(.2,.4,x)"), 1);
  EXPECT_FLOAT_EQ(value("huedist(.9)*0+interpolate(2,4,.25)"), 2.5F);
}

TEST(Formula, APartOfAnOctaveIsThatPartOfIt) {
  for (const std::string head :
       {"turbulence2d(x,y,", "absturbulence2d(x,y,", "turbulence3d(x,y,.4,", "turbulence(x,"}) {
    const auto of = [&](const char* octaves) { return value(head + octaves + ")", 3.3, 5.7); };
    ASSERT_NE(of("3"), of("2")) << head;
    EXPECT_NEAR(of("2.25"), of("2") + 0.25F * (of("3") - of("2")), 1e-6) << head;
  }
}

TEST(Formula, HasAValueWhereMathematicsHasNone) {
  EXPECT_EQ(value("1/(x-x)"), 0);
  EXPECT_EQ(value("log(x-x)"), 0);
  EXPECT_EQ(value("sqrt(-x)"), 0);
  EXPECT_EQ(value("(0-x)^.3"), 0);
  EXPECT_EQ(value("x^-99999"), 0);
  EXPECT_EQ(value("mod(x,0)"), 0);
  EXPECT_EQ(value("x*1e300*1e300-x*1e300*1e300"), 0);
}

TEST(Texture, ScaleRotationShiftAndPerturbationMoveThePlace) {
  const std::vector<double> x = {0.1, 0.4}, y = {0.2, 0.9};
  EXPECT_EQ(main_at("base|scale=.5|mainfunction=noise2d(x,y)", x, y),
            main_at("base|mainfunction=noise2d(x*2,y*2)", x, y));
  EXPECT_EQ(main_at("base|perturbx=y|perturby=x|mainfunction=x-3*y", x, y), main_at("base|mainfunction=y-3*x", x, y));
  EXPECT_EQ(main_at("base|du=.25|mainfunction=x", x, y), main_at("base|mainfunction=x+.25", x, y));
  EXPECT_NEAR(main_at("base|rot=pi/2|mainfunction=x", x, y)[0], 0.5 - (0.2 - 0.5), 1e-6);
  EXPECT_NEAR(main_at("base|afunction=zoom(.5,.5,2)|mainfunction=x", x, y)[0], 0.5 + 2 * (0.1 - 0.5), 1e-6);
}

TEST(Texture, InlineAndNamedTexturesAreTheSame) {
  RecipeLibrary library;
  library.add("stars", "star|jags=7");
  const std::vector<double> x = {0.3}, y = {0.6};
  const auto at = [&](const char* recipe) {
    return evaluate_texture(compile_texture(recipe, library), {x, y, {}, {}, {}, {}}, k_main, 0).channels[0][0];
  };
  EXPECT_EQ(at("base|mainfunction=stars*2"), at("base|mainfunction=[star|jags=7]*2"));
  EXPECT_EQ(at("stars|jags=3"), at("star|jags=3"));
}

TEST(Texture, IsTheSameForAnyCutOfTheWork) {
  // 300 columns are more than a row of the evaluator; the same points of one row, evaluated on their own, must agree.
  // Rows of the evaluator that a formula reads before they are filled would hold what another thread left there.
  const RecipeLibrary library = RecipeLibrary::builtin();
  for (const auto& [name, recipe] : library.recipes()) {
    if (recipe.find("near") != std::string::npos) continue;
    const std::string layered =
        recipe.find("ismodifier=true") == std::string::npos ? name : "multi|textures=leather," + name;
    const RenderedTexture whole = test::rendered(layered, 300, library, test::at_time(0.7), k_all);
    const auto texture = compile_texture(layered, library, test::at_time(0.7));
    std::vector<double> x, y;
    for (int i = 0; i < 300; ++i) x.push_back((i + 0.5) * (1 / 300.0)), y.push_back(150.5 * (1 / 300.0));
    const TextureValues row = evaluate_texture(texture, {x, y, {}, {}, {}, {}}, k_all, 1 / 300.0);
    for (std::size_t i = 0; i < 300; ++i)
      ASSERT_EQ(row[Channel::bump][i], whole.values[Channel::bump][150 * 300 + i]) << name;
  }
}

TEST(Texture, FormulasKnowOnlyWhatCameBefore) {
  const auto refusal = [](const char* recipe) -> std::string {
    try {
      compile_texture(recipe, {});
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  for (const char* recipe :
       {"fbm|afunction=this", "fbm|afunction=2*main", "fbm|afunction=a", "fbm|afunction=b", "fbm|bfunction=b",
        "fbm|perturbx=x+main", "fbm|perturby=id", "base|textures=fbm,noise|mainfunction=1|afunction=texmappedbump"})
    EXPECT_NE(refusal(recipe).find("is not known yet"), std::string::npos) << recipe << ": " << refusal(recipe);
  for (const char* recipe : {"fbm|afunction=x|bfunction=a|perturbx=x+a*b|mainfunction=this+main+a+id"})
    EXPECT_EQ(refusal(recipe), "");
}

/// Slope of the structure function between two lags, as D = 3 - slope / 2.
double dimension_of(const std::vector<float>& height, int size, int first, int last) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  int count = 0;
  for (int lag = first; lag <= last; lag *= 2, ++count) {
    double sum = 0;
    std::size_t pairs = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x + lag < size; ++x, ++pairs) {
        const auto at = static_cast<std::size_t>(y * size + x);
        const double d =
            static_cast<double>(height[at + static_cast<std::size_t>(lag)]) - static_cast<double>(height[at]);
        sum += d * d;
      }
    const double lx = std::log(lag), ly = std::log(sum / static_cast<double>(pairs));
    sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
  }
  return 3 - (count * sxy - sx * sy) / (count * sxx - sx * sx) / 2;
}

TEST(Fbm, KeepsItsDimension) {
  // Finest cells have 4 texels, the coarsest 1024/32: lags of 2 to 16 texels, averaged over seeds.
  for (const double h : {0.2, 0.5, 0.8}) {
    double mean = 0;
    for (int seed = 0; seed < 3; ++seed)
      mean += dimension_of(
                  test::rendered("fbm|scale=.125|octaves=4|seed=" + std::to_string(seed) + "|h=" + std::to_string(h),
                                 1024, {})
                      .values[Channel::main],
                  1024, 2, 16) /
              3;
    EXPECT_NEAR(mean, 3 - h, 0.05) << "H = " << h;
  }
}

TEST(Seamless, EveryTypeIsBitEqualAcrossBordersAndHasNoStepThere) {
  std::vector<double> inner_x, inner_y, outer_x, outer_y;
  for (int i = 0; i < 64; ++i) {
    const double t = (i + 0.5) / 64;
    inner_x.insert(inner_x.end(), {0, t, 0.25}), inner_y.insert(inner_y.end(), {t, 0, t});
    outer_x.insert(outer_x.end(), {1, t, 1.25}), outer_y.insert(outer_y.end(), {t, 1, t - 1});
  }
  for (const TypeInfo& type : texture_types()) {
    const std::string recipe = test::example_of(type.name) + "|seamless=true";
    EXPECT_EQ(main_at(recipe, inner_x, inner_y), main_at(recipe, outer_x, outer_y)) << recipe;
  }
}

TEST(Seamless, EveryCopyIsTheSame) {
  std::vector<double> x, y, right, up, down;
  for (int i = 0; i < 64; ++i) {
    x.push_back((i + 0.5) / 64), y.push_back((13 * i % 64 + 0.5) / 64);
    right.push_back(x.back() + 2), up.push_back(y.back() - 3), down.push_back(y.back() + 2);
  }
  for (const TypeInfo& type : texture_types())
    for (const char* tile : {"", "|sx=.5|sy=.33333333333333333"}) {
      const std::string recipe = test::example_of(type.name) + "|seamless=true" + tile;
      const auto here = main_at(recipe, x, y);
      for (const auto& [u, v] : {std::pair(right, y), std::pair(x, up), std::pair(x, down), std::pair(right, down)}) {
        const auto there = main_at(recipe, u, v);
        for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(here[i], there[i], 1e-5) << recipe << ' ' << i;
      }
    }
}

TEST(Seamless, AChequerBoardAlternatesAcrossBordersOfOddTiles) {
  const std::vector<double> along = {0.01, 0.3, 0.7}, first(3, 1e-6), last(3, 1 - 1e-6);
  for (const char* tile : {"sx=1", "sx=.66666666666666667|sy=.4", "sx=.4|sy=.66666666666666667"})
    for (const char* type : {"checker", "checker3d"}) {
      const std::string recipe = std::string(type) + "|seamless=true|" + tile;
      const auto left = main_at(recipe, first, along), right = main_at(recipe, last, along),
                 top = main_at(recipe, along, first), bottom = main_at(recipe, along, last);
      for (std::size_t i = 0; i < along.size(); ++i) {
        EXPECT_EQ(left[i], 1 - right[i]) << recipe;
        EXPECT_EQ(top[i], 1 - bottom[i]) << recipe;
      }
    }
}

TEST(Solid, AChequerBoardHasCubes) {
  std::vector<double> any;
  std::vector<float> positions, expected;
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 8; ++j)
      for (int i = 0; i < 8; ++i) {
        for (const int c : {i, j, k}) positions.push_back(static_cast<float>(0.25 * (c + 0.5)));
        expected.push_back(static_cast<float>((i + j + k) % 2));
        any.push_back(0.1);
      }
  const auto found =
      evaluate_texture(compile_texture("checker3d", {}), {any, any, {}, positions, {}, {}}, k_main, 0).channels[0];
  EXPECT_EQ(found, expected);
}

TEST(Brick, CoursesAlternateAcrossTheBorderOfATile) {
  // Where a joint between two bricks lies, in bricks from the left border.
  const auto joint = [](double y) {
    std::vector<double> x, rows(400, y);
    for (int i = 0; i < 400; ++i) x.push_back((i + 0.5) / 400);
    const auto id = main_at("brick|seamless=true|returnid=true|switching=true|tiling=true|rows=3|columns=4", x, rows);
    std::size_t i = 1;
    while (i + 1 < id.size() && id[i] == id[i - 1]) ++i;
    return std::fmod(4.0 * static_cast<double>(i) / 400, 1.0);
  };
  EXPECT_NEAR(std::abs(joint(1e-6) - joint(1 - 1e-6)), 0.5, 0.02);
}

TEST(Seamless, WhatLiesAHairBeforeABorderIsWhatLiesOnIt) {
  const std::vector<double> at(64, 0), before(64, 1 - 1e-9);
  std::vector<double> along;
  for (int i = 0; i < 64; ++i) along.push_back((i + 0.5) / 64);
  for (const char* type : {"noise", "fbm", "turbulence", "voronoi", "voronoi|func=f2-f1", "marble", "wood",
                           "voronoiseamless", "base|mainfunction=noise2d(x*8,y*8)"})
    for (const char* tile : {"", "|sx=.5|sy=.33333333333333333", "|sx=.25|sy=.2"}) {
      if (std::string_view(type).starts_with("base") && *tile) continue;  // Its formula fits the square only.
      const std::string recipe = std::string(type) + "|seamless=true" + tile;
      const auto left = main_at(recipe, at, along), right = main_at(recipe, before, along),
                 top = main_at(recipe, along, at), bottom = main_at(recipe, along, before);
      for (std::size_t i = 0; i < 64; ++i) {
        EXPECT_NEAR(left[i], right[i], 1e-4) << recipe << " at y = " << along[i];
        EXPECT_NEAR(top[i], bottom[i], 1e-4) << recipe << " at x = " << along[i];
      }
    }
}

TEST(Seamless, NoiseHasNoStepWithinATile) {
  // Where the lattice begins anew lies within the tile.
  constexpr int k_steps = 8192;
  constexpr float k_most = 0.02F;  // Smooth noise of these octaves changes by a fifth of that.
  std::vector<double> along, across(k_steps, 0.31);
  for (int i = 0; i < k_steps; ++i) along.push_back((i + 0.5) / k_steps);
  for (const char* type : {"noise", "fbm|octaves=2|zvalue=.3", "fbm|octaves=2", "turbulence|octaves=2"})
    for (const char* tile : {"", "|sx=.5|sy=.33333333333333333"}) {
      const std::string recipe = std::string(type) + "|seamless=true" + tile;
      const auto in_x = main_at(recipe, along, across), in_y = main_at(recipe, across, along);
      for (std::size_t i = 1; i < in_x.size(); ++i) {
        ASSERT_NEAR(in_x[i], in_x[i - 1], k_most) << recipe << " at x = " << along[i];
        ASSERT_NEAR(in_y[i], in_y[i - 1], k_most) << recipe << " at y = " << along[i];
      }
    }
}

/// Where the only point of a cell of "voronoi|densityfunc=1|smooth=1" lies, in cells from the cell's corner, when it is
/// not farther than 0.3 cells from the middle.
Vec2 point_of_cell(const std::string& recipe, int column, int row) {
  constexpr int k_side = 65;
  constexpr double k_cells = 4;  // Of a unit square.
  std::vector<double> x, y;
  std::vector<Vec2> at;
  for (int j = 0; j < k_side; ++j)
    for (int i = 0; i < k_side; ++i) {
      at.push_back({0.2 + 0.6 * i / (k_side - 1), 0.2 + 0.6 * j / (k_side - 1)});
      x.push_back((column + at.back().x) / k_cells), y.push_back((row + at.back().y) / k_cells);
    }
  const std::vector<float> distance = main_at("voronoi|densityfunc=1|smooth=1|" + recipe, x, y);
  return at[static_cast<std::size_t>(std::min_element(distance.begin(), distance.end()) - distance.begin())];
}

TEST(Voronoi, CellsAreDisplacedAsTheModeSays) {
  constexpr double k_near = 0.006;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column) {
      const double odd_row = row, odd_column = column, chequer = row ^ column;
      const Vec2 shifts[] = {{0, 0}, {odd_row, 0}, {0, odd_column}, {odd_row, odd_column}, {chequer, 0}, {0, chequer}};
      for (int mode = 0; mode < 6; ++mode) {
        const Vec2 point = point_of_cell("displace=.25|displacemode=" + std::to_string(mode), column, row);
        EXPECT_NEAR(point.x, 0.5 + 0.25 * shifts[mode].x, k_near)
            << "mode " << mode << ", cell " << column << ' ' << row;
        EXPECT_NEAR(point.y, 0.5 + 0.25 * shifts[mode].y, k_near)
            << "mode " << mode << ", cell " << column << ' ' << row;
      }
    }
}

TEST(Voronoi, ARandomDisplacementIsAnotherAlongYThanAlongX) {
  double apart = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const Vec2 point = point_of_cell("displace=.5|displacemode=6", column, row);
      EXPECT_LE(std::max(std::abs(point.x - 0.5), std::abs(point.y - 0.5)), 0.27);
      apart = std::max(apart, std::abs(point.x - point.y));
    }
  EXPECT_GT(apart, 0.15);
}

TEST(Voronoi, AnOctaveWeighsAsMuchLessAsItsCellsAreSmaller) {
  std::vector<double> x, y;
  for (int i = 0; i < 64; ++i) x.push_back(0.1 + i / 40.0), y.push_back(0.7 - i / 90.0);
  for (const auto& [plain, weighted] : {std::pair("octaves=3", "octaves=3|weights=1,.5,.25"),
                                        std::pair("octaves=2|lacunarity=4", "octaves=2|lacunarity=4|weights=1,.25")})
    EXPECT_EQ(main_at(std::string("voronoi|") + plain, x, y), main_at(std::string("voronoi|") + weighted, x, y));
  EXPECT_NE(main_at("voronoi|octaves=2", x, y), main_at("voronoi|octaves=2|weights=1,1", x, y));
}

TEST(Multi, BlendsAsTheRulesSay) {
  const auto bump = [](const std::string& rule) {
    const auto texture = compile_texture(
        "multi|textures=[base|bumpfunction=.5],[base|bumpfunction=.2|alphafunction=.25|bumpblend=" + rule + "]", {});
    const std::vector<double> at = {0.5};
    return evaluate_texture(texture, {at, at, {}, {}, {}, {}}, k_all, 0)[Channel::bump][0];
  };
  EXPECT_FLOAT_EQ(bump("off"), 0.5F);
  EXPECT_FLOAT_EQ(bump("add"), 0.55F);
  EXPECT_FLOAT_EQ(bump("sub"), 0.45F);
  EXPECT_FLOAT_EQ(bump("interpolate"), 0.425F);
}

TEST(Multi, LayersReadWhatLiesBelow) {
  const auto texture = compile_texture(
      "multi|textures=[base|bumpfunction=.4|colorfunction=<.2,.4,.6>|frictionfunction=.3],"
      "[base|bumpblend=interpolate|bumpfunction=lowerbump*2|colorfunction=colscale(currentcolor,.5)|frictionfunction="
      "lowerfriction+.1]",
      {});
  const std::vector<double> at = {0.5};
  const TextureValues v = evaluate_texture(texture, {at, at, {}, {}, {}, {}}, k_all, 0);
  EXPECT_FLOAT_EQ(v[Channel::bump][0], 0.8F);
  EXPECT_FLOAT_EQ(v[Channel::friction][0], 0.4F);
  EXPECT_FLOAT_EQ(v[Channel::color][2], 0.3F);
}

/// The value of a channel of a recipe that is the same everywhere.
float constant_of(const std::string& recipe, Channel channel) {
  const std::vector<double> here = {0.5};
  const auto texture = compile_texture(recipe, RecipeLibrary::builtin());
  return evaluate_texture(texture, {here, here, {}, {}, {}, {}}, 1U << static_cast<unsigned>(channel), 0)[channel][0];
}

TEST(Roughness, IsThatOfTheHighlightUnlessTheRecipeSaysIt) {
  // α² = 2 / (n + 2), r = √α: 0.5 for n = 30.
  EXPECT_DOUBLE_EQ(roughness_of_highlight(1, 30), 0.5);
  // Half the weight is the peak of half of n + 2.
  EXPECT_DOUBLE_EQ(roughness_of_highlight(0.5, 62), 0.5);
  EXPECT_DOUBLE_EQ(roughness_of_highlight(1, 0), 1);
  EXPECT_DOUBLE_EQ(roughness_of_highlight(1, -5), 1);
  EXPECT_DOUBLE_EQ(roughness_of_highlight(0, 100), 1);
  EXPECT_DOUBLE_EQ(roughness_of_highlight(0.1, 10), 1) << "fainter than what is matte";
  EXPECT_FLOAT_EQ(constant_of("base|specularfunction=1|specularcoefffunction=30", Channel::roughness), 0.5F);
  EXPECT_FLOAT_EQ(constant_of("base", Channel::roughness), std::pow(2 / (0.3F * 12), 0.25F));
  EXPECT_FLOAT_EQ(constant_of("base|roughnessfunction=.25|specularfunction=0", Channel::roughness), 0.25F);
  EXPECT_FLOAT_EQ(constant_of("base|roughnessfunction=7", Channel::roughness), 1);
  // Layers blend roughness itself, as any channel; a multi with a highlight of its own has that one's.
  const std::string two = "multi|textures=[base|roughnessfunction=.2],[base|alphafunction=.25|roughnessfunction=.6]";
  EXPECT_FLOAT_EQ(constant_of(two, Channel::roughness), 0.3F);
  EXPECT_FLOAT_EQ(constant_of(two + "|roughnessscale=2", Channel::roughness), 0.6F);
  EXPECT_FLOAT_EQ(constant_of(two + "|specularfunction=1|specularcoefffunction=30", Channel::roughness), 0.5F);
  EXPECT_FLOAT_EQ(constant_of("multi|textures=[base|roughnessfunction=.2],[base|alphafunction=.5|roughnessblend=add|"
                              "roughnessfunction=.6]",
                              Channel::roughness),
                  0.5F);
}

TEST(Multi, ALayerMayBeAHole) {
  const std::string hole =
      "multi|textures=[base|alphafunction=.8|frictionfunction=.3],[base|alphablend=cut|"
      "alphafunction=.75|frictionfunction=.9|colorfunction=white]";
  EXPECT_FLOAT_EQ(constant_of(hole, Channel::alpha), 0.2F);
  EXPECT_FLOAT_EQ(constant_of(hole, Channel::friction), 0.3F) << "nothing else of it shows";
  EXPECT_FLOAT_EQ(constant_of(hole.substr(0, hole.size()) + ",[base|alphafunction=.5]", Channel::alpha), 0.6F)
      << "what lies over it covers it";
  EXPECT_FLOAT_EQ(constant_of("base|alphablend=cut|alphafunction=.75", Channel::alpha), 0.75F);
}

TEST(Library, WhatAgesChangesTheShine) {
  const auto over = [](const std::string& recipe, Channel channel) {
    return constant_of(
        "multi|textures=[base|reflectionfunction=1|roughnessfunction=.3],[" + recipe + "|alphafunction=1]", channel);
  };
  EXPECT_LT(over("wetness|time=1", Channel::roughness), 0.4F);
  EXPECT_EQ(over("rust_on", Channel::roughness), 1) << "rust is matte";
  EXPECT_EQ(over("rust_on", Channel::reflection), 0) << "and no metal";
  EXPECT_GT(over("rust_on", Channel::friction), 0.7F) << "and grips";
  EXPECT_EQ(over("scratches", Channel::reflection), 1) << "a scratch shows the metal";
  EXPECT_EQ(over("polish", Channel::reflection), 1);
}

TEST(Multi, LayersReadEveryChannelBelow) {
  const std::string below =
      "[base|mainfunction=.11|bumpfunction=.12|alphafunction=.5|coloralphafunction=.4|"
      "reflectionfunction=.13|diffusefunction=.14|specularfunction=.15|specularcoefffunction=.16|"
      "frictionfunction=.17|stiffnessfunction=.18|dampingfunction=.19|roughnessfunction=.21]";
  const std::pair<const char*, float> known[] = {
      {"lowermain", .11F},       {"lowerbump", .12F},      {"loweralpha", .5F},     {"lowercoloralpha", .4F},
      {"lowerreflection", .13F}, {"lowerdiffuse", .14F},   {"lowerspecular", .15F}, {"lowerspecularcoeff", .16F},
      {"lowerfriction", .17F},   {"lowerstiffness", .18F}, {"lowerdamping", .19F},  {"lowerroughness", .21F}};
  static_assert(std::size(known) == k_channels - 1, "and the colour, which is currentcolor");
  const std::vector<double> here = {0.5};
  for (const auto& [name, value] : known) {
    const auto texture =
        compile_texture("multi|textures=" + below + ",[base|bumpblend=interpolate|bumpfunction=" + name + "]", {});
    EXPECT_FLOAT_EQ(evaluate_texture(texture, {here, here, {}, {}, {}, {}}, k_all, 0)[Channel::bump][0], value) << name;
  }
  // Two layers of half the cover and of half of that for the colour.
  const std::string half = "[base|alphafunction=.5|coloralphafunction=.5]";
  const auto two = compile_texture("multi|textures=" + half + "," + half, {});
  const TextureValues v = evaluate_texture(two, {here, here, {}, {}, {}, {}}, k_all, 0);
  EXPECT_FLOAT_EQ(v[Channel::alpha][0], .75F);
  EXPECT_FLOAT_EQ(v[Channel::alpha][0] * v[Channel::coloralpha][0], 1 - .75F * .75F);
}

TEST(Time, ModifiersFixedTimeAndPeriodicTime) {
  const auto at = [](const std::string& recipe, double time) {
    return main_at(recipe, {0.3}, {0.4}, test::at_time(time))[0];
  };
  EXPECT_FLOAT_EQ(at("base|mainfunction=time", 0.25), 0.25F);
  EXPECT_FLOAT_EQ(at("base|fixtime=true|time=.75|mainfunction=time", 0.25), 0.75F);
  EXPECT_FLOAT_EQ(at("base|mainfunction=1|timemodifiers=intensity:1+2*time", 0.5), 2);
  const std::string periodic = "base|mainfunction=1|periodicmod=true|timemodifiers=intensity:s(time*5)";
  EXPECT_NEAR(at(periodic, 0), at(periodic, 1), 1e-6);
}

TEST(Direction, NormaldotIsOneWhereDirtLands) {
  const auto texture = compile_texture("base|mainfunction=normaldot", {});
  EXPECT_TRUE(texture.depends_on_normal());
  const std::vector<double> at = {0, 0, 0};
  const std::vector<float> normals = {0, 1, 0, 0, -1, 0, 1, 0, 0};
  const auto v = evaluate_texture(texture, {at, at, normals, {}, {}, {}}, k_main, 0).channels[0];
  EXPECT_FLOAT_EQ(v[0], 1);
  EXPECT_FLOAT_EQ(v[1], -1);
  EXPECT_FLOAT_EQ(v[2], 0);
}

TEST(Ageing, NothingAtTimeZeroAndHeightAndFrictionLater) {
  const RecipeLibrary library = RecipeLibrary::builtin();
  const RenderedTexture fresh = test::rendered("leather", 64, library, {}, k_all);
  for (const char* name : {"greying", "dirt", "smears", "scratches", "chipped_paint", "rust_in", "rust_on", "erosion",
                           "moss", "wetness", "snow", "dust", "polish"}) {
    const std::string recipe = std::string("multi|textures=leather,") + name;
    const RenderedTexture young = test::rendered(recipe, 64, library, test::at_time(0), k_all),
                          old = test::rendered(recipe, 64, library, test::at_time(1), k_all);
    const auto change = [](const std::vector<float>& a, const std::vector<float>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(std::abs(a[i] - b[i]));
      return sum / static_cast<double>(a.size());
    };
    EXPECT_NEAR(young.values[Channel::friction][77], fresh.values[Channel::friction][77], 1e-6) << name;
    EXPECT_NEAR(young.values[Channel::bump][77], fresh.values[Channel::bump][77], 1e-6) << name;
    EXPECT_GT(change(young.values[Channel::friction], old.values[Channel::friction]), 1e-3) << name;
    EXPECT_GT(change(young.values[Channel::color], old.values[Channel::color]), 1e-3) << name;
    if (std::string(name) != "greying") {
      EXPECT_GT(change(young.values[Channel::bump], old.values[Channel::bump]), 1e-4) << name;
    }
  }
}

TEST(Render, RefusesImpossibleSizes) {
  const auto texture = compile_texture("noise", {});
  RenderOptions options;
  options.width = options.height = 65536;
  EXPECT_THROW(render_texture(texture, options), InvalidInput);
  options.width = 0;
  EXPECT_THROW(render_texture(texture, options), InvalidInput);
}

}  // namespace
}  // namespace papilla
