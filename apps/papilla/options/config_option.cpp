// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/config_option.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "file_options.hpp"
#include "json/json.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla::app {
namespace {

constexpr const char* k_config = "--config";

/// Where a value stands, for complaints.
struct Place {
  std::string file, pointer;

  Place within(const std::string& key) const { return {file, pointer + "/" + key}; }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidInput(shown(file) + ": " + (pointer.empty() ? "" : shown(pointer) + ": ") + reason);
  }
};

Json read_object(const std::string& file) {
  const std::string text = read_file(file);
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InvalidInput(shown(file) + ": byte " + std::to_string(error.byte) + " is no JSON");
  }
  if (!json.is_object()) Place{file, ""}.fail("must be an object of options");
  return json;
}

std::string with_hyphens(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

CLI::Option* option_named(CLI::App& verb, const std::string& key) {
  const std::string name = with_hyphens(key);
  CLI::Option* option = verb.get_option_no_throw("--" + name);
  return option != nullptr ? option : verb.get_option_no_throw(key);
}

/// The names that a file may have for the verb's options.
std::vector<std::string> known_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(name);
    if (option->get_positional()) names.push_back(option->get_name(true));
  }
  return names;
}

bool is_flag(const CLI::Option& option) { return option.get_expected_max() == 0; }

std::string text_of(const Json& value, const Place& place) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  place.fail("must be a text or a number");
}

/// A list is several values, or one with commas where the option takes one.
std::vector<std::string> texts_of(const CLI::Option& option, const Json& value, const Place& place) {
  if (!value.is_array()) return {text_of(value, place)};
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < value.size(); ++i) texts.push_back(text_of(value[i], place.within(std::to_string(i))));
  if (option.get_items_expected_max() > 1) return texts;
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : ",") + text;
  return {joined};
}

void set(CLI::Option& option, const Json& value, const Place& place) {
  if (value.is_null() || !option.empty()) return;
  if (is_flag(option)) {
    if (!value.is_boolean()) place.fail("must be true or false");
    if (value.get<bool>()) option.add_result("true");
    return;
  }
  option.add_result(texts_of(option, value, place));
}

bool is_verb(const CLI::App& verb, const std::string& name) {
  const auto verbs = verb.get_parent()->get_subcommands({});
  return std::any_of(verbs.begin(), verbs.end(), [&](const CLI::App* other) { return other->get_name() == name; });
}

void set_all(CLI::App& verb, const Json& object, const Place& place) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object() && is_verb(verb, key)) continue;
    CLI::Option* option = option_named(verb, key);
    if (option == nullptr) {
      const std::vector<std::string> names = known_names(verb);
      place.within(key).fail("'" + verb.get_name() + "' has no such option" +
                             did_you_mean(with_hyphens(key), {names.begin(), names.end()}));
    }
    if (option->get_name() == k_config) place.within(key).fail("a file of options can't name another one");
    set(*option, value, place.within(key));
  }
}

void read_config(CLI::App& verb, const std::string& file) {
  const Json json = read_object(file);
  const Place place{file, ""};
  if (const auto own = json.find(verb.get_name()); own != json.end() && own->is_object())
    set_all(verb, *own, place.within(verb.get_name()));
  set_all(verb, json, place);
}

}  // namespace

void add_config(CLI::App& verb) {
  reads(verb.add_option_function<std::string>(
            k_config, [&verb](const std::string& file) { read_config(verb, file); },
            "Options from a JSON object, by their long names; those given here go before it"))
      ->type_name("FILE.json")
      ->group("Common");
}

}  // namespace papilla::app
