// SPDX-License-Identifier: MIT
#include "papilla/pipeline/library_material.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla_test/json_schema.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

test::JsonSchema schema_of(const char* name) {
  return test::JsonSchema(Json::parse(read_file(fs::path(PAPILLA_SCHEMAS) / name)));
}

/// A file that has every key.
Json whole() {
  return Json::parse(R"({
    "version": 1, "$comment": "all keys",
    "names": {"en": "Test leather", "de": "Prüfleder"},
    "aliases": {"en": ["alias"], "de": []}, "categories": {"en": ["leather"], "de": ["Leder"]},
    "uses": {"en": [], "de": ["Sitz"]},
    "stiffness": {"value": 800, "estimated": true, "note": "a note"}, "damping": {"value": 0.5, "source": "a"},
    "staticFriction": {"value": 0.5, "source": "b"}, "dynamicFriction": {"value": 0.4, "estimated": true},
    "stribeckVelocity": {"value": 0.02, "estimated": true}, "youngsModulus": {"value": 2e6, "estimated": true},
    "backing": {"stiffness": {"value": 2000, "estimated": true}, "depth_mm": {"value": 2, "estimated": true}},
    "relief": {"grain": {"kind": "leather", "seed": 7}, "depth_mm": {"value": 0.2, "estimated": true},
               "size_mm": [{"value": 40, "estimated": true}, {"value": 30, "estimated": true}], "show": "relief"},
    "roughness": {"hurst": {"value": 0.6, "estimated": true}, "rms": {"value": 2e-6, "estimated": true},
                  "wavelength_range": [{"value": 1e-5, "estimated": true}, {"value": 1e-3, "estimated": true}]},
    "appearance": {"color": {"value": "#AABBCC", "estimated": true}, "roughness": {"value": 0.4, "estimated": true},
                   "metallic": {"value": 0, "estimated": true}},
    "sources": {"a": "Author, year, title", "b": "Another"}})");
}

class LibraryMaterialTest : public testing::Test {
 protected:
  LibraryMaterialTest() { fs::create_directories(folder_ / "leather"); }
  ~LibraryMaterialTest() override { fs::remove_all(folder_); }

  LibraryMaterial read(const Json& json) {
    std::ofstream(file_) << json.dump();
    return read_library_material(folder_, file_);
  }
  /// The message that reading ends with; empty when it does not fail.
  std::string complaint(const Json& json) {
    try {
      read(json);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  const fs::path folder_ = fs::temp_directory_path() / ("papilla-library-" + std::to_string(::getpid()));
  const fs::path file_ = folder_ / "leather" / "test.json";
};

TEST_F(LibraryMaterialTest, ReadsEveryKey) {
  const LibraryMaterial m = read(whole());
  EXPECT_EQ(m.id, "leather/test");
  EXPECT_EQ(m.name_de, "Prüfleder");
  EXPECT_EQ(m.uses.de, std::vector<std::string>{"Sitz"});
  EXPECT_EQ(m.stiffness.value, 800);
  EXPECT_TRUE(m.stiffness.is_estimated());
  EXPECT_EQ(m.stiffness.note, "a note");
  EXPECT_EQ(m.damping.source, "a");
  EXPECT_EQ(m.youngs_modulus.value().value, 2e6);
  EXPECT_EQ(m.backing.value().depth_mm.value, 2);
  ASSERT_TRUE(m.relief);
  EXPECT_EQ(m.relief->grain, GrainKind::leather);
  EXPECT_EQ(m.relief->seed, 7U);
  EXPECT_EQ(m.roughness.value().wavelength_range_m[1].value, 1e-3);
  EXPECT_EQ(m.appearance.color.value, "#aabbcc");
  EXPECT_EQ(m.sources.at("b"), "Another");
}

TEST_F(LibraryMaterialTest, ListsEveryNumberWithItsOrigin) {
  const std::vector<LibraryNumber> numbers = numbers_of(read(whole()));
  EXPECT_EQ(numbers.size(), 18U);
  const auto named = [&](const std::string& key) {
    return *std::find_if(numbers.begin(), numbers.end(), [&](const LibraryNumber& n) { return n.key == key; });
  };
  EXPECT_EQ(named("damping").source, "a");
  EXPECT_EQ(named("roughness/rms").value, "0.000002");
  EXPECT_EQ(named("relief/size_mm/1").value, "30");
  EXPECT_EQ(named("appearance/color").value, "#aabbcc");
  EXPECT_EQ(std::count_if(numbers.begin(), numbers.end(), [](const auto& n) { return !n.source.empty(); }), 2);
}

TEST_F(LibraryMaterialTest, TheRuleHasTheNumbersOfTheMaterial) {
  const MaterialRule rule = rule_of(read(whole()), "mine");
  EXPECT_EQ(rule.name, "mine");
  EXPECT_EQ(rule.recipe, "grain:leather");
  EXPECT_EQ(rule.size_mm[1], 30);
  EXPECT_EQ(rule.height.depth_mm, 0.2);
  EXPECT_EQ(rule.height.relief.height.seed, 7U);
  EXPECT_EQ(rule.stribeck_velocity, 0.02);
  EXPECT_EQ(rule.color, "#aabbcc");
  EXPECT_EQ(rule.show, "relief");
  Json smooth = whole();
  smooth.erase("relief");
  EXPECT_TRUE(rule_of(read(smooth), "smooth").texture.empty());
}

TEST_F(LibraryMaterialTest, EveryNumberNeedsASourceOrSaysThatItIsEstimated) {
  Json none = whole(), both = whole(), unknown = whole(), denied = whole(), unused = whole();
  none["stiffness"] = {{"value", 1}};
  both["stiffness"] = {{"value", 1}, {"estimated", true}, {"source", "a"}};
  unknown["stiffness"] = {{"value", 1}, {"source", "c"}};
  denied["stiffness"] = {{"value", 1}, {"estimated", false}};
  unused["sources"]["c"] = "Nobody";
  EXPECT_NE(complaint(none).find("at /stiffness: needs either \"source\" or \"estimated\": true"), std::string::npos);
  EXPECT_NE(complaint(both).find("at /stiffness: needs either"), std::string::npos);
  EXPECT_NE(complaint(unknown).find("at /stiffness/source: 'c' is none of the file's sources"), std::string::npos);
  EXPECT_NE(complaint(denied).find("at /stiffness/estimated: must be true"), std::string::npos);
  EXPECT_NE(complaint(unused).find("at /sources: no number names the source 'c'"), std::string::npos);
}

TEST_F(LibraryMaterialTest, NamesTheKeyThatIsWrong) {
  Json typo = whole(), slip = whole(), range = whole();
  typo["stifness"] = 1;
  slip["dynamicFriction"]["value"] = 0.6;
  range["roughness"]["wavelength_range"][0]["value"] = 1e-2;
  EXPECT_NE(complaint(typo).find("unknown key 'stifness'; did you mean 'stiffness'?"), std::string::npos);
  EXPECT_NE(complaint(slip).find("dynamicFriction must not exceed staticFriction"), std::string::npos);
  EXPECT_NE(complaint(range).find("at /roughness/wavelength_range: must be [shortest, longest]"), std::string::npos);
}

TEST_F(LibraryMaterialTest, APictureLiesBesideTheFile) {
  Json json = whole();
  json["relief"].erase("grain");
  json["relief"]["picture"] = "../outside.png";
  std::ofstream(folder_ / "outside.png") << "x";
  EXPECT_NE(complaint(json), "");
  json["relief"]["picture"] = "missing.png";
  EXPECT_NE(complaint(json).find("at /relief/picture: 'missing.png' does not exist"), std::string::npos);
  std::ofstream(folder_ / "leather" / "grain.png") << "x";
  json["relief"]["picture"] = "grain.png";
  json["relief"]["process"] = "three lights, camera above";
  const LibraryMaterial material = read(json);
  EXPECT_EQ(rule_of(material, "m").texture, fs::canonical(folder_ / "leather" / "grain.png"));
  EXPECT_EQ(material.relief->process, "three lights, camera above");
}

/// One change of a whole file.
struct Change {
  const char* what;
  std::function<void(Json&)> make;
};

TEST_F(LibraryMaterialTest, TheSchemaAndTheReaderAgree) {
  const test::JsonSchema schema = schema_of("library-material.schema.json");
  const auto set = [](const char* pointer, Json value) {
    return [=](Json& json) { json[Json::json_pointer(pointer)] = value; };
  };
  const auto drop = [](const char* object, const char* key) {
    return [=](Json& json) { json[Json::json_pointer(object)].erase(key); };
  };
  std::vector<Change> changes{
      {"none", [](Json&) {}},
      {"comment", set("/$comment", "x")},
      {"unknown key", set("/colour", 1)},
      {"version 2", set("/version", 2)},
      {"no version", drop("", "version")},
      {"empty name", set("/names/en", "")},
      {"no German name", drop("/names", "de")},
      {"third language", set("/names/fr", "cuir")},
      {"no aliases", drop("", "aliases")},
      {"aliases of one language", drop("/aliases", "de")},
      {"empty alias", set("/aliases/en/0", "")},
      {"no category", set("/categories/en", Json::array())},
      {"categories missing", drop("", "categories")},
      {"text for a number", set("/stiffness/value", "800")},
      {"bare number", set("/stiffness", 800)},
      {"no value", drop("/stiffness", "value")},
      {"note of a number", set("/stiffness/note", 1)},
      {"estimated false", set("/stiffness/estimated", false)},
      {"neither", drop("/stiffness", "estimated")},
      {"both", set("/stiffness/source", "a")},
      {"unknown member", set("/stiffness/unit", "N/m")},
      {"no backing", drop("", "backing")},
      {"backing without depth", drop("/backing", "depth_mm")},
      {"recipe beside grain", set("/relief/recipe", "leather")},
      {"no grain", drop("/relief", "grain")},
      {"unknown grain", set("/relief/grain/kind", "lether")},
      {"seed of a fraction", set("/relief/grain/seed", 1.5)},
      {"grain without seed", drop("/relief/grain", "seed")},
      {"process without picture", set("/relief/process", "x")},
      {"one size", set("/relief/size_mm", Json::array())},
      {"relief without depth", drop("/relief", "depth_mm")},
      {"show", set("/relief/show", "both")},
      {"shown", set("/relief/show", "picture")},
      {"roughness without rms", drop("/roughness", "rms")},
      {"colour word", set("/appearance/color/value", "red")},
      {"colour number", set("/appearance/color/value", 3)},
      {"no metallic", drop("/appearance", "metallic")},
      {"no appearance", drop("", "appearance")},
      {"empty citation", set("/sources/a", "")},
  };
  // Every range, at its ends and just beyond.
  const auto bounds = [&](const char* pointer, double low, double high) {
    for (const double value : {low, high, std::nextafter(low, -1e300), std::nextafter(high, 1e300)})
      changes.push_back({pointer, set(pointer, value)});
  };
  bounds("/stiffness/value", 1e-3, 1e6);
  bounds("/damping/value", 0, 1e4);
  bounds("/stribeckVelocity/value", 1e-6, 10);
  bounds("/youngsModulus/value", 1, 2e12);
  bounds("/backing/stiffness/value", 1e-3, 1e6);
  bounds("/backing/depth_mm/value", 0, 100);
  bounds("/relief/size_mm/0/value", 1e-3, 1e5);
  bounds("/relief/depth_mm/value", 1e-6, 100);
  bounds("/roughness/hurst/value", .01, .99);
  bounds("/roughness/rms/value", 0, 5e-3);
  bounds("/appearance/roughness/value", 0, 1);
  bounds("/appearance/metallic/value", 0, 1);
  int accepted = 0;
  for (const Change& change : changes) {
    Json json = whole();
    change.make(json);
    const std::string reason = complaint(json);
    EXPECT_EQ(schema.accepts(json), reason.empty()) << change.what << ": " << reason << "\n" << json.dump();
    accepted += reason.empty() ? 1 : 0;
  }
  EXPECT_EQ(accepted, 6 + 24);
}

TEST(LibraryMaterials, EveryFileOfTheLibraryFitsTheSchema) {
  const test::JsonSchema schema = schema_of("library-material.schema.json");
  const MaterialLibrary library(fs::path(PAPILLA_DATA) / "materials");
  for (const std::string& id : library.ids())
    EXPECT_TRUE(schema.accepts(Json::parse(read_file(library.folder() / (id + ".json"))))) << id;
}

TEST(LibraryMaterials, AnIdIsOfWordsAndSlashes) {
  for (const char* good : {"a", "leather/nappa-fine", "a1/b2/c-3"}) EXPECT_TRUE(is_library_id(good)) << good;
  for (const char* bad : {"", "/a", "a/", "a//b", "../a", "a/../b", "A", "a b", "-a", "a/-b", "a.json", "ä"})
    EXPECT_FALSE(is_library_id(bad)) << bad;
}

TEST(RenderedStiffness, IsHertzInSeriesWithTheWall) {
  // The stiffness of Hertz's contact is the derivative of F = 4/3 E* sqrt(R) d^1.5 where F is 1 N.
  for (const double modulus : {2e4, 3e6, 2.4e9}) {
    const double reduced = modulus / 0.91, root = std::sqrt(8e-3);
    const double depth = std::pow(3 / (4 * reduced * root), 2.0 / 3);
    const auto force = [&](double d) { return 4.0 / 3 * reduced * root * std::pow(d, 1.5); };
    const double step = 1e-5 * depth;
    const double hertz = (force(depth + step) - force(depth - step)) / (2 * step);
    EXPECT_NEAR(force(depth), 1, 1e-12);
    EXPECT_NEAR(rendered_stiffness(modulus), 2500 * hertz / (2500 + hertz), 1e-5 * 2500);
  }
  EXPECT_LT(rendered_stiffness(2e4), rendered_stiffness(3e4));
  EXPECT_LT(rendered_stiffness(2e11), 2500);
}

}  // namespace
}  // namespace papilla
