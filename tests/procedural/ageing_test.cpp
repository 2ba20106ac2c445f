// SPDX-License-Identifier: MIT
#include "papilla/procedural/ageing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

/// "recipe strength, …" of words; strengths in hundredths.
std::string layers(std::string_view words) {
  std::string out;
  for (const AgeingLayer& layer : ageing_layers(words))
    out += (out.empty() ? "" : ", ") + layer.recipe + " " + std::to_string(std::lround(100 * layer.strength));
  return out;
}

struct Case {
  const char *words, *layers;
};

TEST(AgeingWords, PickRecipesWithTheirStrength) {
  constexpr Case cases[] = {
      {"rusty", "rust_on 60"},
      {"very rusty", "rust_on 85"},
      {"slightly dusty", "dust 30"},
      {"dusty 0.7", "dust 70"},
      {"dusty=.25", "dust 25"},
      {"dusty 40%", "dust 40"},
      {"Worn and dusty", "scratches 18, edge_wear 48, polish 60, dust 60"},
      {"wet, mossy; snowy", "moss 60, wetness 60, snow 60"},
      {"a little scratched", "scratches 30"},
      {"completely faded", "greying 100"},
      {"dusty rusty", "rust_on 60, dust 60"},
      {"dirty and very dirty", "dirt 85"},
      {"old", "greying 48, scratches 30, polish 36, dirt 30"},
      {"sehr rostig und etwas staubig", "rust_on 85, dust 30"},
      {"Stark verrostete, leicht verstaubter", "rust_on 85, dust 30"},
      {"völlig abblätternd", "chipped_paint 100"},
      {"schäbiges", "greying 36, scratches 36, edge_wear 48, grime 36"},
      {"nass 1", "wetness 100"},
  };
  for (const Case& c : cases) EXPECT_EQ(layers(c.words), c.layers) << c.words;
}

std::string refusal(const char* words) {
  try {
    ageing_layers(words);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(AgeingWords, RefuseWhatTheyDoNotKnow) {
  EXPECT_NE(refusal("rustty").find("unknown word 'rustty'; did you mean 'rusty'?"), std::string::npos)
      << refusal("rustty");
  EXPECT_NE(refusal("verry rusty").find("did you mean 'very'?"), std::string::npos);
  EXPECT_NE(refusal("dusty 1.5").find("'1.5' is not in (0, 1]"), std::string::npos);
  EXPECT_NE(refusal("dusty 0").find("is not in (0, 1]"), std::string::npos);
  EXPECT_NE(refusal("dusty nan").find("is not in (0, 1]"), std::string::npos);
  EXPECT_NE(refusal("very").find("'very' belongs to no word"), std::string::npos);
  EXPECT_NE(refusal("0.3 dusty").find("'0.3' stands behind no word"), std::string::npos);
  EXPECT_NE(refusal("").find("is missing"), std::string::npos);
  EXPECT_NE(refusal(" , and ").find("is missing"), std::string::npos);
}

TEST(AgeingWords, AreFoundInATextAboutAMaterial) {
  const AgeingInText found = find_ageing("very rusty steel door, old");
  ASSERT_FALSE(found.layers.empty());
  EXPECT_EQ(found.rest, "steel door");
  EXPECT_TRUE(find_ageing("leather black 2").layers.empty());
  EXPECT_EQ(find_ageing("leather black 2").rest, "leather black 2");
}

TEST(AgeingWords, AllNameRecipesThatAge) {
  const RecipeLibrary library = RecipeLibrary::builtin();
  std::string before;
  for (const AgeingWord& word : ageing_words()) {
    EXPECT_EQ(layers(word.word).empty(), false);
    for (const AgeingLayer& layer : ageing_layers(std::string(word.word) + " 1")) {
      const std::string* recipe = library.find(layer.recipe);
      ASSERT_NE(recipe, nullptr) << word.word << ": " << layer.recipe;
      EXPECT_NE(recipe->find("idtype=ageing"), std::string::npos) << layer.recipe;
      EXPECT_GT(layer.strength, 0);
    }
  }
}

TEST(AgeingWords, ShowMoreTheStrongerTheyAreAndNothingAtTimeZero) {
  const RecipeLibrary library = RecipeLibrary::builtin();
  const auto colours = [&](const std::string& words, double time) {
    return test::rendered(aged_recipe("plastic_grain", ageing_layers(words)), 48, library, test::at_time(time),
                          1U << static_cast<unsigned>(Channel::color))
        .values[Channel::color];
  };
  const std::vector<float> fresh = colours("dusty", 0);
  const auto change = [&](const std::string& words) {
    const std::vector<float> now = colours(words, 1);
    double sum = 0;
    for (std::size_t i = 0; i < now.size(); ++i) sum += std::abs(static_cast<double>(now[i] - fresh[i]));
    return sum;
  };
  EXPECT_EQ(fresh, test::rendered("plastic_grain", 48, library, {}, 1U << static_cast<unsigned>(Channel::color))
                       .values[Channel::color]);
  EXPECT_GT(change("slightly dusty"), 0);
  EXPECT_GT(change("dusty"), 1.5 * change("slightly dusty"));
  EXPECT_GT(change("very dusty"), 1.2 * change("dusty"));
}

}  // namespace
}  // namespace papilla
