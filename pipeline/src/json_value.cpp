// SPDX-License-Identifier: MIT
#include "json_value.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/plain_number.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla {
namespace {

std::string joined(const std::vector<std::string_view>& words) {
  std::string list;
  for (const auto word : words) list += (list.empty() ? "" : ", ") + std::string(word);
  return list;
}

void check_keys(const JsonValue& value, const std::vector<std::string_view>& known) {
  value.expect_object();
  for (const auto& [key, unused] : value.json().items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      value.fail("unknown key '" + key + "'" + did_you_mean(key, known) + "; known are " + joined(known));
}

}  // namespace

void JsonValue::fail(const std::string& reason) const {
  // Keys may hold anything, a message is one line.
  throw InvalidInput(shown(file_ + ": at " + (pointer_.empty() ? "the top level" : pointer_) + ": " + reason));
}

JsonValue JsonValue::require(const char* key) const {
  const auto member = get(key);
  if (!member) fail(std::string("'") + key + "' is missing");
  return *member;
}

std::optional<JsonValue> JsonValue::get(const std::string& key) const {
  expect_object();
  const auto it = json_.find(key);
  if (it == json_.end()) return std::nullopt;
  return JsonValue(*it, file_, (Json::json_pointer(pointer_) / key).to_string());
}

JsonValue JsonValue::at(std::size_t index) const {
  return {json_.at(index), file_, pointer_ + "/" + std::to_string(index)};
}

void JsonValue::expect_object() const {
  if (!json_.is_object()) fail("must be an object");
}

void JsonValue::expect_keys(std::initializer_list<std::string_view> known) const { check_keys(*this, known); }

std::string JsonValue::text() const {
  if (!json_.is_string()) fail("must be a string");
  return json_.get<std::string>();
}

bool JsonValue::yes_or_no() const {
  if (!json_.is_boolean()) fail("must be true or false");
  return json_.get<bool>();
}

std::string JsonValue::one_of(const std::vector<std::string_view>& choices) const {
  const std::string value = text();
  if (std::find(choices.begin(), choices.end(), value) != choices.end()) return value;
  fail("'" + value + "' must be one of " + joined(choices) + did_you_mean(value, choices));
}

double JsonValue::number(double low, double high) const {
  if (!json_.is_number()) fail("must be a number");
  const double value = json_.get<double>();
  if (!(value >= low && value <= high))
    fail(plain_number(value) + " must be from " + plain_number(low) + " to " + plain_number(high));
  return value;
}

std::string JsonValue::hex_colour() const {
  std::string value = text();
  const bool good = value.size() == 7 && value[0] == '#' &&
                    std::all_of(value.begin() + 1, value.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (!good) fail("'" + value + "' must be a colour such as #20a0FF");
  std::transform(value.begin(), value.end(), value.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return value;
}

std::vector<JsonValue> JsonValue::list() const {
  if (!json_.is_array()) fail("must be an array");
  std::vector<JsonValue> values;
  for (std::size_t i = 0; i < json_.size(); ++i) values.push_back(at(i));
  return values;
}

std::vector<std::string> JsonValue::texts() const {
  std::vector<std::string> texts;
  for (const JsonValue& value : list()) texts.push_back(value.text());
  return texts;
}

JsonValue::Json read_json(const std::filesystem::path& path) { return parse_json(read_file(path), path.string()); }

JsonValue::Json parse_json(const std::string& text, const std::string& name) {
  constexpr int k_most_levels = 64;  // Objects are copied as they grow: deep ones cost the square of their depth.
  const auto check_depth = [&](int depth, JsonValue::Json::parse_event_t, JsonValue::Json&) {
    if (depth > k_most_levels)
      throw InvalidInput(name + ": is nested deeper than " + std::to_string(k_most_levels) + " levels");
    return true;
  };
  try {
    return JsonValue::Json::parse(text, check_depth);
  } catch (const JsonValue::Json::parse_error& parse_error) {
    throw InvalidInput(name + ": byte " + std::to_string(parse_error.byte) + ": is no valid JSON");
  } catch (const JsonValue::Json::out_of_range&) {
    throw InvalidInput(name + ": holds a number beyond the range of 64-bit floats");
  }
}

SurfaceSelector read_selector(const JsonValue& value, const std::vector<std::string_view>& own) {
  std::vector<std::string_view> known;
  for (const SelectorKey& key : selector_keys()) known.push_back(key.name);
  known.insert(known.end(), own.begin(), own.end());
  check_keys(value, known);
  SurfaceSelector selector;
  for (const SelectorKey& key : selector_keys())
    if (const auto v = value.get(std::string(key.name)))
      selector.*key.pattern = key.kind == SelectorKey::Kind::colour ? v->hex_colour() : v->text();
  const auto add_exception = [&](const JsonValue& exception) {
    selector.except.push_back(read_selector(exception, {}));
    if (selector.except.back().is_empty()) exception.fail("selects nothing");
  };
  if (std::find(own.begin(), own.end(), "not") == own.end()) return selector;
  if (const auto v = value.get("not")) {
    if (!v->json().is_array())
      add_exception(*v);
    else
      for (const JsonValue& exception : v->list()) add_exception(exception);
  }
  return selector;
}

}  // namespace papilla
