// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The JSON Schema and the reader of MATERIALS.json against each other.
class MaterialsSchemaTest : public testing::Test {
 protected:
  MaterialsSchemaTest() {
    fs::create_directories(folder_);
    const Json definitions = Json::parse(std::ifstream(PAPILLA_SCHEMAS "/materials.schema.json")).at("$defs");
    schema_ = definitions.at("material").at("properties");
    unwrap_ = definitions.at("unwrap").at("properties");
  }
  ~MaterialsSchemaTest() override { fs::remove_all(folder_); }

  /// The message that reading a material ends with.
  std::string complaint(const Json& material) {
    const fs::path path = folder_ / "materials.json";
    std::ofstream(path) << Json{{"materials", {{"m", material}}}}.dump();
    try {
      read_materials(path);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
  /// The keys that the reader says are known in the object at `path`; empty: the material itself.
  std::set<std::string> known(const std::string& path) {
    Json material = Json::object();
    (path.empty() ? material : material[path])["spoon"] = 1;
    const std::string text = complaint(material), head = "known are ";
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
  void expect_values(const std::string& object, const std::string& key, const Json& rule) {
    const auto of = [&](const Json& value) {
      Json material = Json::object();
      (object.empty() ? material : material[object])[key] = value;
      return complaint(material);
    };
    const std::string where = object + "/" + key;
    if (rule.contains("enum")) {
      for (const Json& word : rule["enum"])
        EXPECT_TRUE(of(word).empty() || of(word).find("is no form of") != std::string::npos)
            << where << ": " << of(word);
      EXPECT_NE(of("spoon"), "") << where;
    } else if (rule.value("type", Json()) == "boolean") {
      EXPECT_EQ(of(true), "") << where;
      EXPECT_NE(of(1), "") << where;
    } else if (rule.value("type", Json()) == "number" || rule.value("type", Json()) == "integer") {
      const double least = rule.at("minimum"), most = rule.at("maximum");
      EXPECT_EQ(of(least), "") << where;
      EXPECT_EQ(of(most), "") << where;
      EXPECT_NE(of(least - 1), "") << where;
      EXPECT_NE(of(1.001 * most + 1), "") << where;
      EXPECT_NE(of("1"), "") << where;
      if (rule["type"] == "integer") {
        EXPECT_NE(of(least + 0.5), "") << where;
      }
    }
  }

  const fs::path folder_ = fs::temp_directory_path() / ("papilla-schema-" + std::to_string(::getpid()));
  Json schema_, unwrap_;
};

TEST_F(MaterialsSchemaTest, HasTheKeysOfTheReader) {
  EXPECT_EQ(known(""), keys_of(schema_));
  for (const char* object : {"forceModel", "frictionModel", "height", "backing", "fineRoughness"})
    EXPECT_EQ(known(object), keys_of(schema_.at(object).at("properties"))) << object;
  EXPECT_EQ(known("unwrap"), keys_of(unwrap_));
}

/// A method that an option of unwrap is of.
std::string method_of(const std::string& option) {
  const std::vector<UnwrapMethod>& methods = methods_of_option(option);
  return methods.empty() ? "lscm" : unwrap_method_name(methods.back());
}

TEST_F(MaterialsSchemaTest, HasTheUnwrapOptionsOfTheReader) {
  for (const Json& word : schema_.at("unwrap").at("anyOf").at(0).at("enum"))
    EXPECT_EQ(complaint({{"unwrap", word}}), "") << word;
  for (const auto& [key, rule] : unwrap_.items()) {
    if (!rule.contains("enum") || key == "solver") continue;
    for (const Json& word : rule["enum"]) {
      Json unwrap{{"method", method_of(key)}};
      unwrap[key] = word;
      EXPECT_EQ(complaint({{"unwrap", unwrap}}), "") << key << " " << word;
    }
    Json unwrap{{"method", method_of(key)}};
    unwrap[key] = "spoon";
    EXPECT_NE(complaint({{"unwrap", unwrap}}), "") << key;
  }
  for (const Json& solver : unwrap_.at("solver").at("enum")) {
    int known_by = 0;
    for (const auto& [name, unused] : unwrap_methods())
      known_by += complaint({{"unwrap", {{"method", name}, {"solver", solver}}}}).empty();
    EXPECT_EQ(known_by, 1) << solver;
  }
}

TEST_F(MaterialsSchemaTest, HasTheValuesOfTheReader) {
  for (const auto& [key, rule] : schema_.items()) expect_values("", key, rule);
  for (const char* object : {"forceModel", "frictionModel"})
    for (const auto& [key, rule] : schema_.at(object).at("properties").items()) expect_values(object, key, rule);
}

}  // namespace
}  // namespace papilla
