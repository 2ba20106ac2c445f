// SPDX-License-Identifier: MIT
#include "blob_document.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <span>

#include "papilla/core/base64.hpp"
#include "png_mutator.hpp"

namespace papilla::fuzz {
namespace {

constexpr std::string_view k_token = "blob:", k_base64 = ";base64,";
constexpr std::size_t k_header = 20, k_longest_blob = 1 << 16;

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void append_word(std::string& bytes, std::size_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string token(std::size_t number) { return std::string(k_token) + std::to_string(number); }

std::optional<std::size_t> number_of(const Json& value) {
  if (!value.is_string()) return std::nullopt;
  const auto& text = value.get_ref<const std::string&>();
  std::size_t number = 0;
  if (!text.starts_with(k_token)) return std::nullopt;
  const char* const begin = text.data() + k_token.size();
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  return number;
}

void detach(Json& value, BlobDocument& document) {
  if (value.is_structured()) {
    for (Json& member : value) detach(member, document);
  } else if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    const std::size_t data = text.starts_with("data:") ? text.find(k_base64) : std::string::npos;
    if (data == std::string::npos) return;
    const auto bytes = decode_base64(std::string_view(text).substr(data + k_base64.size()));
    if (!bytes) return;
    document.blobs.push_back({text.substr(5, data - 5), *bytes});
    value = token(document.blobs.size() - 1);
  }
}

void attach(Json& value, const BlobDocument& document) {
  if (value.is_structured()) {
    for (Json& member : value) attach(member, document);
  } else if (const auto number = number_of(value); number && *number < document.blobs.size()) {
    const auto& [mime_type, bytes] = document.blobs[*number];
    value = "data:" + mime_type + std::string(k_base64) + encode_base64(std::as_bytes(std::span(bytes)));
  }
}

/// Changes a float, or copies bytes within the blob.
void mutate_numbers(std::string& bytes, Random& random) {
  constexpr float k_floats[] = {0, -0.0F, 1, -1, 1e-30F, 1e-6F, 1e6F, 1e30F, 3e38F, 1e-45F};
  constexpr std::size_t k_widths[] = {1, 2, 4, 4, 4};
  const std::size_t width = random.of(k_widths);
  if (bytes.size() < 2 * width) return;
  const std::size_t count = bytes.size() / width, at = width * random.below(count), from = width * random.below(count);
  char* const target = bytes.data() + at;
  if (width < 4 || random.chance(0.3)) {
    const std::size_t length = random.chance(0.7) ? width : std::min(12 * width, bytes.size() - std::max(at, from));
    if (width < 4 && random.chance(0.5))
      *target = static_cast<char>(random.below(random.chance(0.5) ? 256 : 8));
    else
      std::memmove(target, bytes.data() + from, length);
    return;
  }
  float number = 0;
  std::memcpy(&number, target, width);
  switch (random.below(3)) {
    case 0: number = random.of(k_floats); break;
    case 1: number *= static_cast<float>(random.real(-2, 2)); break;
    default: number += static_cast<float>(random.real(-1, 1)); break;
  }
  std::memcpy(target, &number, width);
}

}  // namespace

BlobDocument::Blob* BlobDocument::blob_of(const Json& value) {
  const auto number = number_of(value);
  return number && *number < blobs.size() ? &blobs[*number] : nullptr;
}

std::optional<BlobDocument> parse_blob_document(std::string_view bytes) {
  BlobDocument document;
  std::string_view text = bytes;
  if (bytes.starts_with("glTF")) {
    if (bytes.size() < k_header) return std::nullopt;
    document.glb = true;
    text = bytes.substr(k_header, word(bytes, 12));
  }
  document.json = Json::parse(text, nullptr, false);
  if (!document.json.is_object()) return std::nullopt;
  const std::size_t binary = k_header + text.size() + 8;  // Behind length and type of the chunk.
  if (document.glb && bytes.size() > binary) {
    document.blobs.push_back({"application/octet-stream", std::string(bytes.substr(binary))});
    Json& buffers = document.json["buffers"];
    if (buffers.is_array() && !buffers.empty() && buffers[0].is_object()) buffers[0]["uri"] = token(0);
  }
  detach(document.json, document);
  return document;
}

std::string to_bytes(const BlobDocument& document) {
  Json json = document.json;
  std::string binary;
  if (document.glb && json.contains("buffers") && json["buffers"].is_array() && !json["buffers"].empty()) {
    Json& first = json["buffers"][0];
    const auto number = first.is_object() && first.contains("uri") ? number_of(first["uri"]) : std::nullopt;
    if (number && *number < document.blobs.size()) {
      first.erase("uri");
      binary = document.blobs[*number].bytes;
    }
  }
  attach(json, document);
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!document.glb) return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, k_header + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
  append_word(bytes, text.size());
  bytes += "JSON" + text;
  if (binary.empty()) return bytes;
  append_word(bytes, binary.size());
  return bytes + std::string("BIN\0", 4) + binary;
}

void mutate_blob(BlobDocument& document, Random& random) {
  if (document.blobs.empty()) return;
  std::string& bytes = document.blobs[random.below(document.blobs.size())].bytes;
  if (is_png(bytes)) return mutate_png(bytes, random);
  for (std::size_t left = 1 + random.below(4); left > 0; --left) mutate_numbers(bytes, random);
  if (random.chance(0.05))
    bytes.resize(random.chance(0.5) ? bytes.size() / 2 : std::min(2 * bytes.size(), k_longest_blob));
}

}  // namespace papilla::fuzz
