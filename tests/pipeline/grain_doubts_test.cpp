// SPDX-License-Identifier: MIT
#include "papilla/pipeline/grain_doubts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace papilla {
namespace {

/// A picture with a lattice that explains nearly all of it, and a depth that is said: nothing is uncertain.
struct Known {
  Known() {
    rule.height.depth_mm = 0.3;
    grain.plan = {{"lattice", true, "it repeats"}};
    grain.kind = {TextureKind::strongly_ordered_symmetric, 0.1, 0.05, 0.85};
    grain.lattice.emplace();
    grain.roughness.fractal.emplace();
    grain.height.light = Vec3{0, 0, 1};
  }
  MaterialRule rule;
  Grain grain;
  std::vector<std::string> doubts() const { return grain_doubts(rule, grain); }
  bool doubts_of(const std::string& what) const {
    const auto found = doubts();
    return found.size() == 1 && found[0].starts_with(what + ": ");
  }
};

TEST(GrainDoubts, AreNoneWhereEverythingIsKnown) {
  EXPECT_TRUE(Known().doubts().empty());
  Known recipe;
  recipe.grain.plan.clear();
  recipe.rule.height.depth_mm.reset();
  recipe.grain.roughness = {};
  recipe.grain.kind.strongly_ordered = 0.5;
  EXPECT_TRUE(recipe.doubts().empty()) << "a recipe is what it says";
}

TEST(GrainDoubts, SayWhatAPictureDoesNotSettle) {
  for (const double share : {0.46, 0.54, 0.11, 0.19}) {
    Known near;
    near.grain.kind.strongly_ordered = share;
    EXPECT_TRUE(near.doubts_of("class")) << share;
  }
  for (const double share : {0.44, 0.56, 0.21}) {
    Known far;
    far.grain.kind.strongly_ordered = share;
    EXPECT_TRUE(far.doubts().empty()) << share;
  }
  Known bare;
  bare.grain.lattice.reset();
  EXPECT_TRUE(bare.doubts_of("lattice"));
  Known flat;
  flat.rule.height.depth_mm.reset();
  flat.grain.height.depth_mm = 0.4;
  EXPECT_TRUE(flat.doubts_of("depth"));
  EXPECT_NE(flat.doubts()[0].find("0.4 mm"), std::string::npos);
  Known lit;
  lit.grain.height.light_estimated = true;
  EXPECT_TRUE(lit.doubts_of("light"));
  Known rough;
  rough.grain.roughness.fractal.reset();
  rough.grain.roughness.reason = "no straight line";
  EXPECT_TRUE(rough.doubts_of("roughness"));
  Known warned;
  warned.grain.warnings = {"material 'm': shrunk"};
  EXPECT_EQ(warned.doubts(), warned.grain.warnings);
}

}  // namespace
}  // namespace papilla
