// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "papilla/core/base64.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"
#include "papilla/io/gltf_edit.hpp"

namespace papilla::test {

/// A glTF file without any interpretation.
struct RawGltf {
  nlohmann::ordered_json json;
  std::vector<std::optional<std::string>> buffers;  ///< Nothing: without data.

  explicit RawGltf(const std::filesystem::path& file) {
    const std::string bytes = read_file(file);
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, 4);
      return std::size_t{value};
    };
    std::string text = bytes;
    std::optional<std::string> chunk;
    if (bytes.starts_with("glTF")) {
      text = bytes.substr(20, word(12));
      if (28 + word(12) <= bytes.size()) chunk = bytes.substr(28 + word(12), word(20 + word(12)));
    }
    json = nlohmann::ordered_json::parse(text);
    for (std::size_t i = 0; json.contains("buffers") && i < json["buffers"].size(); ++i) {
      const auto& buffer = json["buffers"][i];
      if (!buffer.contains("uri"))
        buffers.push_back(i == 0 ? chunk : std::nullopt);
      else if (const std::string uri = buffer["uri"]; uri.starts_with("data:"))
        buffers.push_back(decode_data_uri(uri));
      else
        buffers.push_back(read_file(file.parent_path() / percent_decoded(uri)));
    }
  }

  /// The bytes of a bufferView, and the compressed ones that an extension names; empty where there is no data.
  std::string view(std::size_t number) const {
    const auto& view = json["bufferViews"][number];
    std::string bytes = range(view);
    if (view.contains("extensions"))
      for (const auto& [name, extension] : view["extensions"].items())
        if (extension.contains("buffer")) bytes += range(extension);
    return bytes;
  }

 private:
  std::string range(const nlohmann::ordered_json& view) const {
    const auto& buffer = buffers.at(view.at("buffer").get<std::size_t>());
    return buffer ? buffer->substr(view.value("byteOffset", std::size_t{0}), view.at("byteLength")) : "";
  }
};

/// What differs between two files beside the listed changes, in members or in the bytes of the first one's
/// bufferViews, a line each: the changes are undone in both documents, which must then be the same text.
inline std::vector<std::string> unlisted_differences(const std::filesystem::path& before_file,
                                                     const std::filesystem::path& after_file,
                                                     const std::vector<GltfChange>& listed) {
  using Json = nlohmann::ordered_json;
  RawGltf before(before_file), after(after_file);
  std::vector<std::string> differences;
  for (std::size_t i = 0; before.json.contains("bufferViews") && i < before.json["bufferViews"].size(); ++i)
    if (before.view(i) != after.view(i)) differences.push_back("bytes of bufferView " + std::to_string(i));
  const auto erase = [&](Json& document, const std::string& pointer) {
    const Json::json_pointer path(pointer);
    if (!document.contains(path)) {
      differences.push_back(pointer + " is listed and does not exist");
      return;
    }
    Json& parent = document[path.parent_pointer()];
    if (parent.is_array())
      parent.erase(std::stoul(path.back()));
    else
      parent.erase(path.back());
  };
  std::for_each(listed.rbegin(), listed.rend(), [&](const GltfChange& change) {
    if (change.kind != "added") erase(before.json, change.pointer);
    if (change.kind != "removed") erase(after.json, change.pointer);
  });
  if (before.json.dump() != after.json.dump())
    for (const auto& difference : Json::diff(before.json, after.json))
      differences.push_back(difference.at("op").get<std::string>() + " " + difference.at("path").get<std::string>());
  if (differences.empty() && before.json.dump() != after.json.dump()) differences.emplace_back("the order of members");
  return differences;
}

}  // namespace papilla::test
