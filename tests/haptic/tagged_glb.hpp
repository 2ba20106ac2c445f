// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

namespace papilla::testing {

inline std::string big_endian(std::uint32_t v, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(v >> (8 * i) & 0xffU);
  return text;
}

inline std::string little_endian(std::uint32_t v, int bytes) {
  const std::string text = big_endian(v, bytes);
  return {text.rbegin(), text.rend()};
}

/// A 16-bit PNG with uncompressed data. @param channels 1, grey, or 3, RGB.
inline std::string png16(int width, int height, int channels, const std::vector<std::uint16_t>& values) {
  std::string raw;
  for (int y = 0; y < height; ++y) {
    raw += '\0';
    for (int x = 0; x < width * channels; ++x)
      raw += big_endian(values[static_cast<std::size_t>(y * width * channels + x)], 2);
  }
  std::string stream = "\x78\x01";
  std::uint32_t a = 1, b = 0;
  for (const char c : raw) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  for (std::size_t at = 0; at < raw.size(); at += 65535) {
    const auto size = static_cast<std::uint32_t>(std::min<std::size_t>(65535, raw.size() - at));
    stream += at + size == raw.size() ? '\1' : '\0';
    stream += little_endian(size, 2) + little_endian(~size & 0xffffU, 2) + raw.substr(at, size);
  }
  stream += big_endian(b << 16 | a, 4);
  const auto chunk = [](const std::string& type, const std::string& data) {
    std::uint32_t crc = 0xffffffffU;
    for (const char c : type + data) {
      crc ^= static_cast<unsigned char>(c);
      for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320U ^ crc >> 1 : crc >> 1;
    }
    return big_endian(static_cast<std::uint32_t>(data.size()), 4) + type + data + big_endian(~crc, 4);
  };
  const std::string header = big_endian(static_cast<std::uint32_t>(width), 4) +
                             big_endian(static_cast<std::uint32_t>(height), 4) +
                             std::string(channels == 3 ? "\x10\2\0\0\0" : "\x10\0\0\0\0", 5);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", stream) + chunk("IEND", "");
}

inline std::string grey16_png(int width, int height, const std::vector<std::uint16_t>& values) {
  return png16(width, height, 1, values);
}

/// Four waves of a sine along u.
inline std::string sine_png() {
  const int n = 128;
  std::vector<std::uint16_t> values;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < n; ++x)
      values.push_back(static_cast<std::uint16_t>(
          std::lround(32767.5 + 32767 * std::sin(2 * std::numbers::pi * 4 * (x + 0.5) / n))));
  return grey16_png(n, 4, values);
}

/// A GLB of a plate of 0.1 × 0.1 m in the plane y = 0, front up, uv 2.5 repeats, with one material "grain".
/// @param extras of the material. @param image bytes of an image named haptic.height.grain; empty for none.
inline std::string plate_glb(const nlohmann::json& extras, const std::string& image) {
  const int n = 10;
  std::string positions, uvs, indices;
  const auto add = [](std::string& to, float value) { to += little_endian(std::bit_cast<std::uint32_t>(value), 4); };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      for (const float value : {0.01F * static_cast<float>(i), 0.0F, -0.01F * static_cast<float>(j)})
        add(positions, value);
      for (const float value : {0.25F * static_cast<float>(i), 0.25F * static_cast<float>(j)}) add(uvs, value);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), d = a + static_cast<std::uint32_t>(n) + 1;
      for (const std::uint32_t v : {a, a + 1, d + 1, a, d + 1, d}) indices += little_endian(v, 4);
    }
  nlohmann::json views = nlohmann::json::array();
  std::string data;
  for (const std::string& part : {positions, uvs, indices, image}) {
    if (part.empty()) continue;
    views.push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", part.size()}});
    data += part + std::string((4 - part.size() % 4) % 4, '\0');
  }
  const int vertices = (n + 1) * (n + 1);
  nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes",
       {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"material", 0}}}}}}},
      {"materials", {{{"name", "grain"}, {"extras", extras}}}},
      {"buffers", {{{"byteLength", data.size()}}}},
      {"bufferViews", views},
      {"accessors",
       {{{"bufferView", 0},
         {"componentType", 5126},
         {"count", vertices},
         {"type", "VEC3"},
         {"min", {0, 0, -0.1}},
         {"max", {0.1, 0, 0}}},
        {{"bufferView", 1}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC2"}},
        {{"bufferView", 2}, {"componentType", 5125}, {"count", 6 * n * n}, {"type", "SCALAR"}}}}};
  if (!image.empty())
    gltf["images"] = {{{"name", "haptic.height.grain"}, {"mimeType", "image/png"}, {"bufferView", 3}}};
  std::string json = gltf.dump();
  json += std::string((4 - json.size() % 4) % 4, ' ');
  const auto size = [](std::size_t s) { return little_endian(static_cast<std::uint32_t>(s), 4); };
  return "glTF" + size(2) + size(12 + 8 + json.size() + 8 + data.size()) + size(json.size()) + "JSON" + json +
         size(data.size()) + std::string("BIN\0", 4) + data;
}

inline std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
  }
  return text;
}

}  // namespace papilla::testing
