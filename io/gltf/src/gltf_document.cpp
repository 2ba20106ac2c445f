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

#include "draco_mesh.hpp"
#include "meshopt_view.hpp"
#include "missing_member.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/read_file.hpp"

namespace papilla::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are read in place");

constexpr std::string_view k_magic = "glTF";
constexpr std::uint32_t k_json_chunk = 0x4e4f534a;
constexpr int k_max_json_depth = 200;  ///< Parsing recurses: deeper text would exhaust the stack.

using Json = nlohmann::ordered_json;

/// The first line of a library's message, so that ours stays one line.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// A name from the file as messages quote it: its beginning, printable ASCII.
std::string printable(std::string_view name) {
  std::string text(name.substr(0, 80));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

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
  static constexpr std::array<std::string_view, 5> k_supported = {"KHR_mesh_quantization", "KHR_texture_transform",
                                                                  "KHR_lights_punctual", "KHR_xmp_json_ld",
                                                                  "EXT_mesh_gpu_instancing"};
  if (extension == "KHR_draco_mesh_compression") return has_draco();
  if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression") return has_meshopt();
  return extension.starts_with("KHR_materials_") ||
         std::find(k_supported.begin(), k_supported.end(), extension) != k_supported.end();
}

/// The number of primitives of each mesh; tinygltf leaves out those it can't parse.
std::vector<std::size_t> count_primitives(const Json& json) {
  std::vector<std::size_t> counts;
  if (const auto meshes = json.find("meshes"); meshes != json.end() && meshes->is_array())
    for (const auto& mesh : *meshes)
      counts.push_back(mesh.is_object() && mesh.contains("primitives") ? mesh["primitives"].size() : 0);
  return counts;
}

/// Checks what must be known before tinygltf may see the text.
Json parse_header(std::string_view text, const std::string& file) {
  check_depth(text, file);
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InvalidInput(file + ": is no glTF: the JSON is damaged at its byte " + std::to_string(error.byte));
  } catch (const Json::out_of_range&) {
    throw InvalidInput(file + ": the JSON holds a number beyond the range of 64-bit floats");
  }
  if (!json.is_object()) throw InvalidInput(file + ": is no glTF: the JSON is not an object");
  const auto asset = json.find("asset");
  if (asset == json.end() || !asset->is_object() || !asset->contains("version") || !(*asset)["version"].is_string())
    throw InvalidInput(file + ": is no glTF: asset.version is missing");
  const std::string version = (*asset)["version"].get<std::string>();
  if (!version.starts_with("2."))
    throw InvalidInput(file + ": glTF version '" + printable(version) + "' is not supported (2.x is)");
  const auto required = json.find("extensionsRequired");
  if (required == json.end()) return json;
  if (!required->is_array()) throw InvalidInput(file + ": extensionsRequired is not an array");
  std::string missing;
  for (const auto& extension : *required) {
    const std::string name = extension.is_string() ? extension.get<std::string>() : extension.dump();
    if (!is_supported(name)) missing += (missing.empty() ? "" : ", ") + printable(name);
  }
  if (!missing.empty()) throw InvalidInput(file + ": needs " + missing + ", which is not supported");
  return json;
}

/// glTF lets buffers have no data, for extensions that bring their own; tinygltf refuses them. Gives them a byte.
/// @returns the numbers of those buffers.
std::set<int> fill_empty_buffers(Json& json, bool binary) {
  std::set<int> filled;
  const auto buffers = json.find("buffers");
  if (buffers == json.end() || !buffers->is_array()) return filled;
  for (std::size_t i = binary ? 1 : 0; i < buffers->size(); ++i) {
    Json& buffer = (*buffers)[i];
    if (!buffer.is_object() || buffer.contains("uri")) continue;
    buffer = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
    filled.insert(static_cast<int>(i));
  }
  return filled;
}

/// Where a primitive's indices are.
struct Indices {
  std::size_t mesh, primitive;
  int accessor;
};

/// tinygltf refuses indices whose accessor has no bufferView, which compressed and sparse ones need not have. Takes
/// them away, to be put back into the model.
std::vector<Indices> detach_indices(Json& json) {
  std::vector<Indices> detached;
  const auto meshes = json.find("meshes"), accessors = json.find("accessors");
  if (meshes == json.end() || !meshes->is_array() || accessors == json.end() || !accessors->is_array()) return detached;
  for (std::size_t m = 0; m < meshes->size(); ++m) {
    Json& mesh = (*meshes)[m];
    if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
    for (std::size_t p = 0; p < mesh["primitives"].size(); ++p) {
      Json& primitive = mesh["primitives"][p];
      if (!primitive.is_object() || !primitive.contains("indices") || !primitive["indices"].is_number_unsigned())
        continue;
      const auto number = primitive["indices"].get<std::size_t>();
      if (number >= accessors->size() || !(*accessors)[number].is_object() ||
          (*accessors)[number].contains("bufferView"))
        continue;
      primitive.erase("indices");
      detached.push_back({m, p, static_cast<int>(number)});
    }
  }
  return detached;
}

/// tinygltf keeps what extensions say in 32 bits; counts and ranges of more must be refused before.
void check_meshopt_numbers(const Json& json, const std::string& file) {
  const auto views = json.find("bufferViews");
  if (views == json.end() || !views->is_array()) return;
  for (std::size_t i = 0; i < views->size(); ++i) {
    const Json& view = (*views)[i];
    if (!view.is_object() || !view.contains("extensions") || !view["extensions"].is_object()) continue;
    for (const auto& [extension, content] : view["extensions"].items()) {
      if (!extension.ends_with("_meshopt_compression") || !content.is_object()) continue;
      for (const auto& [name, number] : content.items())
        if (number.is_number_unsigned() && number.get<std::uint64_t>() > std::numeric_limits<std::int32_t>::max())
          throw InvalidInput(file + ": bufferViews[" + std::to_string(i) + "], meshopt: " + printable(name) + " " +
                             number.dump() + " is out of range");
    }
  }
}

/// The file with another JSON text.
std::string with_json(std::string_view bytes, bool binary, std::string json) {
  if (!binary) return json;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string_view rest = bytes.substr(std::min<std::size_t>(20 + std::size_t{word(bytes, 12)}, bytes.size()));
  std::string result(bytes.substr(0, 20));
  const auto put = [&](std::size_t at, std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::memcpy(result.data() + at, &number, sizeof number);
  };
  put(8, 20 + json.size() + rest.size());
  put(12, json.size());
  return result + json + std::string(rest);
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

/// Why tinygltf refused a file: the place where it can be found, else its own words, which name none.
std::string reason(const Json& json, const std::string& error) {
  const std::string missing = find_missing_member(json);
  if (!missing.empty()) return missing;
  return error.empty() ? "is no valid glTF" : first_line(error);
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
  std::string bytes = read_file(path);
  if (bytes.empty()) throw InvalidInput(document.file + ": is empty");
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(document.file + ": is larger than glTF's limit of 4 GiB");
  document.binary = std::string_view(bytes).starts_with(k_magic);
  Json json = parse_header(document.binary ? json_chunk(bytes, document.file) : std::string_view(bytes), document.file);
  check_meshopt_numbers(json, document.file);
  const auto primitives = count_primitives(json);
  document.empty_buffers = fill_empty_buffers(json, document.binary);
  const std::vector<Indices> detached = detach_indices(json);
  if (!document.empty_buffers.empty() || !detached.empty())
    bytes = with_json(bytes, document.binary, json.dump(-1, ' ', false, Json::error_handler_t::replace));

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
  if (!good) throw InvalidInput(document.file + ": " + reason(json, error));
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m)
    if (document.model.meshes[m].primitives.size() != primitives.at(m))
      throw InvalidInput(document.file + ": " + reason(json, "mesh " + std::to_string(m) + ": " + error));
  for (const Indices& indices : detached)
    document.model.meshes[indices.mesh].primitives[indices.primitive].indices = indices.accessor;
  add_warnings(error, document.warnings);
  add_warnings(warning, document.warnings);
  return document;
}

}  // namespace papilla::gltf
