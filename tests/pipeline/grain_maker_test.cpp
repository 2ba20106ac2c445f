// SPDX-License-Identifier: GPL-3.0-or-later
// Grains made ahead are the grains that are made when they are asked for.
#include "grain_maker.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/grain.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;

class GrainMakerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    for (const auto& [name, kind] : {std::pair{"balls", GrainKind::spheres6}, {"ovals", GrainKind::ovals8}}) {
      GrainOptions options;
      options.size_px = 64;
      write_grey_image(folder_ / (std::string(name) + ".png"), synthesize_grain(kind, options).picture, 8);
      add(name, folder_ / (std::string(name) + ".png"));
    }
    add("lost", folder_ / "none.png");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void add(const std::string& name, const fs::path& texture) {
    MaterialRule rule;
    rule.name = name, rule.texture = texture;
    rule.size_mm[0] = 40, rule.size_mm[1] = 20;
    rule.height.depth_mm = 0.4;
    rules_.materials[name] = rule;
    AssignRule assign;
    assign.material = name;
    rules_.assign.push_back(assign);
  }

  void expect_same(const Grain& a, const std::string& material) const {
    const Grain b = make_grain(rules_.materials.at(material), library_);
    EXPECT_EQ(a.normal_png.bytes, b.normal_png.bytes);
    EXPECT_EQ(a.height_png.bytes, b.height_png.bytes);
    EXPECT_FALSE(a.height_png.bytes.empty());
  }

  fs::path folder_ = fs::temp_directory_path() / ("papilla-grains-" + std::to_string(::getpid()));
  Materials rules_;
  RecipeLibrary library_ = RecipeLibrary::builtin();
};

TEST_F(GrainMakerTest, AheadOrNotGrainsAreTheSame) {
  for (const bool ahead : {false, true}) {
    GrainMaker maker(rules_, library_, {}, nullptr);
    if (ahead) maker.begin_ahead();
    expect_same(maker.take("ovals"), "ovals");
    expect_same(maker.take("balls"), "balls");
  }
}

TEST_F(GrainMakerTest, AFailureIsToldWhereItIsAskedFor) {
  GrainMaker maker(rules_, library_, {}, nullptr);
  maker.begin_ahead();
  EXPECT_THROW(maker.take("lost"), IoError);
  expect_same(maker.take("balls"), "balls");
}

TEST_F(GrainMakerTest, WhatNobodyAsksForIsLeft) {
  constexpr std::size_t k_many = 12;
  for (std::size_t i = 0; i < k_many; ++i) {
    const std::string name = "deeper " + std::to_string(i);
    add(name, folder_ / "balls.png");
    rules_.materials.at(name).height.depth_mm = 0.5 + 0.1 * static_cast<double>(i);
  }
  const StageCache cache{ContentStore(folder_ / "cache")};
  {
    GrainMaker maker(rules_, library_, {}, &cache);
    maker.begin_ahead();
  }
  EXPECT_LT(cache.results().size(), k_many) << "it ends with the grain that it is making";
}

TEST_F(GrainMakerTest, ADeadlineHoldsForWhatIsMadeWhenAskedFor) {
  GrainMaker maker(rules_, library_, Deadline(1000), nullptr);
  maker.begin_ahead();
  maker.finish_by(Deadline(900));
  expect_same(maker.take("ovals"), "ovals");
}

TEST_F(GrainMakerTest, ShownGrainsAreTheSameButForWhatIsOnlyTold) {
  MaterialRule rule = rules_.materials.at("ovals");
  bool has_lattice = false, has_dimension = false;
  for (const char* recipe : {"rust_base", "grain:spheres6"}) {
    SCOPED_TRACE(recipe);
    rule.texture = rule.recipe = recipe;
    const Grain whole = make_grain(rule, library_), shown = make_shown_grain(rule, library_);
    EXPECT_FALSE(shown.lattice || shown.tag.symmetry);
    EXPECT_EQ(shown.height_png.bytes, whole.height_png.bytes);
    EXPECT_EQ(shown.normal_png.bytes, whole.normal_png.bytes);
    MaterialTag rest = whole.tag;
    ASSERT_TRUE(rest.roughness);
    has_lattice = has_lattice || (whole.lattice && rest.symmetry);
    has_dimension = has_dimension || rest.roughness->fractal_dimension;
    rest.symmetry.reset(), rest.roughness->fractal_dimension.reset();
    EXPECT_EQ(to_json(shown.tag), to_json(rest));
    EXPECT_EQ(std::vector(shown.size_mm, shown.size_mm + 2), std::vector(whole.size_mm, whole.size_mm + 2));
  }
  EXPECT_TRUE(has_lattice && has_dimension) << "else it has nothing that could be left out";

  // Pictures are read in any case, as their relief needs it; what the cache knows is taken.
  const MaterialRule& picture = rules_.materials.at("ovals");
  EXPECT_EQ(to_json(make_shown_grain(picture, library_).tag), to_json(make_grain(picture, library_).tag));
  const StageCache cache{ContentStore(folder_ / "cache")};
  make_grain(rule, library_, {}, &cache);
  EXPECT_TRUE(make_shown_grain(rule, library_, {}, &cache).lattice);
}

}  // namespace
}  // namespace papilla
