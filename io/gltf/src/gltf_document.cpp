// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "papilla/core/error.hpp"
#include "papilla/io/read_file.hpp"

namespace papilla::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are read in place");

constexpr std::string_view k_magic = "glTF";
constexpr std::uint32_t k_json_chunk = 0x4e4f534a;
constexpr int k_max_json_depth = 200;  ///< Parsing recurses: deeper text would exhaust the stack.

/// The first line of a library's message, so that ours stays one line.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

/// The JSON chunk of a GLB.
std::string_view json_chunk(std::string_view bytes, const std::string& file) {
  if (bytes.size() < 20)
    throw InvalidInput(file + ": truncated GLB header (" + std::to_string(bytes.size()) + " bytes)");
  if (const auto version = word(bytes, 4); version != 2)
    throw InvalidInput(file + ": GLB version " + std::to_string(version) + " is not supported (2 is)");
  const std::size_t length = word(bytes, 8), json_length = word(bytes, 12);
  if (length > bytes.size())
    throw InvalidInput(file + ": truncated: the header promises " + std::to_string(length) + " bytes, the file has " +
                       std::to_string(bytes.size()));
  if (word(bytes, 16) != k_json_chunk) throw InvalidInput(file + ": the first GLB chunk is not JSON");
  if (json_length > length || 20 + json_length > length)
    throw InvalidInput(file + ": the JSON chunk of " + std::to_string(json_length) + " bytes exceeds the GLB");
  return bytes.substr(20, json_length);
}

void check_depth(std::string_view json, const std::string& file) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > k_max_json_depth)
        throw InvalidInput(file + ": JSON is nested deeper than " + std::to_string(k_max_json_depth) + " levels");
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

/// Extensions that a file may require: they are read, or only change how a material looks.
bool is_supported(const std::string& extension) {
  static constexpr std::array<std::string_view, 4> k_supported = {"KHR_mesh_quantization", "KHR_texture_transform",
                                                                  "KHR_lights_punctual", "KHR_xmp_json_ld"};
  return extension.starts_with("KHR_materials_") ||
         std::find(k_supported.begin(), k_supported.end(), extension) != k_supported.end();
}

/// The number of primitives of each mesh; tinygltf leaves out those it can't parse.
std::vector<std::size_t> count_primitives(const nlohmann::json& json) {
  std::vector<std::size_t> counts;
  if (const auto meshes = json.find("meshes"); meshes != json.end() && meshes->is_array())
    for (const auto& mesh : *meshes)
      counts.push_back(mesh.is_object() && mesh.contains("primitives") ? mesh["primitives"].size() : 0);
  return counts;
}

/// Checks what must be known before tinygltf may see the text. Returns the number of primitives of each mesh.
std::vector<std::size_t> check_header(std::string_view text, const std::string& file) {
  check_depth(text, file);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) throw InvalidInput(file + ": is no glTF: the JSON is damaged or not an object");
  const auto asset = json.find("asset");
  if (asset == json.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
    throw InvalidInput(file + ": is no glTF: asset.version is missing");
  const std::string version = (*asset)["version"].get<std::string>();
  if (!version.starts_with("2."))
    throw InvalidInput(file + ": glTF version '" + version + "' is not supported (2.x is)");
  const auto required = json.find("extensionsRequired");
  if (required == json.end()) return count_primitives(json);
  if (!required->is_array()) throw InvalidInput(file + ": extensionsRequired is not an array");
  std::string missing;
  for (const auto& extension : *required) {
    const std::string name = extension.is_string() ? extension.get<std::string>() : extension.dump();
    if (!is_supported(name)) missing += (missing.empty() ? "" : ", ") + name;
  }
  if (!missing.empty()) throw InvalidInput(file + ": needs " + missing + ", which is not supported");
  return count_primitives(json);
}

/// Keeps the encoded bytes. Those of a buffer view are left where they are: its range is not checked yet.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  image->as_is = true;
  if (image->bufferView == -1) image->image.assign(bytes, bytes + size);
  return true;
}

bool file_exists(const std::string& path, void*) {
  std::error_code error;  // A name that no file can have is a missing file.
  return std::filesystem::is_regular_file(path, error);
}

std::string same_path(const std::string& path, void*) { return path; }

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  try {
    const std::string bytes = read_file(path);
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw IoError(path + ": is larger than 2 GiB");
    out->assign(bytes.begin(), bytes.end());
    return true;
  } catch (const Error& failure) {
    *error = failure.what();
    return false;
  }
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

tinygltf::TinyGLTF make_loader() {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, nullptr);
  loader.SetFsCallbacks({file_exists, same_path, read_whole_file, write_nothing, nullptr});
  loader.SetStoreOriginalJSONForExtrasAndExtensions(true);
  return loader;
}

void add_warnings(std::string_view text, std::vector<std::string>& warnings) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) warnings.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace

Document load_document(const std::filesystem::path& path) {
  Document document;
  document.file = path.string();
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InvalidInput(document.file + ": is empty");
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(document.file + ": is larger than glTF's limit of 4 GiB");
  document.binary = std::string_view(bytes).starts_with(k_magic);
  const auto primitives =
      check_header(document.binary ? json_chunk(bytes, document.file) : std::string_view(bytes), document.file);

  tinygltf::TinyGLTF loader = make_loader();
  std::string error, warning;
  const auto size = static_cast<unsigned>(bytes.size());
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  bool good = false;
  try {
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    good = document.binary ? loader.LoadBinaryFromMemory(&document.model, &error, &warning, data, size, folder)
                           : loader.LoadASCIIFromString(&document.model, &error, &warning, bytes.data(), size, folder);
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (!good) throw InvalidInput(document.file + ": " + (error.empty() ? "is no valid glTF" : first_line(error)));
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m)
    if (document.model.meshes[m].primitives.size() != primitives.at(m))
      throw InvalidInput(document.file + ": mesh " + std::to_string(m) + ": " + first_line(error));
  add_warnings(error, document.warnings);
  add_warnings(warning, document.warnings);
  return document;
}

}  // namespace papilla::gltf
