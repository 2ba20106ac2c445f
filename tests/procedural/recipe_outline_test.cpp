// SPDX-License-Identifier: MIT
#include "papilla/procedural/recipe_outline.hpp"

#include <gtest/gtest.h>

#include "papilla/procedural/recipe_completion.hpp"
#include "papilla/procedural/recipe_error.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {
namespace {

const RecipeLibrary& library() {
  static const RecipeLibrary all = RecipeLibrary::builtin();
  return all;
}

const std::string k_layers =
    "multi|textures=leather,[brick|scale=.5|cols=grey,<.7, .2,.1>|mainfunction=this*[fbm|scale=.2]-.25*x],[dust]"
    "|seed=3";

std::vector<std::string> texts(const std::string& text) {
  std::vector<std::string> out;
  for (const OutlineTexture& t : outline_recipe(text, library())) out.emplace_back(t.text.of(text));
  return out;
}

TEST(RecipeOutline, TexturesComeWithThoseWithinBehindThem) {
  const auto outline = outline_recipe(k_layers, library());
  ASSERT_EQ(outline.size(), 5U);
  EXPECT_EQ(texts(k_layers)[1], "leather");
  EXPECT_EQ(outline[2].item.of(k_layers).front(), '[');
  EXPECT_EQ(texts(k_layers)[3], "fbm|scale=.2");
  EXPECT_EQ(outline[0].type, "multi");
  EXPECT_NE(outline[1].type, "") << "the type of a recipe of the library";
  EXPECT_EQ(outline[3].type, "fbm");
  EXPECT_EQ(outline[3].parent, 2U);
  EXPECT_FALSE(outline[3].in_list);
  EXPECT_EQ(outline[4].parent, 0U);
  EXPECT_TRUE(outline[4].in_list);
}

TEST(RecipeOutline, NumbersAndColoursStandWhereTheyAreWritten) {
  const auto outline = outline_recipe(k_layers, library());
  const auto& brick = outline[2].parameters;
  ASSERT_EQ(brick.size(), 3U);
  EXPECT_EQ(brick[0].name.of(k_layers), "scale");
  ASSERT_EQ(brick[0].numbers.size(), 1U);
  EXPECT_EQ(brick[0].numbers[0].at.of(k_layers), ".5");
  EXPECT_EQ(brick[0].numbers[0].value, 0.5);
  ASSERT_EQ(brick[1].colours.size(), 2U);
  EXPECT_EQ(brick[1].colours[0].at.of(k_layers), "grey");
  EXPECT_EQ(brick[1].colours[1].at.of(k_layers), "<.7, .2,.1>");
  EXPECT_EQ(brick[1].colours[1].rgb, (std::array<double, 3>{0.7, 0.2, 0.1}));
  ASSERT_EQ(brick[2].numbers.size(), 1U) << "those of the inline texture are its own";
  EXPECT_EQ(brick[2].numbers[0].at.of(k_layers), ".25") << "the minus is an operator";
}

TEST(RecipeOutline, NumbersInFormulasAreReadAsFormulasReadThem) {
  const std::string text =
      "base|mainfunction=max(-1e-3, 2^-3)*noise2d(4*x,5)|scale=<-.5,2>|du=-.25|timemodifiers=du:.5*time";
  std::vector<std::string> found;
  const auto outline = outline_recipe(text, library());
  for (const OutlineParameter& p : outline[0].parameters)
    for (const OutlineNumber& n : p.numbers) found.emplace_back(n.at.of(text));
  EXPECT_EQ(found, (std::vector<std::string>{"-1e-3", "2", "3", "4", "5", "-.5", "2", "-.25", ".5"}));
}

TEST(RecipeOutline, ANameOfAColourThatIsARecipeIsAColourInListsOnly) {
  const std::string text = "base|cols=snow,black|colorfunction=colmix(snow,red,.5)";
  const auto outline = outline_recipe(text, library());
  EXPECT_EQ(outline[0].parameters[0].colours.size(), 2U);
  ASSERT_EQ(outline[0].parameters[1].colours.size(), 1U);
  EXPECT_EQ(outline[0].parameters[1].colours[0].at.of(text), "red");
}

TEST(RecipeOutline, ATextThatCanNotBeTakenApartSaysWhere) {
  try {
    outline_recipe("multi|textures=[leather,\ndust", library());
    FAIL();
  } catch (const RecipeError& error) {
    EXPECT_EQ(error.position(), 15U);
    EXPECT_NE(std::string(error.what()).find("line 1, column 16"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(outline_recipe("nothing|a=b", library()));
  EXPECT_EQ(outline_recipe("nothing|a=b", library())[0].type, "");
}

TEST(RecipeOutline, AMistakeHasItsPlaceInBytesLinesAndColumns) {
  const std::string text = "fbm|scale=.2\n|octves=3";
  try {
    compile_texture(text, library());
    FAIL();
  } catch (const RecipeError& error) {
    EXPECT_EQ(error.source(), "recipe");
    EXPECT_EQ(text.substr(error.position(), 6), "octves");
    EXPECT_EQ(std::string(error.what()), "recipe: line 2, column 2: " + error.reason());
    EXPECT_NE(error.reason().find("'octaves'"), std::string::npos);
  }
}

TEST(RecipeLayers, ALayerGoesBeforeOrBehindAnother) {
  const auto moved = [](const std::string& text, std::size_t layer, std::size_t other, bool behind) {
    return move_layer(text, library(), layer, other, behind);
  };
  const std::string abc = "multi|textures=leather, [dust|seed=1] ,moss|seed=2";
  EXPECT_EQ(moved(abc, 1, 3, true), "multi|textures=[dust|seed=1] ,moss,leather|seed=2");
  EXPECT_EQ(moved(abc, 1, 2, true), "multi|textures=[dust|seed=1],leather ,moss|seed=2");
  EXPECT_EQ(moved(abc, 3, 1, false), "multi|textures=moss,leather, [dust|seed=1] |seed=2");
  EXPECT_EQ(moved(abc, 2, 1, false), "multi|textures=[dust|seed=1],leather, moss|seed=2");
  EXPECT_EQ(moved(abc, 2, 2, true), abc);
  // Out of a list within, and into it.
  const std::string nested = "multi|textures=leather,[multi|textures=dust,moss]";
  EXPECT_EQ(moved(nested, 3, 1, true), "multi|textures=leather,dust,[multi|textures=moss]");
  EXPECT_EQ(moved(nested, 4, 2, true), "multi|textures=leather,[multi|textures=dust],moss");
  EXPECT_EQ(moved(nested, 1, 4, true), "multi|textures=[multi|textures=dust,moss,leather]");
}

/// Every move of every layer keeps all of them, and another one brings the text's layers back in their order.
TEST(RecipeLayers, MovesOnlyMove) {
  const std::string text = "multi|textures=leather,[multi|textures=dust, moss,[snow|seed=4]],[fbm|scale=.2]|seed=1";
  const auto sorted = [](std::vector<std::string> all) {
    std::erase_if(all, [](const std::string& t) { return t.starts_with("multi"); });
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::size_t count = outline_recipe(text, library()).size();
  int moves = 0;
  for (std::size_t layer = 1; layer < count; ++layer)
    for (std::size_t other = 1; other < count; ++other)
      for (const bool behind : {false, true}) {
        try {
          EXPECT_EQ(sorted(texts(move_layer(text, library(), layer, other, behind))), sorted(texts(text)));
          ++moves;
        } catch (const InvalidInput& error) {
          EXPECT_EQ(layer, 2U) << error.what();  // Into itself.
        }
      }
  EXPECT_EQ(moves, 2 * (36 - 3));
}

TEST(RecipeLayers, LayersComeAndGo) {
  EXPECT_EQ(insert_layer(" leather ", library(), 0, true, "dust"), "multi|textures=[leather],[dust]");
  EXPECT_EQ(insert_layer("leather", library(), 0, false, "dust"), "multi|textures=[dust],[leather]");
  const std::string two = insert_layer("multi|textures=leather", library(), 1, true, "dust|seed=1");
  EXPECT_EQ(two, "multi|textures=leather,[dust|seed=1]");
  EXPECT_EQ(remove_layer(two, library(), 1), "multi|textures=[dust|seed=1]");
  EXPECT_EQ(remove_layer(two, library(), 2), "multi|textures=leather");
  EXPECT_THROW(remove_layer("multi|textures=leather", library(), 1), InvalidInput);
  EXPECT_THROW(remove_layer(two, library(), 0), InvalidInput);
  EXPECT_THROW(remove_layer(two, library(), 9), InvalidInput);
  EXPECT_THROW(move_layer("base|mainfunction=[fbm]+1", library(), 1, 1, true), InvalidInput) << "no layer of a list";
}

std::vector<std::string> completed(const std::string& text) {
  std::vector<std::string> names;
  for (const Completion& c : complete_recipe(text, text.size(), library()).all) names.push_back(c.insert);
  return names;
}
bool has(const std::vector<std::string>& all, const std::string& name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}

TEST(RecipeCompletion, WhatMayStandThere) {
  EXPECT_EQ(completed("").size(), texture_types().size() + library().recipes().size());
  EXPECT_EQ(completed("lea")[0], "leather");
  EXPECT_TRUE(has(completed("lea"), "worn_leather")) << "those that hold the letters come behind";
  EXPECT_EQ(completed("fbm|oct")[0], "octaves=");
  EXPECT_FALSE(has(completed("fbm|octaves=3|oct"), "octaves=")) << "given already";
  EXPECT_TRUE(has(completed("leather|sca"), "scale=")) << "of the type of a recipe";
  EXPECT_EQ(completed("fbm|type=ri"), (std::vector<std::string>{"ridgedmultifractal", "hybridmultifractal"}));
  EXPECT_EQ(completed("brick|tiling="), (std::vector<std::string>{"false", "true"}));
  EXPECT_EQ(completed("fbm|cols=black,firebr")[0], "firebrick");
  EXPECT_TRUE(has(completed("base|mainfunction=.5+nois"), "noise2d("));
  EXPECT_TRUE(has(completed("base|mainfunction=x*ti"), "time"));
  EXPECT_TRUE(has(completed("multi|textures=leather,[fb"), "fbm"));
  EXPECT_EQ(completed("multi|textures=[fbm|lacu"), (std::vector<std::string>{"lacunarity="}));
  EXPECT_TRUE(has(completed("multi|textures=[fbm|seed=1]|bumpsc"), "bumpscale=")) << "of the texture around it again";
  EXPECT_TRUE(completed("fbm|octaves=12").empty()) << "numbers are not completed";
  EXPECT_TRUE(completed("nothing|a").empty());
  EXPECT_FALSE(has(completed("fbm|u"), "uORIG=")) << "what is refused is not offered";
}

TEST(RecipeCompletion, TheWordIsReplacedAsAWhole) {
  const std::string text = "fbm|octaves=3";
  const Completions found = complete_recipe(text, 6, library());
  EXPECT_EQ(found.word.of(text), "octaves");
  EXPECT_EQ(found.all.front().insert, "octaves") << "what follows is there";
  EXPECT_EQ(complete_recipe(text, 999, library()).word, (TextSpan{12, 13}));
}

}  // namespace
}  // namespace papilla
