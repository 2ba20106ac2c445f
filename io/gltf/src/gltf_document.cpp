// SPDX-License-Identifier: MIT
#include "gltf_document.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "draco_mesh.hpp"
#include "json_text.hpp"
#include "meshopt_view.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"

namespace papilla::gltf {
namespace {

enum class Kind { index, whole, number, text, array, object, component_type, accessor_type, camera_type, stride };

/// A member that tinygltf requires. "[]" follows the name of an array all of whose elements need it; members on the
/// path may be missing.
struct Required {
  std::string_view path;
  Kind kind;
  bool may_be_missing = false;
};

constexpr std::array k_required = {
    Required{"buffers[].byteLength", Kind::index},
    Required{"bufferViews[].buffer", Kind::index},
    Required{"bufferViews[].byteLength", Kind::index},
    Required{"bufferViews[].byteStride", Kind::stride, true},
    Required{"accessors[].componentType", Kind::component_type},
    Required{"accessors[].count", Kind::index},
    Required{"accessors[].type", Kind::accessor_type},
    Required{"accessors[].sparse.count", Kind::index},
    Required{"accessors[].sparse.indices", Kind::object},
    Required{"accessors[].sparse.indices.bufferView", Kind::index},
    Required{"accessors[].sparse.indices.componentType", Kind::index},
    Required{"accessors[].sparse.values", Kind::object},
    Required{"accessors[].sparse.values.bufferView", Kind::index},
    Required{"meshes[].primitives[].attributes", Kind::object},
    Required{"textures[]", Kind::object},
    Required{"images[]", Kind::object},
    Required{"materials[]", Kind::object},
    Required{"nodes[]", Kind::object},
    Required{"scenes[]", Kind::object},
    Required{"samplers[]", Kind::object},
    Required{"skins[].joints", Kind::array},
    Required{"animations[].samplers[].input", Kind::index},
    Required{"animations[].samplers[].output", Kind::index},
    Required{"cameras[].type", Kind::camera_type},
    Required{"extensions.KHR_lights_punctual.lights[].type", Kind::text},
    Required{"cameras[].perspective.yfov", Kind::number},
    Required{"cameras[].perspective.znear", Kind::number},
    Required{"cameras[].orthographic.xmag", Kind::number},
    Required{"cameras[].orthographic.ymag", Kind::number},
    Required{"cameras[].orthographic.zfar", Kind::number},
    Required{"cameras[].orthographic.znear", Kind::number},
};

/// Members that tinygltf skips in silence when they are written as fractions, but that the file's text is edited by.
constexpr std::array k_whole = {
    Required{"scene", Kind::whole, true},
    Required{"scenes[].nodes[]", Kind::whole, true},
    Required{"nodes[].mesh", Kind::whole, true},
    Required{"nodes[].children[]", Kind::whole, true},
    Required{"meshes[].primitives[].indices", Kind::whole, true},
    Required{"meshes[].primitives[].material", Kind::whole, true},
    Required{"meshes[].primitives[].mode", Kind::whole, true},
    Required{"textures[].source", Kind::whole, true},
    Required{"textures[].sampler", Kind::whole, true},
    Required{"images[].bufferView", Kind::whole, true},
    Required{"accessors[].bufferView", Kind::whole, true},
    Required{"accessors[].byteOffset", Kind::whole, true},
    Required{"bufferViews[].byteOffset", Kind::whole, true},
    Required{"materials[].normalTexture.index", Kind::whole, true},
    Required{"materials[].occlusionTexture.index", Kind::whole, true},
    Required{"materials[].emissiveTexture.index", Kind::whole, true},
    Required{"materials[].pbrMetallicRoughness.baseColorTexture.index", Kind::whole, true},
    Required{"materials[].pbrMetallicRoughness.metallicRoughnessTexture.index", Kind::whole, true},
};

bool is_index(const Json& value) { return value.is_number_integer() && value.get<std::int64_t>() >= 0; }

bool is_one_of(const Json& value, std::initializer_list<Json> allowed) {
  return std::find(allowed.begin(), allowed.end(), value) != allowed.end();
}

/// Whether a member is of the kind, and the complaint when it is not.
std::pair<bool, std::string_view> is_of(const Json& value, Kind kind) {
  switch (kind) {
    case Kind::index: return {is_index(value), "is no whole number"};
    case Kind::whole: return {value.is_number_integer(), "is no whole number"};
    case Kind::number: return {value.is_number(), "is no number"};
    case Kind::text: return {value.is_string(), "is no string"};
    case Kind::array: return {value.is_array(), "is no array"};
    case Kind::object: return {value.is_object(), "is no object"};
    case Kind::component_type:
      return {is_one_of(value, {5120, 5121, 5122, 5123, 5124, 5125, 5126, 5130}), "is no component type"};
    case Kind::accessor_type:
      return {is_one_of(value, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}), "is no accessor type"};
    case Kind::camera_type: return {is_one_of(value, {"perspective", "orthographic"}), "is no camera type"};
    case Kind::stride:
      return {is_index(value) && value.get<std::int64_t>() % 4 == 0 && value.get<std::int64_t>() <= 252,
              "is no multiple of 4 up to 252"};
  }
  return {true, ""};
}

/// @param path What is left of the way below `value`, which stands at `place`. @returns a message, or nothing.
std::string find_in(const Json& value, std::string_view path, const Required& required, const std::string& place) {
  if (path.empty()) {
    const auto [good, complaint] = is_of(value, required.kind);
    return good ? "" : place + " " + std::string(complaint);
  }
  if (path.starts_with("[]")) {
    if (!value.is_array()) return place + " is no array";
    path.remove_prefix(path.starts_with("[].") ? 3 : 2);
    for (std::size_t i = 0; i < value.size(); ++i)
      if (std::string found = find_in(value[i], path, required, place + "[" + std::to_string(i) + "]"); !found.empty())
        return found;
    return "";
  }
  if (!value.is_object()) return place + " is no object";
  const std::size_t end = std::min(path.find_first_of(".["), path.size());
  const std::string name(path.substr(0, end));
  path.remove_prefix(end + (end < path.size() && path[end] == '.' ? 1 : 0));
  const std::string member = place.empty() ? name : place + "." + name;
  if (const auto found = value.find(name); found != value.end()) return find_in(*found, path, required, member);
  return path.empty() && !required.may_be_missing ? member + " is missing" : "";
}

/// A camera has the member that its type names.
std::string find_camera_without_lens(const Json& document) {
  const auto cameras = document.find("cameras");
  if (cameras == document.end()) return "";
  for (std::size_t i = 0; i < cameras->size(); ++i) {
    const auto& camera = (*cameras)[i];
    const std::string place = "cameras[" + std::to_string(i) + "]", lens = camera.at("type").get<std::string>();
    if (std::string found = find_in(camera, lens, {"", Kind::object}, place); !found.empty()) return found;
  }
  return "";
}

/// The first member that is missing or of another kind, for messages: "accessors[3].componentType is missing". Empty
/// when there is none.
std::string find_bad_member(const Json& document, std::span<const Required> members) {
  for (const Required& required : members)
    if (std::string found = find_in(document, required.path, required, ""); !found.empty()) return found;
  return "";
}

/// The same of those that tinygltf requires.
std::string find_missing_member(const Json& document) {
  const std::string found = find_bad_member(document, k_required);
  return found.empty() ? find_camera_without_lens(document) : found;
}

static_assert(std::endian::native == std::endian::little, "glTF buffers are read in place");

constexpr std::string_view k_magic = "glTF";
constexpr std::uint32_t k_json_chunk = 0x4e4f534a, k_binary_chunk = 0x004e4942;
constexpr std::size_t k_quoted = 80;   ///< Characters of a name from the file in messages.
constexpr int k_max_json_depth = 200;  ///< Parsing recurses: deeper text would exhaust the stack.

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

/// Extensions that a file may require: they are read, or known to leave the geometry as it is.
bool is_supported(const std::string& extension) {
  static constexpr std::array<std::string_view, 5> k_supported = {
      "KHR_mesh_quantization", "KHR_lights_punctual", "KHR_xmp_json_ld", "EXT_mesh_gpu_instancing", "MSFT_texture_dds"};
  if (extension == "KHR_draco_mesh_compression") return has_draco();
  if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression") return has_meshopt();
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_texture_") ||
         extension.starts_with("EXT_texture_") ||
         std::find(k_supported.begin(), k_supported.end(), extension) != k_supported.end();
}

/// Whether "extensions" anywhere below `json` has the member.
bool uses_extension(const Json& json, const std::string& extension) {
  if (json.is_array())
    return std::any_of(json.begin(), json.end(), [&](const Json& child) { return uses_extension(child, extension); });
  if (!json.is_object()) return false;
  for (const auto& [key, value] : json.items()) {
    if (key == "extras") continue;
    if (key == "extensions" && value.is_object() && value.contains(extension)) return true;
    if (uses_extension(value, extension)) return true;
  }
  return false;
}

/// Whether an unknown extension may change the geometry: it stands there, or nowhere, as KHR_mesh_quantization does.
bool may_touch_geometry(const Json& json, const std::string& extension) {
  static constexpr std::array<std::string_view, 8> k_others = {"materials", "textures",   "images", "samplers",
                                                               "cameras",   "animations", "asset",  "extensions"};
  bool elsewhere = false;
  for (const auto& [key, value] : json.items()) {
    const bool stands_here = key == "extensions" ? value.is_object() && value.contains(extension)
                                                 : value.is_structured() && uses_extension(value, extension);
    if (!stands_here) continue;
    if (std::find(k_others.begin(), k_others.end(), key) == k_others.end()) return true;
    elsewhere = true;
  }
  return !elsewhere;
}

/// The number of primitives of each mesh; tinygltf leaves out those it can't parse.
std::vector<std::size_t> count_primitives(const Json& json) {
  std::vector<std::size_t> counts;
  if (const auto meshes = json.find("meshes"); meshes != json.end() && meshes->is_array())
    for (const auto& mesh : *meshes)
      counts.push_back(mesh.is_object() && mesh.contains("primitives") ? mesh["primitives"].size() : 0);
  return counts;
}

/// Required extensions that are unknown and leave the geometry alone become warnings.
/// @throws InvalidInput naming the others.
void check_required(const Json& json, const std::string& file, std::vector<std::string>& warnings) {
  const auto required = json.find("extensionsRequired");
  if (required == json.end()) return;
  if (!required->is_array()) throw InvalidInput(file + ": extensionsRequired is not an array");
  std::string missing;
  for (const auto& extension : *required) {
    const std::string name = extension.is_string() ? extension.get<std::string>() : extension.dump();
    if (is_supported(name)) continue;
    if (may_touch_geometry(json, name))
      missing += (missing.empty() ? "" : ", ") + printable(name, k_quoted);
    else
      warnings.push_back("needs " + printable(name, k_quoted) + ", which is not read and leaves the geometry alone");
  }
  if (!missing.empty()) throw InvalidInput(file + ": needs " + missing + ", which is not supported");
}

/// Parses the text and checks everything that tinygltf does not.
Json parse_header(std::string_view text, const std::string& file, std::vector<std::string>& warnings) {
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
    throw InvalidInput(file + ": glTF version '" + printable(version, k_quoted) + "' is not supported (2.x is)");
  check_required(json, file, warnings);
  return json;
}

constexpr const char* k_one_byte = "data:application/octet-stream;base64,AA==";

/// A file that a buffer or an image names.
struct ReferencedFile {
  std::size_t number;  ///< Of the buffer or image.
  std::string uri, bytes;
};

/// The entries of "buffers" or "images" that name files.
std::vector<std::size_t> entries_with_file(const Json& json, const char* list) {
  std::vector<std::size_t> numbers;
  if (const auto entries = json.find(list); entries != json.end() && entries->is_array())
    for (std::size_t i = 0; i < entries->size(); ++i)
      if (const Json& entry = (*entries)[i]; entry.is_object() && entry.contains("uri") && entry["uri"].is_string() &&
                                             !entry["uri"].get_ref<const std::string&>().starts_with("data:"))
        numbers.push_back(i);
  return numbers;
}

Reference reference_of(const std::string& uri, const char* list, std::size_t number,
                       const std::filesystem::path& path) {
  return {path.parent_path(), path.string() + ": at /" + list + "/" + std::to_string(number) + "/uri",
          percent_decoded(uri)};
}

/// Reads the files that buffers name and gives the buffers a byte in the text instead.
/// @throws InvalidInput, IoError as read_reference(); InvalidInput for a file that is missing or too short.
std::vector<ReferencedFile> detach_buffers(Json& json, const std::filesystem::path& path) {
  std::vector<ReferencedFile> files;
  for (const std::size_t i : entries_with_file(json, "buffers")) {
    Json& buffer = json["buffers"][i];
    const std::string uri = std::exchange(buffer["uri"], k_one_byte).get<std::string>();
    if (!buffer.contains("byteLength") || !is_index(buffer["byteLength"])) continue;  // tinygltf refuses it.
    const auto length = std::exchange(buffer["byteLength"], 1).get<std::uint64_t>();
    const Reference reference = reference_of(uri, "buffers", i, path);
    auto bytes = read_reference(reference, ReferenceContent::any);
    const std::string file = reference.place + ": '" + shown(reference.value) + "' ";
    if (!bytes) throw InvalidInput(file + "does not exist");
    if (bytes->size() < length)
      throw InvalidInput(file + "has " + std::to_string(bytes->size()) + " bytes, byteLength is " +
                         std::to_string(length));
    bytes->resize(static_cast<std::size_t>(length));
    files.push_back({i, uri, *std::move(bytes)});
  }
  return files;
}

/// The same for images, of which files may be missing.
std::vector<ReferencedFile> detach_images(Json& json, const std::filesystem::path& path) {
  std::vector<ReferencedFile> files;
  for (const std::size_t i : entries_with_file(json, "images")) {
    const std::string uri = std::exchange(json["images"][i]["uri"], k_one_byte).get<std::string>();
    auto bytes = read_reference(reference_of(uri, "images", i, path), ReferenceContent::picture);
    files.push_back({i, uri, std::move(bytes).value_or("")});
  }
  return files;
}

/// glTF lets buffers have no data, for extensions that bring their own; tinygltf refuses them. Gives them a byte.
/// @returns the numbers of those buffers.
/// @param has_chunk  of binary data, which is the first buffer's.
std::set<int> fill_empty_buffers(Json& json, bool has_chunk) {
  std::set<int> filled;
  const auto buffers = json.find("buffers");
  if (buffers == json.end() || !buffers->is_array()) return filled;
  for (std::size_t i = has_chunk ? 1 : 0; i < buffers->size(); ++i) {
    Json& buffer = (*buffers)[i];
    if (!buffer.is_object() || buffer.contains("uri")) continue;
    buffer = {{"byteLength", 1}, {"uri", k_one_byte}};
    filled.insert(static_cast<int>(i));
  }
  return filled;
}

/// tinygltf refuses data: URIs of pictures in types that it does not know. Leaves the type to the picture's first
/// bytes.
/// @returns whether there was any.
bool rename_picture_types(Json& json) {
  static constexpr std::array<std::string_view, 4> k_known = {"data:image/png;", "data:image/jpeg;", "data:image/bmp;",
                                                              "data:application/octet-stream;"};
  static constexpr std::string_view k_base64 = ";base64,";
  const auto images = json.find("images");
  if (images == json.end() || !images->is_array()) return false;
  bool renamed = false;
  for (Json& image : *images) {
    if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string()) continue;
    const auto& uri = image["uri"].get_ref<const std::string&>();
    const bool known = std::any_of(k_known.begin(), k_known.end(), [&](auto type) { return uri.starts_with(type); });
    const std::size_t data = std::string_view(uri).substr(0, k_quoted).find(k_base64);
    if (known || !uri.starts_with("data:") || data == std::string::npos) continue;
    image["uri"] = "data:application/octet-stream;base64," + uri.substr(data + k_base64.size());
    renamed = true;
  }
  return renamed;
}

/// tinygltf complains about channels that name no node, as those of KHR_animation_pointer. Takes them out of the text:
/// animations are only counted.
/// @returns whether there was any.
bool drop_channels_without_node(Json& json) {
  const auto animations = json.find("animations");
  if (animations == json.end() || !animations->is_array()) return false;
  const auto has_no_node = [](const Json& channel) {
    const auto target = channel.is_object() ? channel.find("target") : channel.end();
    return target != channel.end() && target->is_object() && !target->contains("node");
  };
  bool dropped = false;
  for (Json& animation : *animations) {
    if (!animation.is_object() || !animation.contains("channels") || !animation["channels"].is_array()) continue;
    Json kept = Json::array();
    for (Json& channel : animation["channels"])
      if (!has_no_node(channel)) kept.push_back(std::move(channel));
    dropped = dropped || kept.size() != animation["channels"].size();
    animation["channels"] = std::move(kept);
  }
  return dropped;
}

/// Where a primitive's indices are.
struct Indices {
  std::size_t mesh, primitive;
  int accessor;
};

/// tinygltf refuses indices whose accessor has no bufferView, which compressed and sparse ones need not have. Removes
/// them from the text, so that they can be restored in the model.
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

/// tinygltf stores the numbers of extensions in 32 bits: refuses larger counts and ranges before.
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
          throw InvalidInput(file + ": bufferViews[" + std::to_string(i) + "], meshopt: " + printable(name, k_quoted) +
                             " " + number.dump() + " is out of range");
    }
  }
}

/// The binary chunk of a GLB; nothing when it has none.
/// @throws InvalidInput when it is damaged.
std::optional<std::string_view> binary_chunk(std::string_view bytes, const std::string& file) {
  constexpr std::size_t k_header = 8;
  bytes = bytes.substr(0, word(bytes, 8));
  bytes.remove_prefix(20 + std::size_t{word(bytes, 12)});
  if (bytes.empty()) return std::nullopt;
  if (bytes.size() < k_header || word(bytes, 0) > bytes.size() - k_header)
    throw InvalidInput(file + ": the binary chunk exceeds the GLB");
  if (word(bytes, 4) != k_binary_chunk) throw InvalidInput(file + ": the second GLB chunk is not binary data");
  return bytes.substr(k_header, word(bytes, 0));
}

/// Gives the first buffer, whose content is the binary chunk, a byte in the text instead.
/// @returns its length; nothing when another place holds it, or tinygltf will refuse it.
/// @throws InvalidInput when the chunk is shorter.
std::optional<std::size_t> detach_chunk(Json& json, std::size_t chunk_size, const std::string& file) {
  const auto buffers = json.find("buffers");
  if (buffers == json.end() || !buffers->is_array() || buffers->empty()) return std::nullopt;
  Json& buffer = buffers->front();
  if (!buffer.is_object() || buffer.contains("uri") || !buffer.contains("byteLength") ||
      !is_index(buffer["byteLength"]))
    return std::nullopt;
  const auto length = buffer["byteLength"].get<std::uint64_t>();
  if (length > chunk_size)
    throw InvalidInput(file + ": buffers[0].byteLength " + std::to_string(length) + " exceeds the binary chunk of " +
                       std::to_string(chunk_size) + " bytes");
  buffer["byteLength"] = 1;
  buffer["uri"] = k_one_byte;
  return static_cast<std::size_t>(length);
}

/// Keeps the encoded bytes. Those of a buffer view are left where they are: its range is not checked yet.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  image->as_is = true;
  if (image->bufferView == -1) image->image.assign(bytes, bytes + size);
  return true;
}

/// tinygltf opens no files: those that a document names are read before.
tinygltf::TinyGLTF make_loader() {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, nullptr);
  loader.SetFsCallbacks(
      {[](const std::string&, void*) { return false; }, [](const std::string& path, void*) { return path; },
       [](std::vector<unsigned char>*, std::string*, const std::string&, void*) { return false; },
       [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }, nullptr});
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
  const std::string& bytes = document.storage.emplace_back(read_file(path));
  if (bytes.empty()) throw InvalidInput(document.file + ": is empty");
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(document.file + ": is larger than glTF's limit of 4 GiB");
  document.binary = std::string_view(bytes).starts_with(k_magic);
  std::string_view text = document.binary ? json_chunk(bytes, document.file) : std::string_view(bytes);
  Json json = parse_header(text, document.file, document.warnings);
  check_meshopt_numbers(json, document.file);
  if (const std::string bad = find_bad_member(json, k_whole); !bad.empty())
    throw InvalidInput(document.file + ": " + bad);
  const auto primitives = count_primitives(json);
  const auto chunk = document.binary ? binary_chunk(bytes, document.file) : std::nullopt;
  const auto first_length = chunk ? detach_chunk(json, chunk->size(), document.file) : std::nullopt;
  document.empty_buffers = fill_empty_buffers(json, chunk.has_value());
  const std::vector<Indices> detached = detach_indices(json);
  const bool renamed = rename_picture_types(json), dropped = drop_channels_without_node(json);
  std::vector<ReferencedFile> buffers = detach_buffers(json, path), images = detach_images(json, path);
  std::string edited;
  if (first_length || !document.empty_buffers.empty() || !detached.empty() || renamed || dropped || !buffers.empty() ||
      !images.empty())
    text = edited = text_of(json);

  tinygltf::TinyGLTF loader = make_loader();
  std::string error, warning;
  bool good = false;
  try {
    good = loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                      static_cast<unsigned>(text.size()), "");
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  if (!good) throw InvalidInput(document.file + ": " + reason(json, error));
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m)
    if (document.model.meshes[m].primitives.size() != primitives.at(m))
      throw InvalidInput(document.file + ": " + reason(json, "mesh " + std::to_string(m) + ": " + error));
  for (const tinygltf::Buffer& buffer : document.model.buffers) document.buffers.emplace_back(buffer.data);
  const auto set_content = [&](std::size_t number, std::string_view content) {
    document.buffers.at(number) = {reinterpret_cast<const unsigned char*>(content.data()), content.size()};
  };
  if (first_length) set_content(0, chunk->substr(0, *first_length));
  document.storage.reserve(1 + buffers.size());  // Not to move the file.
  for (ReferencedFile& file : buffers) set_content(file.number, document.storage.emplace_back(std::move(file.bytes)));
  for (ReferencedFile& file : images) {
    tinygltf::Image& image = document.model.images[file.number];
    image.image.assign(file.bytes.begin(), file.bytes.end());
    image.uri = std::move(file.uri);
  }
  for (const Indices& indices : detached)
    document.model.meshes[indices.mesh].primitives[indices.primitive].indices = indices.accessor;
  add_warnings(error, document.warnings);
  add_warnings(warning, document.warnings);
  return document;
}

}  // namespace papilla::gltf
