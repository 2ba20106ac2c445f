// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/pipeline/surface_selector.hpp"

namespace papilla {

/// A value of a settings file that knows its file and JSON pointer, so that every complaint names the place.
class JsonValue {
 public:
  using Json = nlohmann::ordered_json;

  /// @param json Must stay as long as the value.
  JsonValue(const Json& json, std::string file, std::string pointer)
      : json_(json), file_(std::move(file)), pointer_(std::move(pointer)) {}

  /// @throws InvalidInput, always.
  [[noreturn]] void fail(const std::string& reason) const;

  const Json& json() const { return json_; }
  JsonValue require(const char* key) const;
  std::optional<JsonValue> get(const std::string& key) const;
  JsonValue at(std::size_t index) const;

  /// The functions below fail where the value is not of that kind.
  void expect_object() const;
  void expect_keys(std::initializer_list<std::string_view> known) const;
  std::string text() const;
  bool yes_or_no() const;
  std::string one_of(const std::vector<std::string_view>& choices) const;
  double number(double low, double high) const;
  /// In lower case.
  std::string hex_colour() const;
  std::vector<JsonValue> list() const;
  std::vector<std::string> texts() const;

 private:
  const Json& json_;
  std::string file_, pointer_;
};

/// @throws IoError, InvalidInput naming the file and the byte that is no JSON.
JsonValue::Json read_json(const std::filesystem::path& path);

/// The same of a text. @param name stands for the file in messages. @throws InvalidInput as read_json().
JsonValue::Json parse_json(const std::string& text, const std::string& name);

/// Checks the keys of an object that selects surfaces and has `own` keys beside, and reads what it selects.
SurfaceSelector read_selector(const JsonValue& value, const std::vector<std::string_view>& own);

}  // namespace papilla
