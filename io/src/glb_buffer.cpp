// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

std::size_t padding_of(std::size_t size) { return (4 - size % 4) % 4; }

void write_word(std::ostream& out, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  out.write(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

const GlbBuffer::Content& GlbBuffer::add_content(std::span<const std::byte> bytes) {
  if (bytes.size() > largest_buffer_)
    throw InvalidInput("write_glb: " + std::to_string(bytes.size()) +
                       " bytes of one mesh or picture are more than the " + std::to_string(largest_buffer_) +
                       " that a buffer may hold");
  if (sizes_.empty()) sizes_.push_back(0);
  std::size_t offset = sizes_.back() + padding_of(sizes_.back());
  if (offset > largest_buffer_ - bytes.size()) {
    sizes_.push_back(0);
    offset = 0;
  }
  sizes_.back() = offset + bytes.size();
  contents_.push_back({sizes_.size() - 1, offset, bytes});
  return contents_.back();
}

std::size_t GlbBuffer::add_view(std::span<const std::byte> bytes, Target target, std::size_t stride) {
  const Content& content = add_content(bytes);
  Json view = {{"buffer", content.buffer}, {"byteOffset", content.offset}, {"byteLength", bytes.size()}};
  if (stride > 0) view["byteStride"] = stride;
  if (target != Target::none) view["target"] = static_cast<int>(target);
  views_.push_back(std::move(view));
  return views_.size() - 1;
}

std::size_t GlbBuffer::add_meshopt_view(std::vector<unsigned char>&& stream, Target target,
                                        const MeshoptLayout& layout) {
  const std::size_t length = layout.count * layout.stride;
  const Content& content = add_content(keep(std::move(stream)));
  Json compressed = {
      {"buffer", content.buffer},    {"byteOffset", content.offset}, {"byteLength", content.bytes.size()},
      {"byteStride", layout.stride}, {"count", layout.count},        {"mode", layout.mode}};
  if (std::string_view(layout.filter) != "NONE") compressed["filter"] = layout.filter;
  fallback_size_ += padding_of(fallback_size_);
  Json view = {{"buffer", nullptr}, {"byteOffset", fallback_size_}, {"byteLength", length}};
  if (target == Target::vertices) view["byteStride"] = layout.stride;
  view["target"] = static_cast<int>(target);
  view["extensions"]["EXT_meshopt_compression"] = std::move(compressed);
  fallback_size_ += length;
  views_.push_back(std::move(view));
  return views_.size() - 1;
}

std::size_t GlbBuffer::add_accessor(std::size_t view, Json accessor) {
  Json entry = {{"bufferView", view}};
  entry.update(accessor);
  return add_accessor(std::move(entry));
}

std::size_t GlbBuffer::add_accessor(Json accessor) {
  accessors_.push_back(std::move(accessor));
  return accessors_.size() - 1;
}

void GlbBuffer::describe(Json& gltf) const {
  for (const std::size_t size : sizes_) gltf["buffers"].push_back({{"byteLength", size}});
  if (fallback_size_ > 0)
    gltf["buffers"].push_back(
        {{"byteLength", fallback_size_}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  if (!views_.empty()) {
    gltf["bufferViews"] = views_;
    for (Json& view : gltf["bufferViews"])
      if (view["buffer"].is_null()) view["buffer"] = sizes_.size();
  }
  if (!accessors_.empty()) gltf["accessors"] = accessors_;
}

void GlbBuffer::write(std::size_t number, std::ostream& out) const {
  std::size_t written = 0;
  for (const Content& content : contents_) {
    if (content.buffer != number) continue;
    out.write("\0\0\0", static_cast<std::streamsize>(content.offset - written));
    out.write(reinterpret_cast<const char*>(content.bytes.data()), static_cast<std::streamsize>(content.bytes.size()));
    written = content.offset + content.bytes.size();
  }
}

std::size_t glb_length(const std::filesystem::path& path, std::size_t json_size, std::size_t binary_size,
                       std::size_t further_size) {
  constexpr std::size_t k_headers = 12 + 8;
  const std::size_t binary = binary_size == 0 ? 0 : 8 + binary_size + padding_of(binary_size);
  const std::size_t length = k_headers + json_size + padding_of(json_size) + binary + further_size;
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(path.string() + ": " + std::to_string(length) +
                       " bytes exceed the 4 GiB that a GLB can hold: write a .gltf, whose data lie in several files");
  return length;
}

void write_glb_container(const std::filesystem::path& path, const std::string& json, std::size_t binary_size,
                         const std::function<void(std::ostream&)>& write_binary, std::string_view further_chunks) {
  constexpr std::size_t k_json = 0x4e4f534a, k_bin = 0x004e4942;
  const std::size_t length = glb_length(path, json.size(), binary_size, further_chunks.size());
  const auto write = [&](std::ostream& out) {
    out << "glTF";
    write_word(out, 2);
    write_word(out, length);
    write_word(out, json.size() + padding_of(json.size()));
    write_word(out, k_json);
    out << json << std::string(padding_of(json.size()), ' ');
    if (binary_size > 0) {
      write_word(out, binary_size + padding_of(binary_size));
      write_word(out, k_bin);
      write_binary(out);
      out << std::string(padding_of(binary_size), '\0');
    }
    out << further_chunks;
  };
  write_atomically(path, write, length);
}

}  // namespace papilla
