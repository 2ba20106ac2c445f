// SPDX-License-Identifier: MIT
#include "png_mutator.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace papilla::fuzz {
namespace {

constexpr std::string_view k_signature("\x89PNG\r\n\x1a\n", 8);

struct Chunk {
  std::string name, data;
};

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(at, 4)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
  return bytes;
}

/// CRC-32 of ISO 3309, as in annex D of the PNG specification.
std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

std::uint32_t adler32(std::string_view bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

std::vector<Chunk> chunks_of(std::string_view bytes) {
  std::vector<Chunk> chunks;
  bytes.remove_prefix(k_signature.size());
  while (bytes.size() >= 12) {
    const std::size_t length = std::min<std::size_t>(big_endian(bytes, 0), bytes.size() - 12);
    chunks.push_back({std::string(bytes.substr(4, 4)), std::string(bytes.substr(8, length))});
    bytes.remove_prefix(12 + length);
  }
  return chunks;
}

/// The sum at the end of a zlib stream [RFC 1950] of stored blocks [RFC 1951, 3.2.4].
void mend_sum(std::string& stream) {
  std::string stored;
  for (std::size_t at = 2; at + 5 <= stream.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(stream[i])); };
    if (byte(at) > 1) return;
    const std::size_t length = byte(at + 1) | byte(at + 2) << 8;
    if (at + 5 + length + 4 > stream.size()) return;
    stored += stream.substr(at + 5, length);
    if (byte(at) == 1) {
      stream.replace(at + 5 + length, 4, big_endian(adler32(stored)));
      return;
    }
    at += 5 + length;
  }
}

void mutate_header(std::string& data, Random& random) {
  constexpr char k_depths[] = {1, 2, 4, 8, 16}, k_types[] = {0, 2, 3, 4, 6};
  if (data.size() < 13) return;
  switch (random.below(6)) {
    case 0: data[3] = static_cast<char>(random.below(40)); break;
    case 1: data[7] = static_cast<char>(random.below(40)); break;
    case 2: data[8] = random.of(k_depths); break;
    case 3: data[9] = random.of(k_types); break;
    case 4: data[12] ^= 1; break;
    default: data[random.chance(0.1) ? random.below(13) : 12] = static_cast<char>(random.below(256)); break;
  }
}

void mutate_data(std::string& data, Random& random) {
  if (data.empty()) return;
  for (std::size_t left = 1 + random.below(6); left > 0; --left)
    data[random.below(data.size())] = static_cast<char>(random.below(256));
}

}  // namespace

bool is_png(std::string_view bytes) { return bytes.starts_with(k_signature); }

void mutate_png(std::string& bytes, Random& random) {
  std::vector<Chunk> chunks = chunks_of(bytes);
  if (chunks.empty()) return;
  const std::size_t at = random.below(chunks.size());
  switch (random.below(16)) {
    case 0: mutate_header(chunks.front().data, random); break;
    case 1: chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(at), Chunk(random.of(chunks))); break;
    case 2: chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(at)); break;
    case 3: chunks[at].data.resize(random.below(2 * chunks[at].data.size() + 2)); break;
    default: mutate_data(chunks[at].data, random); break;
  }
  bytes = k_signature;
  for (Chunk& chunk : chunks) {
    if (chunk.name == "IDAT") mend_sum(chunk.data);
    bytes += big_endian(static_cast<std::uint32_t>(chunk.data.size())) + chunk.name + chunk.data;
    bytes += big_endian(crc32(chunk.name + chunk.data));
  }
}

}  // namespace papilla::fuzz
