// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "papilla/core/srgb.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/recipe_outline.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {
namespace {

using Rgb = std::array<double, 3>;

const RecipeLibrary& builtin() {
  static const RecipeLibrary library = RecipeLibrary::builtin();
  return library;
}

/// OKLab, as its page has it (B. Ottosson, 2020): lightness, chroma and hue.
Rgb oklch(const Rgb& rgb) {
  const double r = linear_from_srgb(rgb[0]), g = linear_from_srgb(rgb[1]), b = linear_from_srgb(rgb[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b),
               m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b),
               s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  const double a = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
               c = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s, std::hypot(a, c), std::atan2(c, a)};
}

std::vector<Rgb> colours_of(const std::string& recipe) {
  std::vector<Rgb> all;
  for (const OutlineTexture& texture : outline_recipe(recipe, builtin()))
    for (const OutlineParameter& p : texture.parameters)
      for (const OutlineColour& c : p.colours) all.push_back(c.rgb);
  return all;
}

std::vector<double> numbers_of(const std::string& recipe) {
  std::vector<double> all;
  for (const OutlineTexture& texture : outline_recipe(recipe, builtin()))
    for (const OutlineParameter& p : texture.parameters)
      for (const OutlineNumber& n : p.numbers) all.push_back(n.value);
  return all;
}

/// Heads and names of parameters.
std::vector<std::string> bones_of(const std::string& recipe) {
  std::vector<std::string> all;
  for (const OutlineTexture& texture : outline_recipe(recipe, builtin())) {
    all.emplace_back(texture.head.of(recipe));
    for (const OutlineParameter& p : texture.parameters) all.emplace_back(p.name.of(recipe));
  }
  return all;
}

std::string mutant(const std::string& recipe, unsigned seed, double strength) {
  return mutate_recipe(recipe, builtin(), seed, strength);
}

double turn_between(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

TEST(Mutation, StaysInRangeAndDependsOnTheSeedAlone) {
  const std::string recipe = "fbm|octaves=18.5|h=.5|cols=red,blue";
  EXPECT_EQ(mutate_recipe(recipe, {}, 7, 0.5), mutate_recipe(recipe, {}, 7, 0.5));
  EXPECT_NE(mutate_recipe(recipe, {}, 7, 0.5), mutate_recipe(recipe, {}, 8, 0.5));
  for (unsigned seed = 0; seed < 50; ++seed) EXPECT_NO_THROW(compile_texture(mutate_recipe(recipe, {}, seed, 1), {}));
}

TEST(Mutation, ReachesNamedRecipesLayersAndFormulas) {
  RecipeLibrary library;
  library.add("spots", "circle|r=.3|bumpfunction=main*2.5+get(0)+[fbm|h=.4]");
  EXPECT_EQ(mutate_recipe("spots", library, 1, 0), "circle|r=0.3|bumpfunction=main*2.5+get(0)+[fbm|h=.4]");
  const std::string layers = mutate_recipe("multi|textures=spots,[noise|scale=.2]", library, 3, 0.5);
  EXPECT_EQ(layers.find("multi|textures=[circle|r=0."), 0U) << layers;
  EXPECT_EQ(layers.find("r=0.3|"), std::string::npos) << layers;
  EXPECT_EQ(layers.find("*2.5+"), std::string::npos) << layers;
  EXPECT_NE(layers.find("get(0)+[fbm|h=.4]"), std::string::npos) << layers;
  EXPECT_NO_THROW(compile_texture(layers, library));
}

TEST(Mutation, OfEveryRecipeOfTheLibraryCompiles) {
  for (const auto& [name, recipe] : builtin().recipes())
    for (unsigned seed = 1; seed < 6; ++seed)
      for (const double strength : {0.3, 1.0}) {
        const std::string text = mutant(name, seed, strength);
        EXPECT_EQ(text, mutant(name, seed, strength)) << name;
        EXPECT_EQ(bones_of(text), bones_of(mutant(name, 0, 0))) << name;
        for (const bool seamless : {false, true}) {
          CompileOptions options;
          options.seamless = seamless;
          EXPECT_NO_THROW(compile_texture(text, builtin(), options)) << name << ": " << text;
        }
      }
}

TEST(Mutation, OfNoStrengthIsTheSamePicture) {
  RenderOptions options;
  options.width = options.height = 16;
  options.channels = 1U << static_cast<unsigned>(Channel::color) | 1U << static_cast<unsigned>(Channel::bump);
  for (const auto& [name, recipe] : builtin().recipes()) {
    const RenderedTexture wanted = render_texture(compile_texture(name, builtin()), options),
                          made = render_texture(compile_texture(mutant(name, 1, 0), builtin()), options);
    for (const Channel channel : {Channel::color, Channel::bump})
      for (std::size_t i = 0; i < wanted.values[channel].size(); ++i)
        ASSERT_NEAR(made.values[channel][i], wanted.values[channel][i], 1e-3) << name << " at " << i;
  }
}

TEST(Mutation, ChangesColoursByWhatEyesSee) {
  constexpr double k_rounding = 2e-3;  // Four digits of a coded value.
  for (const auto& [name, recipe] : builtin().recipes()) {
    const std::vector<Rgb> before = colours_of(mutant(name, 1, 0));
    bool differs = before.empty();
    for (const double strength : {0.2, 1.0})
      for (unsigned seed = 1; seed < 6; ++seed) {
        const std::vector<Rgb> after = colours_of(mutant(name, seed, strength));
        ASSERT_EQ(after.size(), before.size()) << name;
        differs = differs || after != before;
        for (std::size_t i = 0; i < after.size(); ++i) {
          const Rgb a = oklch(before[i]), b = oklch(after[i]);
          EXPECT_LE(std::abs(b[0] - a[0]), strength / 4 + k_rounding) << name;
          EXPECT_LE(b[1], (1 + strength) * a[1] + k_rounding) << name;
          // A hue is worth as much as its chroma.
          const double most = std::min(strength * std::numbers::pi / 3, std::numbers::pi);
          EXPECT_LE(a[1] * std::max(turn_between(a[2], b[2]) - most, 0.0) * std::min(1.0, b[1] / 0.02), 0.02) << name;
        }
      }
    EXPECT_TRUE(differs) << name << " has colours and none changes";
  }
}

TEST(Mutation, KeepsGreyGreyAndAPaletteTogether) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const Rgb& grey : colours_of(mutant("fbm|cols=<.4,.4,.4>,white,black,<.9,.9,.9>", seed, 1)))
      EXPECT_LT(oklch(grey)[1], 1e-3) << seed;
    const std::vector<Rgb> two = colours_of(mutant("fbm|cols=<.5,.3,.3>,<.6,.45,.35>", seed, 0.3));
    const double before = turn_between(oklch({0.5, 0.3, 0.3})[2], oklch({0.6, 0.45, 0.35})[2]);
    EXPECT_NEAR(turn_between(oklch(two[0])[2], oklch(two[1])[2]), before, 0.02) << seed;
  }
}

TEST(Mutation, ReachesColoursByNameInListsAndFormulas) {
  const auto starts = [](const std::string& text, const std::string& begin) {
    EXPECT_EQ(text.rfind(begin, 0), 0U) << text;
  };
  starts(mutant("fbm|cols=red, steelblue", 1, 0.3), "fbm|cols=<");
  EXPECT_EQ(mutant("fbm|cols=red <0,1,0>", 1, 0), "fbm|cols=<1,0,0>,<0,1,0>");
  EXPECT_EQ(colours_of(mutant("fbm|cols=oak", 1, 0.3)).size(), colours_of(mutant("fbm|cols=oak", 1, 0)).size());
  EXPECT_GT(colours_of(mutant("fbm|cols=oak", 1, 0.3)).size(), 1U) << "a list of the library";
  const std::string formula = mutant("fbm|colorfunction=colmix(red,<.2,.3,.4>,main)", 1, 0.3);
  starts(formula, "fbm|colorfunction=colmix(<");
  EXPECT_EQ(formula.find("<.2,.3,.4>"), std::string::npos) << formula;
  EXPECT_EQ(mutant("fbm|cols=<1,0,0>", 3, 1).find('-'), std::string::npos) << "within sRGB";
  // A comparison is no colour, and what a formula for numbers names is none.
  EXPECT_EQ(mutant("base|mainfunction=(x<2)*(y>3)", 1, 1), "base|mainfunction=(x<2)*(y>3)");
}

TEST(Mutation, ChangesVectorsByTheirComponents) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<double> scale = numbers_of(mutant("fbm|scale=<.08,.6>", seed, 0.5));
    ASSERT_EQ(scale.size(), 2U);
    EXPECT_NEAR(scale[0], 0.08, 0.04);
    EXPECT_NEAR(scale[1], 0.6, 0.3);
    EXPECT_NE(scale[0] / 0.08, scale[1] / 0.6);
    const std::vector<double> one = numbers_of(mutant("fbm|scale=.25", seed, 0.5));
    ASSERT_EQ(one.size(), 1U);
    EXPECT_NEAR(one[0], 0.25, 0.125);
    EXPECT_NE(one[0], 0.25);
    // A direction leans, and stays one.
    const std::vector<double> down = numbers_of(mutant("fbm|dirtdirection=<0,-1,0>", seed, 1));
    ASSERT_EQ(down.size(), 3U);
    EXPECT_TRUE(down[0] != 0 && down[2] != 0 && down[1] < -0.4) << seed;
    EXPECT_NO_THROW(compile_texture(mutant("fbm|dirtdirection=<0,-1,0>|normal=<0,1,0>", seed, 1), builtin()));
  }
  EXPECT_EQ(mutant("fbm|limitlo=.4|limithi=.5", 1, 1), "fbm|limitlo=.4|limithi=.5") << "they must not cross";
}

}  // namespace
}  // namespace papilla
