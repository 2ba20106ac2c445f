// SPDX-License-Identifier: MIT
#include "glb_document.hpp"

#include <cstdint>
#include <limits>
#include <ostream>

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

std::size_t GlbBuffer::add_view(std::span<const std::byte> bytes, Target target) {
  size_ += padding_of(size_);
  Json view = {{"buffer", 0}, {"byteOffset", size_}, {"byteLength", bytes.size()}};
  if (target != Target::none) view["target"] = static_cast<int>(target);
  contents_.push_back(bytes);
  size_ += bytes.size();
  views_.push_back(std::move(view));
  return views_.size() - 1;
}

std::size_t GlbBuffer::add_accessor(std::size_t view, Json accessor) {
  Json entry = {{"bufferView", view}};
  entry.update(accessor);
  accessors_.push_back(std::move(entry));
  return accessors_.size() - 1;
}

void GlbBuffer::write(std::ostream& out) const {
  std::size_t written = 0;
  for (const auto& bytes : contents_) {
    out.write("\0\0\0", static_cast<std::streamsize>(padding_of(written)));
    written += padding_of(written);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    written += bytes.size();
  }
}

void write_glb_container(const std::filesystem::path& path, const std::string& json, std::size_t binary_size,
                         const std::function<void(std::ostream&)>& write_binary, std::string_view further_chunks) {
  constexpr std::size_t k_json = 0x4e4f534a, k_bin = 0x004e4942;
  const std::size_t json_size = json.size() + padding_of(json.size());
  const std::size_t padded_binary = binary_size + padding_of(binary_size);
  const std::size_t length = 12 + 8 + json_size + (binary_size == 0 ? 0 : 8 + padded_binary) + further_chunks.size();
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("write_glb: " + std::to_string(length) + " bytes exceed glTF's limit of 4 GiB");
  const auto write = [&](std::ostream& out) {
    out << "glTF";
    write_word(out, 2);
    write_word(out, length);
    write_word(out, json_size);
    write_word(out, k_json);
    out << json << std::string(padding_of(json.size()), ' ');
    if (binary_size > 0) {
      write_word(out, padded_binary);
      write_word(out, k_bin);
      write_binary(out);
      out << std::string(padding_of(binary_size), '\0');
    }
    out << further_chunks;
  };
  write_atomically(path, write, length);
}

}  // namespace papilla
