// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/fit_json.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/pipeline/materials.hpp"
#include "text/fit_text.hpp"

namespace papilla::app {
namespace {

MaterialFit some_fit() {
  MaterialFit fit;
  fit.stiffness = FittedNumber{901.23456, 880, 920};
  fit.damping = FittedNumber{0, 0, 0.1};
  fit.dynamic_friction = FittedNumber{0.345678, 0.3, 0.4};
  fit.roughness = FittedRoughness{{2e-5, 1e-5, 3e-5}, FittedNumber{0.6, 0.5, 0.7}, 1e-4, 2e-2};
  fit.not_identified = {{"static_friction", "one speed"}};
  return fit;
}

TEST(FitJson, IsReadAsMaterials) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "m.json";
  write_atomically(file, json_text(fitted_materials_json("stroke.csv", "seat \"a\"", some_fit())));
  const Materials rules = read_materials(file);
  const MaterialRule& rule = rules.materials.at("seat \"a\"");
  EXPECT_DOUBLE_EQ(*rule.stiffness, 901.2);
  EXPECT_EQ(*rule.damping, 0);
  EXPECT_DOUBLE_EQ(*rule.dynamic_friction, 0.3457);
  EXPECT_FALSE(rule.static_friction || rule.stribeck_velocity);
  ASSERT_EQ(rules.assign.size(), 1U);
  EXPECT_EQ(rules.assign[0].part, "*");
}

TEST(FitJson, HasEveryKey) {
  const Json json = fit_json("stroke.csv", some_fit());
  EXPECT_EQ(json["stiffness"]["low"], 880);
  EXPECT_TRUE(json["static_friction"].is_null());
  EXPECT_EQ(json["not_identified"][0]["parameter"], "static_friction");
  EXPECT_DOUBLE_EQ(json["roughness"]["rms_mm"]["value"].get<double>(), 0.02);
  EXPECT_DOUBLE_EQ(json["roughness"]["dimension"]["low"].get<double>(), 2.3);
  for (const char* key : {"damping", "stribeck_velocity", "rms_residual_n", "samples", "trace", "stop", "surface"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_NE(fit_text(some_fit()).find("not identified: static_friction: one speed"), std::string::npos);
}

}  // namespace
}  // namespace papilla::app
