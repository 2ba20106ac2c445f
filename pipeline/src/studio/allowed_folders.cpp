// SPDX-License-Identifier: MIT
#include "papilla/pipeline/studio/allowed_folders.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "../json_value.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Json = JsonValue::Json;

bool is_below(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

/// Every text below a value: lights and references may be a name, or objects with names.
void add_texts(const Json& value, std::set<std::string>& paths) {
  if (value.is_string()) paths.insert(value.get<std::string>());
  if (value.is_structured())
    for (const Json& inner : value) add_texts(inner, paths);
}

/// The keys of a material, of its height and of decals and carriers that name files.
constexpr std::string_view k_keys[] = {"texture", "environment", "maps", "images", "lights", "reference", "picture"};
/// Objects with such keys.
constexpr std::string_view k_inner[] = {"height", "relief"};

void add_paths(const Json& object, std::set<std::string>& paths) {
  if (!object.is_object()) return;
  for (const auto& [key, value] : object.items()) {
    if (std::find(std::begin(k_keys), std::end(k_keys), key) != std::end(k_keys)) add_texts(value, paths);
    if (std::find(std::begin(k_inner), std::end(k_inner), key) != std::end(k_inner)) add_paths(value, paths);
  }
}

}  // namespace

AllowedFolders::AllowedFolders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    std::error_code error;
    const fs::path real = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    if (error || !fs::is_directory(real)) throw IoError(folder.string() + ": is no folder that can be read");
    if (std::find(folders_.begin(), folders_.end(), real) == folders_.end()) folders_.push_back(real);
  }
}

fs::path AllowedFolders::file(const fs::path& path, const fs::path& base) const {
  const auto refuse = [&](const char* reason) -> fs::path { throw InvalidInput("'" + path.string() + "': " + reason); };
  std::error_code error;
  if (path.empty() || path.native().find('\0') != std::string::npos) return refuse("is no path");
  fs::path real = fs::weakly_canonical(fs::absolute(base / path), error);
  if (error == std::errc::filename_too_long)  // No file has this name; a recipe may be as long.
    real = (fs::weakly_canonical(fs::absolute(base), error) / path).lexically_normal();
  if (error) return refuse("leads nowhere");
  if (std::none_of(folders_.begin(), folders_.end(), [&](const fs::path& folder) { return is_below(real, folder); }))
    return refuse("leads out of the folders that the studio was started with");
  const fs::file_status status = fs::status(real, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return refuse("is no regular file");
  return real;
}

std::set<std::string> paths_of_materials(const std::string& document, const std::string& name) {
  const Json json = parse_json(document, name);
  std::set<std::string> paths;
  if (!json.is_object()) return paths;
  for (const char* list : {"materials", "decals", "replace"}) {
    const auto found = json.find(list);
    if (found == json.end() || !found->is_structured()) continue;
    for (const Json& entry : *found) add_paths(entry, paths);
  }
  return paths;
}

}  // namespace papilla
