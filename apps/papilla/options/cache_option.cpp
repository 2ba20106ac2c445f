// SPDX-License-Identifier: GPL-3.0-or-later
#include "cache_option.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "file_options.hpp"
#include "option_checks.hpp"
#include "papilla/core/error.hpp"
#include "shown_format.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr const char *k_none = "none", *k_folder_variable = "PAPILLA_CACHE", *k_limit_variable = "PAPILLA_CACHE_LIMIT";
constexpr std::uint64_t k_default_limit = std::uint64_t{10} << 30;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

/// The user's folder for caches (XDG base directory specification); empty when there is none.
fs::path default_folder() {
  const fs::path caches = variable("XDG_CACHE_HOME");
  if (caches.is_absolute()) return caches / "papilla";
  const fs::path home = variable("HOME");
  return home.is_absolute() ? home / ".cache" / "papilla" : fs::path();
}

/// @param source what names the folder in messages.
fs::path named_folder(const std::string& name, const char* source) {
  std::error_code error;
  if (fs::exists(name, error) && !fs::is_directory(name, error))
    throw InvalidInput(std::string(source) + ": '" + name + "' is no folder");
  return name;
}

}  // namespace

void CacheOption::add_to(CLI::App& verb) {
  verb.add_option("--cache", folder,
                  "Folder in which results are remembered from run to run, or none; default: PAPILLA_CACHE, or "
                  "papilla in the user's folder for caches")
      ->type_name("DIR|none")
      ->group("Common");
  verb.add_option("--cache-limit", most_bytes,
                  "What the cache may take, like 500M or 20G; what was not used for longest goes first; default: "
                  "PAPILLA_CACHE_LIMIT, or 10G")
      ->transform(CLI::AsSizeValue(false))
      ->check(positive())
      ->type_name("SIZE")
      ->group("Common");
}

std::unique_ptr<StageCache> CacheOption::open() const {
  const std::string set = variable(k_folder_variable);
  const fs::path chosen = !folder.empty() ? named_folder(folder, "--cache")
                          : !set.empty()  ? named_folder(set, k_folder_variable)
                                          : default_folder();
  if (chosen.empty() || chosen == k_none) return nullptr;
  return std::make_unique<StageCache>(ContentStore(chosen));
}

std::uint64_t CacheOption::limit() const {
  if (most_bytes > 0) return most_bytes;
  std::string set = variable(k_limit_variable);
  if (set.empty()) return k_default_limit;
  std::uint64_t bytes = 0;
  try {
    if (CLI::AsSizeValue(false)(set).empty()) bytes = std::strtoull(set.c_str(), nullptr, 10);
  } catch (const CLI::ValidationError&) {  // Of an unknown unit.
  }
  if (bytes == 0)
    throw InvalidInput(std::string(k_limit_variable) + ": '" + variable(k_limit_variable) + "' is no size");
  return bytes;
}

bool is_cache_named(const CLI::App& verb) { return verb.count("--cache") > 0 || !variable(k_folder_variable).empty(); }

Json cache_json(const StageCache& cache) {
  Json found = Json::object(), made = Json::object();
  std::uint64_t read = 0, written = 0;
  for (const auto& [stage, count] : cache.counts()) {
    found[stage] = count.found, made[stage] = count.made;
    read += count.bytes_read, written += count.bytes_written;
  }
  Json json = {{"folder", cache.store().folder().string()},
               {"found", found},
               {"made", made},
               {"bytes_read", read},
               {"bytes_written", written}};
  if (const std::string problem = cache.problem(); !problem.empty()) json["problem"] = problem;
  return json;
}

std::string cache_line(const StageCache& cache) {
  std::size_t found = 0, all = 0;
  for (const auto& [stage, count] : cache.counts()) found += count.found, all += count.found + count.made;
  std::string line;
  if (all > 0)
    line = shown_format("cache: {} of {} results found in {}\n", found, all, cache.store().folder().string());
  if (const std::string problem = cache.problem(); !problem.empty())
    line += shown_format("cache: nothing more was written: {}\n", problem);
  return line;
}

}  // namespace papilla::app
