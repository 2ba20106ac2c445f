// SPDX-License-Identifier: GPL-3.0-or-later
#include "saved_arguments.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "file_options.hpp"
#include "json_text.hpp"
#include "papilla/cache/digest.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

fs::path path_in(const fs::path& folder) { return folder / "bake.json"; }

std::string sum_of(const std::string& file) {
  const std::string bytes = read_file(file);
  return to_hex(sha256(bytes.data(), bytes.size()));
}

/// The options that BakeArguments has, by name.
std::vector<const CLI::Option*> options_of(const CLI::App& verb, BakeArguments& arguments, CLI::App& app) {
  arguments.add_to(app);
  std::vector<const CLI::Option*> result;
  for (const CLI::Option* option : verb.get_options())
    if (app.get_option_no_throw(option->get_name()) != nullptr) result.push_back(option);
  return result;
}

}  // namespace

void save_arguments(const CLI::App& verb, const fs::path& folder) {
  CLI::App app;
  BakeArguments arguments;
  Json values = Json::object(), sums = Json::object();
  for (const CLI::Option* option : options_of(verb, arguments, app)) {
    if (option->empty() || option->get_name() == "--help") continue;
    values[option->get_name()] = option->results();
    const auto known = file_options().find(option);
    if (known == file_options().end() || known->second.use != FileOption::Use::input) continue;
    for (const std::string& file : option->results())
      if (fs::is_regular_file(file)) sums[file] = sum_of(file);
  }
  write_atomically(path_in(folder), json_text(Json{{"arguments", values}, {"sha256", sums}}));
}

BakeArguments read_arguments(const fs::path& folder) {
  const fs::path path = path_in(folder);
  const std::string text = read_file(path);
  BakeArguments arguments;
  CLI::App app;
  arguments.add_to(app);
  try {
    const Json json = Json::parse(text);
    for (const auto& [file, sum] : json.at("sha256").items())
      if (sum_of(file) != sum.get<std::string>())
        throw InvalidInput(path.string() + ": " + file + " is another one since the split");
    std::vector<std::string> words, positionals;
    for (const auto& [name, values] : json.at("arguments").items()) {
      const bool is_positional = name.front() != '-';
      const CLI::Option* option = app.get_option_no_throw(name);
      if (option == nullptr) throw InvalidInput(path.string() + ": '" + name + "' is no option of a bake");
      const bool is_flag = option->get_expected_max() == 0;
      if (!is_positional) words.push_back(name);
      if (is_flag) continue;
      for (const Json& value : values) (is_positional ? positionals : words).push_back(value.get<std::string>());
    }
    words.emplace_back("--");
    words.insert(words.end(), positionals.begin(), positionals.end());
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    app.parse(words);
  } catch (const Json::exception& error) {
    throw InvalidInput(path.string() + ": is no file of papilla split: " + error.what());
  } catch (const CLI::ParseError& error) {
    throw InvalidInput(path.string() + ": " + error.what());
  }
  return arguments;
}

}  // namespace papilla::app
