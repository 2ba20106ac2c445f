// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/recipe_look.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/studio/parse_materials.hpp"
#include "papilla/procedural/recipe_error.hpp"

namespace papilla {
namespace {

/// The samples of a grain, of which a look of this side is a copy.
constexpr int k_side = 512;
constexpr const char* k_gentle = "fbm|scale=.5|h=.9|octaves=3|cols=firebrick,gold,steelblue|reflectionfunction=.5*this";

const RecipeLibrary& library() {
  static const RecipeLibrary all = RecipeLibrary::builtin();
  return all;
}

MaterialRule rule_of(const std::string& recipe, const std::string& more = {}) {
  const std::string material =
      R"({"texture": ")" + recipe + R"(", "size_mm": [40, 30], "height": {"depth_mm": 0.2})" + more + "}";
  return parse_materials(R"({"materials": {"m": )" + material + R"(}, "assign": []})", "m.json").materials.at("m");
}

RecipeLook look_of(const MaterialRule& rule, int side = k_side) {
  return recipe_look(rule, compile_for_look(rule.recipe, library(), ".", rule.time), side);
}

std::vector<unsigned char> pixels_of(const EncodedImage& image) {
  std::vector<unsigned char> rgba;
  const ColorImage decoded = decode_color_image(image.bytes, "picture");
  for (std::size_t i = 0; i < decoded.pixels.size(); ++i) {
    rgba.push_back(decoded.pixels[i]);
    if (i % 3 == 2) rgba.push_back(255);
  }
  return rgba;
}

TEST(RecipeLook, IsThatOfTheBake) {
  const MaterialRule rule = rule_of(k_gentle);
  const Grain grain = make_shown_grain(rule, library());
  const RecipeLook look = look_of(rule);
  ASSERT_TRUE(grain.picture);
  ASSERT_TRUE(grain.shine);
  EXPECT_EQ(look.color, pixels_of(*grain.picture));
  EXPECT_EQ(look.normal, pixels_of(grain.normal_png));
  EXPECT_EQ(look.shine, pixels_of(*grain.shine));
  EXPECT_EQ(look.roughness, grain.roughness_factor);
  EXPECT_EQ(look.metallic, grain.metallic_factor);
}

TEST(RecipeLook, ARuleThatShowsTheReliefHasNoColour) {
  const RecipeLook look = look_of(rule_of(k_gentle, R"(, "show": "relief")"));
  EXPECT_TRUE(look.color.empty() && look.shine.empty());
  EXPECT_EQ(look.normal, look_of(rule_of(k_gentle)).normal);
  EXPECT_TRUE(look_of(rule_of("fbm|cols=black,white"), 64).color.empty()) << "without colours the relief is shown";
  EXPECT_FALSE(look_of(rule_of("fbm|cols=black,white", R"(, "show": "picture")"), 64).color.empty());
}

TEST(RecipeLook, NoSlopeIsSteeperThanTheRuleAllows) {
  const auto steepest = [](const RecipeLook& look) {
    double most = 0;
    for (std::size_t i = 0; i < look.normal.size(); i += 4) {
      const auto part = [&](std::size_t k) { return look.normal[i + k] / 127.5 - 1; };
      most = std::max(most, std::hypot(part(0), part(1)) / part(2));
    }
    return most;
  };
  const std::string steep = "brick|scale=.5";
  // Two bytes of a normal, each off by half, at a slope of 1/2.
  constexpr double k_rounding = 0.02;
  EXPECT_NEAR(steepest(look_of(rule_of(steep, R"(, "staticFriction": 0.6666667, "dynamicFriction": 0.5)"))), 0.5,
              k_rounding);
  EXPECT_GT(steepest(look_of(rule_of(steep, R"(, "staticFriction": 0.1, "dynamicFriction": 0.1)"))), 0.6);
}

TEST(RecipeLook, TellsWhatATileDoesNotShow) {
  const auto needs = [](const std::string& recipe) { return needs_atlas(compile_for_look(recipe, library(), ".", 0)); };
  EXPECT_FALSE(needs(k_gentle));
  EXPECT_TRUE(needs("base|mainfunction=posx"));
  EXPECT_TRUE(needs("snow"));
}

TEST(RecipeLook, AgesWithTime) {
  const auto picture = [](double time) {
    return recipe_picture(compile_for_look("rusty_paint", library(), ".", time), 32);
  };
  EXPECT_EQ(picture(0.5), picture(0.5));
  EXPECT_NE(picture(0), picture(1));
  EXPECT_EQ(picture(1).size(), 4U * 32 * 32);
}

TEST(RecipeLook, RefusesAndCanBeEnded) {
  const MaterialRule rule = rule_of(k_gentle);
  const ProceduralTexture texture = compile_for_look(k_gentle, library(), ".", 0);
  for (const int side : {15, 2049, 0, -1}) EXPECT_THROW(recipe_look(rule, texture, side), InvalidInput) << side;
  EXPECT_THROW(recipe_look(rule, texture, 64, [](const Progress&) { return false; }), Cancelled);
  EXPECT_THROW(compile_for_look("fbm|octves=3", library(), ".", 0), RecipeError);
  EXPECT_THROW(compile_for_look("image|picpath=../secret.png", library(), ".", 0), RecipeError);
}

}  // namespace
}  // namespace papilla
