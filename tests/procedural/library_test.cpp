// SPDX-License-Identifier: MIT
#include "papilla/procedural/library.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/procedural/reference.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {
namespace {

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "nothing was refused";
}

std::string refusal_of(const std::string& recipe, const RecipeLibrary& library = {}) {
  return refusal([&] { compile_texture(recipe, library); });
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Reference, TablesAreSortedUniqueAndTheirDefaultsCompile) {
  EXPECT_EQ(texture_types().size(), 32U);
  std::set<std::string_view> names;
  for (const FunctionInfo& f : expression_functions()) {
    EXPECT_TRUE(names.insert(f.name).second) << f.name;
    EXPECT_EQ(f.arguments.size(), static_cast<std::size_t>(f.arity)) << f.name;
  }
  EXPECT_GE(names.size(), 100U);
  const RecipeLibrary library = RecipeLibrary::builtin();
  for (const TypeInfo& type : texture_types()) {
    std::string recipe(type.name);
    for (const ParameterInfo& p : type.parameters)
      if (!p.preset.empty()) recipe += "|" + std::string(p.name) + "=" + std::string(p.preset);
    if (type.name == "multi") recipe += "|textures=noise";
    EXPECT_NO_THROW(compile_texture(recipe, library)) << recipe;
  }
}

TEST(Language, EveryFunctionOfTheTableCompilesAndGivesFiniteNumbers) {
  RecipeLibrary library;
  for (const FunctionInfo& f : expression_functions()) {
    std::string call(f.name);
    if (f.arity > 0) {
      call += '(';
      for (std::size_t i = 0; i < static_cast<std::size_t>(f.arity); ++i)
        call +=
            (i ? "," : "") + std::string(f.arguments[i] == 'c' ? "<x,y,.5>"
                                         : (f.name == "get" || f.name == "set" || f.name == "texmap2") && i < 3 ? "0"
                                         : f.name.starts_with("near") && i == 1                                 ? ".3"
                                                                                : "x/y");
      call += ')';
    }
    std::string recipe =
        f.colour ? "base|textures=noise,fbm|colorfunction=" + call : "base|textures=noise,fbm|bumpfunction=" + call;
    if (f.name == "f1" || f.name == "f2" || f.name == "f3" || f.name == "f4") recipe = "voronoi|func=" + call;
    if (f.name == "orig" || f.name == "index") recipe = "voronoi|densityfunc=" + call;
    RenderOptions options;
    options.width = options.height = 8, options.channels = (1U << k_channels) - 1;
    ASSERT_NO_THROW({
      const RenderedTexture texture = render_texture(compile_texture(recipe, library), options);
      for (const auto& channel : texture.values.channels)
        for (const float v : channel) ASSERT_TRUE(std::isfinite(v)) << recipe;
    }) << recipe;
  }
}

TEST(Language, SaysWhereAndWhatWasExpected) {
  EXPECT_TRUE(
      has(refusal_of("fbm|octves=3"), "line 1, column 5: unknown parameter 'octves' of 'fbm'; did you mean 'octaves'?"))
      << refusal_of("fbm|octves=3");
  EXPECT_TRUE(has(refusal_of("fmb"), "column 1: unknown texture 'fmb'; did you mean 'fbm'?")) << refusal_of("fmb");
  EXPECT_TRUE(has(refusal_of("base|mainfunction=nois2d(x,y)"),
                  "column 19: unknown function 'nois2d'; did you mean 'noise2d'?"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=noise2d(x)"), "'noise2d' expects 2 arguments, found 1"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=x+"), "column 21: expected a number"))
      << refusal_of("base|mainfunction=x+");
  EXPECT_TRUE(has(refusal_of("base|mainfunction=(x"), "expected ')'"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=[fbm"), "never closed"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=x+<1,0,0>"), "expected a number, found a colour"));
  EXPECT_TRUE(has(refusal_of("fbm|octaves=99"), "outside [1, 19]"));
  EXPECT_TRUE(has(refusal_of("fbm|octaves=x"), "not known here"));
  EXPECT_TRUE(has(refusal_of("fbm|type=foo"), "expected one of fbm heteroterrain"));
  EXPECT_TRUE(has(refusal_of("fbm|cols=redd"), "unknown colour 'redd'"));
  EXPECT_TRUE(has(refusal_of("fbm|scale=0"), "scale"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=f1"), "within func only"));
  EXPECT_TRUE(has(refusal_of("multi"), "needs the parameter 'textures'"));
  EXPECT_TRUE(has(refusal_of("image|picpath=a.png"), "pictures can't be read here"));
  for (const char* text :
       {"fbm|a", "", "|", "base|mainfunction=s(", "base|mainfunction=1e999", "base|mainfunction=get(99)"})
    EXPECT_FALSE(has(refusal_of(text), "nothing was refused")) << text;
}

TEST(Language, RefusesWhatWouldNeverEnd) {
  RecipeLibrary library;
  library.add("one", "base|mainfunction=two*.5");
  library.add("two", "base|mainfunction=[one|scale=.5]");
  EXPECT_TRUE(has(refusal_of("one", library), "recipe 'one' uses itself: one > two > one"))
      << refusal_of("one", library);
  library.add("me", "me|scale=.5");
  EXPECT_TRUE(has(refusal_of("me", library), "uses itself"));
  // Each level names the one above twice: 2^40 evaluations a point.
  RecipeLibrary doubled;
  doubled.add("n0", "noise");
  for (int i = 1; i <= 28; ++i)
    doubled.add("n" + std::to_string(i), "base|mainfunction=n" + std::to_string(i - 1) + "+n" + std::to_string(i - 1));
  EXPECT_TRUE(has(refusal_of("n28", doubled), "more than 100000"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=" + std::string(100000, '(')), "levels of brackets"));
  EXPECT_TRUE(has(refusal_of("base|mainfunction=" + std::string(5000, '-') + "1"), "too many signs"));
  EXPECT_TRUE(has(refusal_of(std::string(2 << 20, 'a')), "at most 1048576"));
  std::string deep = "noise";
  for (int i = 0; i < 40; ++i) deep = "base|mainfunction=[" + deep + "]*.5";
  EXPECT_TRUE(has(refusal_of(deep), "nested more than 32")) << refusal_of(deep);
}

TEST(Library, ReadsCommentsContinuationsColoursAndIncludes) {
  const auto folder = std::filesystem::temp_directory_path() / ("papilla-recipes-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "main.recipes")
      << "# comment\r\ninclude other.recipes\nmine  brick|scale=.5\n      |brickwidth=.2\n";
  std::ofstream(folder / "other.recipes") << "colour two = red, <0,0,1>\nbase_one fbm|cols=two\n";
  std::ofstream(folder / "loop.recipes") << "include loop.recipes\n";
  RecipeLibrary library;
  library.read_file(folder / "main.recipes");
  ASSERT_NE(library.find("mine"), nullptr);
  EXPECT_EQ(*library.find("mine"), "brick|scale=.5|brickwidth=.2");
  EXPECT_NO_THROW(compile_texture("base_one|seed=3", library));
  EXPECT_TRUE(has(refusal([&] { library.read_file(folder / "loop.recipes"); }), "is included by itself"));
  EXPECT_TRUE(
      has(refusal([&] { library.read_text("old fbm\nlonely\n", "file", {}); }), "file: line 2: expected a name"));
  EXPECT_TRUE(has(refusal([&] { library.add("fbm", "noise"); }), "taken"));
  EXPECT_THROW(library.read_file(folder / "none"), IoError);
  std::filesystem::remove_all(folder);
}

TEST(Library, IncludesLieInTheFolderAndAreNotQuoted) {
  const TemporaryFolder folder("papilla-recipes");
  std::filesystem::create_directories(folder / "inside" / "more");
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("secret", "root:x:0:0:root:/root:/bin/bash\n");
  write("secret2", "root secret words\n9root:x more words\n");
  write("inside/secret", "root:x:0:0:root:/root:/bin/bash\n");
  write("inside/secret2", "9root:x more words\n");
  write("inside/more/good.recipes", "one fbm\n");
  std::filesystem::create_symlink("../secret", folder / "inside/link");
  const auto message = [&](const std::string& name) {
    write("inside/main.recipes", "# first\ninclude " + name + "\n");
    RecipeLibrary library;
    return refusal([&] { library.read_file(folder / "inside/main.recipes"); });
  };
  EXPECT_EQ(message("more/good.recipes"), "nothing was refused");
  for (const std::string& name : {std::string("../secret"), std::string("link"), (folder / "secret2").string()})
    EXPECT_TRUE(has(message(name), "main.recipes: line 2: '" + name + "' leads out of the folder")) << message(name);
  for (const char* name : {"secret", "secret2"}) {
    const std::string inside = message(name);
    EXPECT_TRUE(has(inside, std::string(name) + ": line 1: expected a name")) << inside;
    EXPECT_FALSE(has(inside, "root")) << inside;
  }
  EXPECT_TRUE(has(refusal([&] {
                    RecipeLibrary library;
                    library.read_file(folder / "inside/secret");
                  }),
                  "found 'root:x:0:0:root"))
      << "a file that the user names is quoted";
  write("inside/main.recipes", "include none\n");
  EXPECT_THROW(RecipeLibrary().read_file(folder / "inside/main.recipes"), IoError);
}

TEST(Library, AllBuiltInRecipesCompileAtBothEndsOfTime) {
  const RecipeLibrary library = RecipeLibrary::builtin();
  for (const auto& [name, recipe] : library.recipes())
    for (const double time : {0.0, 1.0}) {
      CompileOptions options;
      options.time = time;
      EXPECT_NO_THROW(compile_texture(name, library, options)) << name;
    }
}

TEST(Library, SuggestsByNameAndMaterial) {
  const RecipeLibrary library = RecipeLibrary::builtin();
  const auto names = suggest_recipes("Leather black 2", library);
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "leather");
  EXPECT_TRUE(suggest_recipes("xyzzy", library).empty());
}

}  // namespace
}  // namespace papilla
