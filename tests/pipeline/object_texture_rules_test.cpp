// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

class ObjectTextureRulesTest : public testing::Test {
 protected:
  Materials read(const std::string& list, const Json& rule) const {
    std::ofstream(path_) << Json{{"materials", Json::object()}, {list, {rule}}}.dump();
    return read_materials(path_);
  }

  /// What reading a rule ends with.
  std::string complaint(const std::string& list, const Json& rule) const {
    try {
      read(list, rule);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  /// The keys that the reader says are known.
  std::set<std::string> known(const std::string& list, Json rule, const std::string& object = "") const {
    (object.empty() ? rule : rule[object])["spoon"] = 1;
    const std::string text = complaint(list, rule), head = "known are ";
    const std::size_t at = text.find(head);
    std::set<std::string> keys;
    std::string key;
    for (const char c : at == std::string::npos ? "" : text.substr(at + head.size()) + ",")
      if (c == ',') {
        keys.insert(key);
        key.clear();
      } else if (c != ' ' && c != '\'') {
        key += c;
      }
    return keys;
  }

  static std::set<std::string> keys_of(const Json& properties) {
    std::set<std::string> keys;
    for (const auto& [key, unused] : properties.items()) keys.insert(key);
    return keys;
  }

  static Json decal() {
    return {{"picture", "p.png"}, {"at", {1, 2, 3}},         {"direction", {0, 0, -1}},
            {"up", {0, 1, 0}},    {"size_mm", {40.0, 20.0}}, {"depth_mm", 5.0}};
  }

  const TemporaryFolder folder_{"papilla-object-texture-rules"};
  const std::filesystem::path path_ = folder_.path() / "materials.json";
};

TEST_F(ObjectTextureRulesTest, ReadsADecal) {
  Json json = decal();
  json.update({{"part", "dash*"}, {"not", {{"part", "dash_low"}}}, {"max_angle", 60}, {"offset_mm", 0.3}});
  json["height"] = {{"depth_mm", 0.5}, {"from", "dark"}};
  const DecalRule rule = read("decals", json).decals.at(0);
  EXPECT_EQ(rule.part, "dash*");
  EXPECT_EQ(rule.except.size(), 1U);
  EXPECT_EQ(rule.name, "p");
  EXPECT_EQ(rule.picture, folder_.path() / "p.png");
  EXPECT_EQ(rule.box.at, (Vec3{1, 2, 3}));
  EXPECT_EQ(rule.box.height_mm, 20);
  EXPECT_EQ(rule.max_angle_deg, 60);
  EXPECT_EQ(rule.offset_mm, 0.3);
  ASSERT_TRUE(rule.height);
  EXPECT_EQ(rule.height->source, ObjectRelief::Source::darkness);
}

TEST_F(ObjectTextureRulesTest, ReadsCarriers) {
  const CarrierRule part =
      read("replace", {{"part", "vent"}, {"picture", {{"render", true}, {"pixels", 256}}}, {"scale", {1.1, 1}}})
          .replace.at(0);
  EXPECT_TRUE(part.picture.empty());
  EXPECT_FALSE(part.box);
  EXPECT_EQ(part.pixels, 256);
  EXPECT_EQ(part.scale[0], 1.1);
  Json json = decal();
  json["cut_out"] = {{"color", "#ff0000"}, {"tolerance", 0.2}};
  const CarrierRule region = read("replace", json).replace.at(0);
  ASSERT_TRUE(region.box);
  EXPECT_EQ(region.cut_out.by, CutOut::By::color);
  EXPECT_NEAR(region.cut_out.color[0], 1, 1e-12);
}

TEST_F(ObjectTextureRulesTest, NamesThePlaceOfWhatIsWrong) {
  const auto with = [](const std::string& key, const Json& value) {
    Json json = decal();
    json[key] = value;
    return json;
  };
  EXPECT_NE(complaint("decals", with("up", {0, 0, 3})).find("/decals/0/up"), std::string::npos);
  EXPECT_NE(complaint("decals", with("direction", {0, 0, 0})).find("/decals/0/direction"), std::string::npos);
  EXPECT_NE(complaint("decals", with("size_mm", {1, 2, 3})).find("/decals/0/size_mm"), std::string::npos);
  EXPECT_NE(complaint("decals", with("size_mm", {1, -2})).find("/decals/0/size_mm/1"), std::string::npos);
  EXPECT_NE(complaint("decals", with("height", Json::object())).find("/decals/0/height"), std::string::npos);
  EXPECT_NE(complaint("decals", with("picture", 3)).find("/decals/0/picture"), std::string::npos);
  Json without = decal();
  without.erase("depth_mm");
  EXPECT_NE(complaint("decals", without).find("depth_mm"), std::string::npos);
  EXPECT_NE(complaint("replace", {{"picture", "p.png"}}).find("needs the surfaces"), std::string::npos);
  EXPECT_NE(complaint("replace", {{"picture", "p.png"}, {"part", "a"}, {"size_mm", {1, 1}}}).find("/size_mm"),
            std::string::npos);
  EXPECT_NE(
      complaint("replace", {{"picture", {{"render", true}}}, {"part", "a"}, {"crop", {0, 0, 1, 1}}}).find("/crop"),
      std::string::npos);
  EXPECT_NE(complaint("replace", {{"picture", "p"}, {"part", "a"}, {"crop", {0.5, 0, 0.5, 1}}}).find("/crop"),
            std::string::npos);
  EXPECT_NE(complaint("replace", with("scale", {2, 2})).find("/scale"), std::string::npos);
}

TEST_F(ObjectTextureRulesTest, HaveTheKeysOfTheSchema) {
  const Json schema = Json::parse(std::ifstream(PAPILLA_SCHEMAS "/materials.schema.json")).at("$defs");
  EXPECT_EQ(known("decals", decal()), keys_of(schema.at("decal").at("properties")));
  EXPECT_EQ(known("replace", decal()), keys_of(schema.at("carrier").at("properties")));
  Json relief = decal();
  relief["height"] = {{"depth_mm", 1}};
  EXPECT_EQ(known("decals", relief, "height"), keys_of(schema.at("shownRelief").at("properties")));
}

}  // namespace
}  // namespace papilla
