// SPDX-License-Identifier: MIT
// What a shader holds; that it gives the evaluator's channels is tested in a browser (tests/page/shader_test.mjs).
#include "papilla/procedural/shader.hpp"

#include <gtest/gtest.h>

#include <set>

#include "papilla/core/error.hpp"
#include "procedural/examples.hpp"

namespace papilla {
namespace {

std::string refusal(const std::string& recipe) {
  try {
    shader_source(compile_texture(recipe, RecipeLibrary::builtin()));
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Shader, RefusesRastersAndNeighbourhoodsWithTheReason) {
  std::set<std::string_view> refused;
  for (const ShaderSupport& type : shader_support()) {
    if (!type.reason.empty()) refused.insert(type.type);
    EXPECT_EQ(type.reason.empty(), type.reason.find("raster") == std::string::npos) << type.reason;
  }
  EXPECT_EQ(refused, (std::set<std::string_view>{"ifs", "image", "txt"}));
  EXPECT_NE(refusal("base|mainfunction=.3*[txt]").find("'txt'"), std::string::npos);
  EXPECT_NE(refusal("multi|textures=leather,grime").find("nearmean"), std::string::npos);
  EXPECT_NE(refusal("base|mainfunction=churn(x)").find("churn"), std::string::npos);
  EXPECT_EQ(refusal("base|mainfunction=churn(floor(x*3))"), "");
}

TEST(Shader, TakesItsOctavesFromTheSizeOfThePicture) {
  const auto octaves = [](int side) {
    const std::string text = shader_source(compile_texture("turbulence|octaves=12", RecipeLibrary::builtin()),
                                           {ShaderLanguage::glsl, side, side});
    std::size_t count = 0;
    const std::size_t body = text.find("void t0_pattern");
    for (std::size_t at = text.find("noise2(", body); at != std::string::npos; at = text.find("noise2(", at + 1))
      ++count;
    return count;
  };
  // 4 cells a picture, doubled as long as they are wider than two texels.
  EXPECT_EQ(octaves(64), 3U);
  EXPECT_EQ(octaves(512), 6U);
}

TEST(Shader, IsTheSameTextEveryTimeAndOtherTextInTheOtherLanguage) {
  const ProceduralTexture texture = compile_texture("mossy_wall", RecipeLibrary::builtin(), test::at_time(0.5));
  const std::string glsl = shader_source(texture);
  EXPECT_EQ(glsl, shader_source(texture));
  EXPECT_EQ(glsl.find("#version 300 es"), 0U);
  const std::string wgsl = shader_source(texture, {ShaderLanguage::wgsl, 512, 512});
  EXPECT_NE(wgsl.find("@fragment fn papilla_fragment"), std::string::npos);
  // Nothing of one language is left in the other.
  for (const char* word : {"\nfloat ", "uint ", " float(", "?", "$"})
    EXPECT_EQ(wgsl.find(word), std::string::npos) << word;
  EXPECT_EQ(glsl.find('$'), std::string::npos);
}

TEST(Shader, RefusesSizesThatAreNone) {
  const ProceduralTexture texture = compile_texture("noise", RecipeLibrary::builtin());
  EXPECT_THROW(shader_source(texture, {ShaderLanguage::glsl, 0, 64}), InvalidInput);
  EXPECT_THROW(shader_source(texture, {ShaderLanguage::glsl, 64, 70000}), InvalidInput);
}

}  // namespace
}  // namespace papilla
