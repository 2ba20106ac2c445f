// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/materials_page.hpp"

#include <gtest/gtest.h>

#include "json/materials_json.hpp"
#include "text/materials_text.hpp"

namespace papilla::app {
namespace {

LibraryMaterial cloth() {
  LibraryMaterial m;
  m.id = "textile/cloth";
  m.name_en = "Cloth <b>";
  m.name_de = "Tuch, gebürstet";
  m.categories = {{"textile"}, {"Textil"}};
  m.uses = {{"seat"}, {"Sitz"}};
  m.stiffness = {300, "", "a guess"};
  m.damping = {0.5, "", ""};
  m.static_friction = {0.5, "paper", "table 1"};
  m.dynamic_friction = {0.4, "paper", ""};
  m.stribeck_velocity = {0.01, "", ""};
  m.backing = LibraryBacking{{900, "", ""}, {3, "", ""}};
  m.appearance = {{"#336699", "", ""}, {0.9, "", ""}, {0, "", ""}};
  m.sources = {{"paper", "Author: On cloth, 2001"}};
  return m;
}

TEST(MaterialsPage, HasACardAMaterialAndLoadsNothingFromOutside) {
  const LibraryMaterial a = cloth();
  const std::string page = materials_page({{&a, "data:image/png;base64,AAAA"}});
  EXPECT_NE(page.find("data-words=\"textile cloth cloth  b  tuch  geburstet textile textil seat sitz\""),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("Cloth &lt;b&gt;"), std::string::npos);
  EXPECT_NE(page.find("Author: On cloth, 2001 – table 1"), std::string::npos);
  EXPECT_NE(page.find("library:textile/cloth"), std::string::npos);
  EXPECT_NE(page.find("<option value=\"textile\">textile · Textil</option>"), std::string::npos);
  EXPECT_EQ(page.find("http:"), std::string::npos);
  EXPECT_EQ(page.find("https:"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST(MaterialsJson, SaysOfEveryNumberWhereItComesFrom) {
  const Json json = library_material_json(cloth());
  EXPECT_EQ(json["name"], "textile/cloth");
  EXPECT_EQ(json["category"], "textile");
  EXPECT_EQ(json["static_friction"], 0.5);
  EXPECT_EQ(json["backing"]["depth_mm"], 3);
  EXPECT_TRUE(json["height"].is_null());
  EXPECT_TRUE(json["youngs_modulus"].is_null());
  EXPECT_EQ(json["sources"]["staticFriction"], "Author: On cloth, 2001");
  EXPECT_EQ(json["sources"]["stiffness"], "estimated");
  EXPECT_EQ(json["notes"]["stiffness"], "a guess");
}

TEST(MaterialsText, ShowsUnitsAndSources) {
  const std::string text = library_material_text(cloth());
  EXPECT_NE(text.find("300 N/m    estimated: a guess"), std::string::npos) << text;
  EXPECT_NE(text.find("[paper]: table 1"), std::string::npos);
  EXPECT_NE(text.find("[paper] Author: On cloth, 2001"), std::string::npos);
  EXPECT_EQ(suggestions_text({}), "");
  EXPECT_NE(suggestions_text({{"seat", "textile/cloth", "why"}}).find("nothing of it is applied"), std::string::npos);
}

}  // namespace
}  // namespace papilla::app
