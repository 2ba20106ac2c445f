// SPDX-License-Identifier: MIT
#include "gltf_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <ostream>
#include <set>

#include "glb_document.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/referenced_file.hpp"

namespace papilla {
namespace {

using Json = GltfFile::Json;

constexpr std::uint32_t k_json_chunk = 0x4e4f534a, k_bin_chunk = 0x004e4942;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

Json parse(std::string_view text, const std::filesystem::path& path) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw InvalidInput(path.string() + ": is no glTF");
  return json;
}

void pad(std::string& bytes) { bytes.resize((bytes.size() + 3) / 4 * 4, '\0'); }

bool is_file(const Json& entry) {
  return entry.contains("uri") && !entry["uri"].get_ref<const std::string&>().starts_with("data:");
}

/// Where a buffer is now.
struct Moved {
  std::size_t buffer = 0, offset = 0;
};

/// Lets a bufferView, or the extension that compresses one, name its buffer by its new number and place.
void redirect(Json& view, const std::vector<Moved>& moved) {
  const Moved& to = moved.at(view.at("buffer").get<std::size_t>());
  view["buffer"] = to.buffer;
  if (to.offset > 0) view["byteOffset"] = view.value("byteOffset", std::size_t{0}) + to.offset;
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path, const std::filesystem::path& output)
    : path_(path), output_(output) {
  const std::string bytes = read_file(path);
  const bool binary = std::string_view(bytes).starts_with("glTF");
  if (binary)
    read_binary(bytes);
  else
    json = parse(bytes, path);
  original_ = json;
  if (is_gltf_with_files(output)) {
    files_.emplace(output);
    keep_files();
  } else {
    embed_buffers(!binary);
  }
  original_size_ = binary_.size();
  if (!files_) embed_images();
  note_pictures();
}

void GltfFile::read_binary(const std::string& bytes) {
  const std::size_t end = std::min<std::size_t>(bytes.size() < 12 ? 0 : word_at(bytes, 8), bytes.size());
  for (std::size_t at = 12; at + 8 <= end;) {
    const std::size_t length = word_at(bytes, at);
    if (at + 8 + length > end) throw InvalidInput(path_.string() + ": a chunk of the GLB is truncated");
    const std::string_view chunk = std::string_view(bytes).substr(at + 8, length);
    if (at == 12 && word_at(bytes, at + 4) == k_json_chunk)
      json = parse(chunk, path_);
    else if (word_at(bytes, at + 4) == k_bin_chunk && binary_.empty() && further_chunks_.empty())
      binary_ = chunk;
    else
      further_chunks_ += std::string_view(bytes).substr(at, 8 + length);
    at += 8 + length;
  }
  if (!json.is_object()) throw InvalidInput(path_.string() + ": is no glTF");
}

/// @pre the buffer has a uri.
std::string GltfFile::buffer_bytes(std::size_t number) const {
  const Json& buffer = json["buffers"][number];
  const std::string& uri = buffer["uri"].get_ref<const std::string&>();
  const std::string place = path_.string() + ": at /buffers/" + std::to_string(number) + "/uri";
  std::optional<std::string> bytes;
  if (is_file(buffer))
    bytes = read_reference({path_.parent_path(), place, percent_decoded(uri)}, ReferenceContent::any);
  else
    bytes = decode_data_uri(uri);
  const auto length = buffer.value("byteLength", std::size_t{0});
  if (!bytes || bytes->size() < length)
    throw InvalidInput(place + ": " + std::to_string(length) + " bytes are missing");
  bytes->resize(length);
  return *std::move(bytes);
}

/// Into the binary chunk. Buffers without data, which compression leaves, stay buffers of their own.
void GltfFile::embed_buffers(bool all) {
  if (!json.contains("buffers")) return;
  const bool has_chunk = !binary_.empty() && !json["buffers"].empty() && !json["buffers"][0].contains("uri");
  std::string chunk;
  std::vector<Moved> moved(json["buffers"].size());
  Json first, others = Json::array();
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const Json& buffer = json["buffers"][i];
    const bool in_chunk = i == 0 && has_chunk;
    if (!in_chunk && !(buffer.contains("uri") && (all || i == 0 || is_file(buffer)))) {
      moved[i] = {1 + others.size(), 0};
      others.push_back(buffer);
      continue;
    }
    pad(chunk);
    moved[i] = {0, chunk.size()};
    chunk += in_chunk ? binary_ : buffer_bytes(i);
    if (first.is_null()) first = buffer;
  }
  if (first.is_null()) return;
  const bool changed = others.size() + 1 != moved.size() || first.contains("uri");
  binary_ = std::move(chunk);
  if (!changed) return;
  first.erase("uri");
  first["byteLength"] = binary_.size();
  others.insert(others.begin(), std::move(first));
  json["buffers"] = std::move(others);
  if (!json.contains("bufferViews")) return;
  for (Json& view : json["bufferViews"]) {
    redirect(view, moved);
    if (!view.contains("extensions")) continue;
    for (auto& [name, extension] : view["extensions"].items())
      if (name.ends_with("_meshopt_compression")) redirect(extension, moved);
  }
}

/// Pictures that are missing stay named.
void GltfFile::embed_images() {
  if (!json.contains("images")) return;
  for (std::size_t i = 0; i < json["images"].size(); ++i) {
    const Json& image = json["images"][i];
    if (!is_file(image)) continue;
    const std::string place = path_.string() + ": at /images/" + std::to_string(i) + "/uri";
    const auto bytes = read_reference({path_.parent_path(), place, percent_decoded(image["uri"].get<std::string>())},
                                      ReferenceContent::picture);
    if (!bytes) continue;
    const std::size_t view = add_view(*bytes);  // May move the lists.
    Json& moved = json["images"][i];
    moved.erase("uri");
    moved["bufferView"] = view;
    if (!moved.contains("mimeType")) moved["mimeType"] = picture_mime_type(*bytes);
  }
}

/// The binary chunk becomes the file of its buffer; without one, what is added gets a further buffer.
void GltfFile::keep_files() {
  std::set<std::string> names;
  collect_uris(json, names);
  for (const std::string& name : names) {
    std::optional<std::filesystem::path> source;
    try {
      source = resolve_reference({path_.parent_path(), path_.string(), name});
    } catch (const InvalidInput&) {
      // Leads out of the folder. Buffers and pictures don't, the reader looks; what extensions name stays named.
    }
    if (source) files_->copy(name, *source);
  }
  const std::size_t buffers = json.contains("buffers") ? json["buffers"].size() : 0;
  const bool has_chunk = !binary_.empty() && buffers > 0 && !json["buffers"][0].contains("uri");
  data_buffer_ = has_chunk ? 0 : buffers;
  if (!has_chunk) binary_.clear();
}

/// Those that are missing stay named.
void GltfFile::note_pictures() {
  if (!json.contains("images")) return;
  for (std::size_t i = 0; i < json["images"].size(); ++i) {
    const Json& image = json["images"][i];
    std::optional<std::string> file;
    std::string_view bytes;
    if (image.contains("bufferView")) {
      bytes = view_bytes(image["bufferView"].get<std::size_t>());
    } else if (is_file(image)) {
      const std::string place = path_.string() + ": at /images/" + std::to_string(i) + "/uri";
      file = read_reference({path_.parent_path(), place, percent_decoded(image["uri"].get<std::string>())},
                            ReferenceContent::picture);
      if (file) bytes = *file;
    }
    if (!bytes.empty()) pictures_.emplace(std::hash<std::string_view>{}(bytes), i);
  }
}

/// Empty when they are in a file of their own.
std::string_view GltfFile::view_bytes(std::size_t number) const {
  const Json& view = json.at("bufferViews").at(number);
  const auto offset = view.value("byteOffset", std::size_t{0}), length = view.at("byteLength").get<std::size_t>();
  if (view.at("buffer") != data_buffer_ || offset > binary_.size() || length > binary_.size() - offset) return {};
  return std::string_view(binary_).substr(offset, length);
}

std::size_t GltfFile::add_picture(const EncodedImage& image) {
  const std::string_view bytes(reinterpret_cast<const char*>(image.bytes.data()), image.bytes.size());
  const std::size_t hash = std::hash<std::string_view>{}(bytes);
  const auto [begin, end] = pictures_.equal_range(hash);
  for (auto known = begin; known != end; ++known)
    if (json["images"][known->second].value("name", "") == image.name) return known->second;
  Json entry = Json::object();
  if (files_)
    entry["uri"] = files_->add_picture(image);
  else
    entry["bufferView"] = add_view(bytes);
  entry["mimeType"] = image.mime_type;
  if (!image.name.empty()) entry["name"] = image.name;
  json["images"].push_back(std::move(entry));
  pictures_.emplace(hash, json["images"].size() - 1);
  return json["images"].size() - 1;
}

std::size_t GltfFile::add_view(std::string_view bytes, int target, std::size_t stride) {
  Json view = {{"buffer", data_buffer_}, {"byteOffset", 0}, {"byteLength", bytes.size()}};
  if (stride > 0) view["byteStride"] = stride;
  if (target != 0) view["target"] = target;
  const std::size_t hash = std::hash<std::string_view>{}(bytes);
  const auto [begin, end] = views_.equal_range(hash);
  for (auto known = begin; known != end; ++known) {
    const Json& other = json["bufferViews"][known->second];
    view["byteOffset"] = other.value("byteOffset", std::size_t{0});
    if (view == other && std::string_view(binary_).substr(view["byteOffset"].get<std::size_t>(), bytes.size()) == bytes)
      return known->second;
  }
  pad(binary_);
  view["byteOffset"] = binary_.size();
  binary_ += bytes;
  json["bufferViews"].push_back(std::move(view));
  views_.emplace(hash, json["bufferViews"].size() - 1);
  return json["bufferViews"].size() - 1;
}

std::size_t GltfFile::add(const char* list, Json entry) {
  Json& entries = json[list];
  const auto [numbers, is_first] = entries_.try_emplace(list);
  for (std::size_t i = 0; is_first && i < entries.size(); ++i) numbers->second.try_emplace(entries[i].dump(), i);
  const auto [known, is_new] = numbers->second.try_emplace(entry.dump(), entries.size());
  if (is_new) entries.push_back(std::move(entry));
  return known->second;
}

void GltfFile::copy_animations(const char* list, std::size_t original, std::size_t copy) {
  if (!json.contains("animations")) return;
  static const Json::json_pointer place("/target/extensions/KHR_animation_pointer/pointer");
  const std::string all = std::string("/") + list + "/", from = all + std::to_string(original) + "/";
  for (Json& animation : json["animations"]) {
    if (!animation.contains("channels")) continue;
    Json& channels = animation["channels"];
    for (std::size_t i = 0, count = channels.size(); i < count; ++i) {
      if (!channels[i].contains(place)) continue;
      const std::string pointer = channels[i][place].get<std::string>();
      if (!pointer.starts_with(from)) continue;
      Json channel = channels[i];
      channel[place] = all + std::to_string(copy) + "/" + pointer.substr(from.size());
      channels.push_back(std::move(channel));
    }
  }
}

void GltfFile::use_extension(const char* name) {
  Json& used = json["extensionsUsed"];
  if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

void GltfFile::forget_extension(const char* name) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (!json.contains(list)) continue;
    const auto found = std::find(json[list].begin(), json[list].end(), name);
    if (found != json[list].end()) json[list].erase(found);
    if (json[list].empty()) json.erase(list);
  }
}

void GltfFile::write() {
  if (binary_.size() > original_size_) {
    if (!json.contains("buffers")) json["buffers"] = Json::array();
    if (json["buffers"].size() <= data_buffer_) json["buffers"].push_back(Json::object());
    json["buffers"][data_buffer_]["byteLength"] = binary_.size();
  }
  if (files_) {
    if (!binary_.empty()) json["buffers"][data_buffer_]["uri"] = files_->add_binary(binary_);
    files_->write();
    write_atomically(output_, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return;
  }
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  write_glb_container(
      output_, text, binary_.size(), [&](std::ostream& chunk) { chunk << binary_; }, further_chunks_);
}

}  // namespace papilla
