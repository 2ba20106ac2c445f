// SPDX-License-Identifier: MIT
#include "papilla/pipeline/material_differences.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla {
namespace {

FeltMaterial felt(double k, double b, double mu_s, double mu_d) { return {"m", k, b, mu_s, mu_d, "", "", {}}; }

MaterialPair compare(const FeltMaterial& a, const FeltMaterial& b) {
  const MaterialPair pair = compare_materials(std::vector{a, b}).at(0);
  const MaterialPair turned = compare_materials(std::vector{b, a}).at(0);
  EXPECT_EQ(pair.verdict, turned.verdict);
  EXPECT_EQ(pair.difference, turned.difference);
  return pair;
}

double difference(const MaterialPair& pair, TouchQuantity quantity) {
  return pair.difference[static_cast<std::size_t>(quantity)].value();
}

TEST(MaterialDifferences, AreMeasuredAgainstTheFractions) {
  const FeltMaterial base = felt(500, 2, 0.5, 0.4);
  struct Case {
    FeltMaterial other;
    TouchQuantity quantity;
    double difference;
    PairVerdict verdict;
  };
  for (const Case& c : {Case{felt(610, 2, 0.5, 0.4), TouchQuantity::stiffness, 0.22, PairVerdict::alike},
                        Case{felt(620, 2, 0.5, 0.4), TouchQuantity::stiffness, 0.24, PairVerdict::told_apart},
                        Case{felt(400, 2, 0.5, 0.4), TouchQuantity::stiffness, 0.25, PairVerdict::told_apart},
                        Case{felt(500, 3.3, 0.5, 0.4), TouchQuantity::viscosity, 1.3 / 4, PairVerdict::alike},
                        Case{felt(500, 3.4, 0.5, 0.4), TouchQuantity::viscosity, 1.4 / 4, PairVerdict::told_apart},
                        Case{felt(500, 1.1, 0.5, 0.4), TouchQuantity::viscosity, 0.9 / 3.1, PairVerdict::alike},
                        Case{felt(500, 2, 0.58, 0.47), TouchQuantity::friction, 0.175, PairVerdict::alike},
                        Case{felt(500, 2, 0.5, 0.48), TouchQuantity::friction, 0.2, PairVerdict::told_apart},
                        Case{felt(500, 2, 0.6, 0.4), TouchQuantity::friction, 0.2, PairVerdict::told_apart},
                        Case{base, TouchQuantity::roughness, 0, PairVerdict::alike}}) {
    const MaterialPair pair = compare(base, c.other);
    EXPECT_NEAR(difference(pair, c.quantity), c.difference, 1e-12);
    EXPECT_EQ(pair.verdict, c.verdict) << pair.reason;
  }
  EXPECT_NE(compare(base, felt(900, 2, 0.9, 0.4)).reason.find("stiffness, friction"), std::string::npos);
}

TEST(MaterialDifferences, NothingAgainstSomethingIsInfinite) {
  const MaterialPair slippery = compare(felt(500, 0, 0, 0), felt(500, 0, 0.1, 0.1));
  EXPECT_TRUE(std::isinf(difference(slippery, TouchQuantity::friction)));
  EXPECT_EQ(slippery.verdict, PairVerdict::told_apart);
  const MaterialPair none = compare(felt(500, 0, 0, 0), felt(500, 0.6, 0, 0));
  EXPECT_EQ(difference(none, TouchQuantity::friction), 0);
  EXPECT_EQ(none.verdict, PairVerdict::alike) << "0.6 N·s/m are far below what was ever told from nothing";
}

TEST(MaterialDifferences, FractionsHaveSources) {
  const std::array<double, 4> known = {0.23, 0.34, 0.18, 0.20};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(weber_fractions()[k].fraction, known[k]);
    EXPECT_FALSE(weber_fractions()[k].source.empty());
  }
}

FeltMaterial with_relief(const std::string& pattern, std::optional<double> roughness, double times = 50) {
  FeltMaterial material = felt(500, 1, 0.5, 0.4);
  material.pattern = pattern;
  if (roughness) {
    material.felt.emplace();
    material.felt->roughness = *roughness;
    material.felt->most_times_threshold = times;
  }
  return material;
}

TEST(MaterialDifferences, ReliefsTellApart) {
  const FeltMaterial smooth = felt(500, 1, 0.5, 0.4);
  const MaterialPair rough = compare(with_relief("a", 9), with_relief("b", 11.1));
  EXPECT_NEAR(difference(rough, TouchQuantity::roughness), 0.21, 1e-12);
  EXPECT_EQ(rough.verdict, PairVerdict::told_apart);
  const MaterialPair pattern = compare(with_relief("a", 9), with_relief("b", 9.5));
  EXPECT_EQ(pattern.verdict, PairVerdict::told_apart);
  EXPECT_NE(pattern.reason.find("reliefs are different"), std::string::npos);
  EXPECT_EQ(compare(with_relief("a", 9), with_relief("a", 9)).verdict, PairVerdict::alike);
  EXPECT_EQ(compare(with_relief("a", 0.1, 0.5), with_relief("b", 0.12, 0.6)).verdict, PairVerdict::alike);
  EXPECT_EQ(compare(with_relief("a", 0.1, 0.5), smooth).verdict, PairVerdict::alike);
  EXPECT_EQ(compare(with_relief("a", 9), smooth).verdict, PairVerdict::told_apart);
  EXPECT_EQ(compare(with_relief("a", {}), with_relief("b", {})).verdict, PairVerdict::unknown);
  EXPECT_EQ(compare(with_relief("a", {}), smooth).verdict, PairVerdict::unknown);
  EXPECT_FALSE(compare(with_relief("a", {}), smooth).difference[3]);
  EXPECT_EQ(compare(with_relief("a", {}), with_relief("a", {})).verdict, PairVerdict::alike);
  FeltMaterial other = smooth;
  other.models = "bristle 300";
  EXPECT_EQ(compare(other, smooth).verdict, PairVerdict::unknown);
}

MaterialRule rule(const std::string& name, double stiffness, double scale) {
  MaterialRule rule;
  rule.name = name;
  rule.stiffness = stiffness;
  rule.static_friction = 0.3;
  if (scale == 0) return rule;
  rule.texture = rule.recipe = "grain:leather";
  rule.size_mm[0] = rule.size_mm[1] = 40;
  rule.height.depth_mm = 0.05;
  rule.height.scale = scale;
  return rule;
}

TEST(MaterialDifferences, OfASceneBeforeAndAfterItsGrainsAreMade) {
  Materials rules;
  for (const MaterialRule& r : {rule("coarse", 500, 3), rule("fine", 520, 1), rule("fine too", 510, 1),
                                rule("hard", 2000, 0), rule("smooth", 540, 0), rule("unused", 1, 0)})
    rules.materials.emplace(r.name, r);
  std::vector<PartSurface> surfaces;
  for (const char* name : {"smooth", "fine", "fine too", "coarse", "hard", "fine", ""}) {
    surfaces.emplace_back();
    surfaces.back().material = name;
  }
  const auto verdict = [](const TouchReport& report, const std::string& a, const std::string& b) {
    for (const MaterialPair& pair : report.pairs)
      if (report.materials[pair.a].name == a && report.materials[pair.b].name == b) return pair.verdict;
    ADD_FAILURE() << a << ", " << b;
    return PairVerdict::unknown;
  };
  const TouchReport before = report_touch(rules, surfaces, {});
  ASSERT_EQ(before.materials.size(), 5U);
  EXPECT_EQ(before.pairs.size(), 10U);
  EXPECT_TRUE(before.savings.empty());
  EXPECT_EQ(verdict(before, "fine", "fine too"), PairVerdict::alike);
  EXPECT_EQ(verdict(before, "coarse", "fine"), PairVerdict::unknown);
  EXPECT_EQ(verdict(before, "fine", "smooth"), PairVerdict::unknown);
  EXPECT_EQ(verdict(before, "hard", "smooth"), PairVerdict::told_apart);

  std::map<std::string, Grain> grains;
  for (const char* name : {"coarse", "fine", "fine too"}) grains.emplace(name, make_grain(rules.materials.at(name)));
  const TouchReport after = report_touch(rules, surfaces, grains);
  EXPECT_EQ(verdict(after, "fine", "fine too"), PairVerdict::alike);
  EXPECT_EQ(verdict(after, "coarse", "fine"), PairVerdict::told_apart);
  EXPECT_EQ(verdict(after, "fine", "smooth"), PairVerdict::told_apart);
  ASSERT_EQ(after.savings.size(), 3U);
  EXPECT_EQ(after.savings.at("fine").bytes, grains.at("fine").height_png.bytes.size());
  EXPECT_NEAR(after.materials[0].felt->times_threshold / after.materials[1].felt->times_threshold, 3, 0.2);
}

}  // namespace
}  // namespace papilla
