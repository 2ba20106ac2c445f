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

/// The samples of a zlib stream [RFC 1950] of stored blocks [RFC 1951, 3.2.4], as the corpus has them; else what
/// stands.
std::string stored_samples(std::string_view stream) {
  std::string samples;
  for (std::size_t at = 2; at + 5 <= stream.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(stream[i])); };
    if (byte(at) > 1) break;
    samples += stream.substr(at + 5, byte(at + 1) | byte(at + 2) << 8);
    if (byte(at) == 1) break;
    at += 5 + (byte(at + 1) | byte(at + 2) << 8);
  }
  return samples;
}

std::string zlib_stream(std::string_view samples) {
  constexpr std::size_t k_most = 65535;
  std::string stream("\x78\x01", 2);
  for (std::size_t at = 0; at == 0 || at < samples.size(); at += k_most) {
    const std::string_view block = samples.substr(at, k_most);
    stream += at + k_most >= samples.size() ? '\1' : '\0';
    for (const std::size_t word : {block.size(), ~block.size()})
      (stream += static_cast<char>(word)) += static_cast<char>(word >> 8);
    stream += block;
  }
  return stream + big_endian(adler32(samples));
}

/// Bytes of each row, the filter's aside, as the header has them; those of the seven passes one after the other when
/// it is interlaced [PNG 8.2].
std::vector<std::size_t> row_bytes(std::string_view header) {
  struct Pass {
    std::size_t x, y, dx, dy;
  };
  constexpr std::array<Pass, 7> k_adam7{
      {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4}, {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}}};
  constexpr std::array<std::size_t, 7> k_channels{1, 1, 3, 1, 2, 1, 4};
  const std::size_t width = big_endian(header, 0), height = big_endian(header, 4),
                    bits = static_cast<unsigned char>(header[8]) *
                           k_channels[std::min<std::size_t>(6, static_cast<unsigned char>(header[9]))];
  std::vector<std::size_t> rows;
  const auto add = [&](Pass p) {
    if (width <= p.x) return;
    for (std::size_t y = p.y; y < height; y += p.dy) rows.push_back(((width - p.x + p.dx - 1) / p.dx * bits + 7) / 8);
  };
  if (header[12] == 0)
    add({0, 0, 1, 1});
  else
    for (const Pass& pass : k_adam7) add(pass);
  return rows;
}

/// As many samples as the header asks for, each row with a filter that exists, in one chunk.
void mend_samples(std::vector<Chunk>& chunks) {
  constexpr std::size_t k_most_pixels = 1 << 16;
  const auto first = std::find_if(chunks.begin(), chunks.end(), [](const Chunk& c) { return c.name == "IDAT"; });
  const std::string& header = chunks.front().data;
  if (first == chunks.end() || header.size() < 13) return;
  if (std::uint64_t{big_endian(header, 0)} * big_endian(header, 4) > k_most_pixels) return;
  std::string stream;
  for (const Chunk& chunk : chunks)
    if (chunk.name == "IDAT") stream += chunk.data;
  const std::string given = stored_samples(stream);
  std::string samples;
  std::size_t at = 0;
  const auto next = [&] { return given.empty() ? '\0' : given[at++ % given.size()]; };
  for (const std::size_t bytes : row_bytes(header)) {
    samples += static_cast<char>(static_cast<unsigned char>(next()) % 5);
    for (std::size_t i = 0; i < bytes; ++i) samples += next();
  }
  first->data = zlib_stream(samples);
  chunks.erase(std::remove_if(std::next(first), chunks.end(), [](const Chunk& c) { return c.name == "IDAT"; }),
               chunks.end());
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
  switch (random.below(8)) {
    case 0: mutate_header(chunks.front().data, random); break;
    case 1: chunks.insert(chunks.begin() + static_cast<std::ptrdiff_t>(at), Chunk(random.of(chunks))); break;
    case 2: chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(at)); break;
    case 3: chunks[at].data.resize(random.below(2 * chunks[at].data.size() + 2)); break;
    default:
      for (Chunk& chunk : chunks)
        if (chunk.name == "IDAT") mutate_data(chunk.data, random);
      break;
  }
  if (!chunks.empty() && random.chance(0.9)) mend_samples(chunks);
  bytes = k_signature;
  for (const Chunk& chunk : chunks) {
    bytes += big_endian(static_cast<std::uint32_t>(chunk.data.size())) + chunk.name + chunk.data;
    bytes += big_endian(crc32(chunk.name + chunk.data));
  }
}

}  // namespace papilla::fuzz
