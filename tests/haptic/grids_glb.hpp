// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "haptic/tagged_glb.hpp"

namespace papilla::testing {

/// A GLB of wavy oblong grids with normals and uv: in one mesh a grid of the material "grain" and one of the material
/// "plain", placed by three nodes: moved, turned about an odd axis and scaled unevenly, and mirrored.
/// @param columns, rows of each grid; its sides are in the same ratio. @param grain, plain their extras.
/// @param image bytes of an image named haptic.height.grain; empty for none.
inline std::string grids_glb(int columns, int rows, const nlohmann::json& grain, const nlohmann::json& plain,
                             const std::string& image) {
  const int corners = (columns + 1) * (rows + 1);
  const float step = 0.3F / static_cast<float>(columns);
  std::mt19937 random(11);
  std::uniform_real_distribution<float> rough(-1, 1);
  nlohmann::json views = nlohmann::json::array(), accessors = nlohmann::json::array();
  nlohmann::json primitives = nlohmann::json::array();
  std::string data;
  const auto add_view = [&](const std::string& bytes) {
    views.push_back({{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}});
    data += bytes + std::string((4 - bytes.size() % 4) % 4, '\0');
    return views.size() - 1;
  };
  const auto add_accessor = [&](const std::string& bytes, int component, std::size_t count, const char* type) {
    accessors.push_back(
        {{"bufferView", add_view(bytes)}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessors.size() - 1;
  };
  const auto add = [](std::string& to, float value) { to += little_endian(std::bit_cast<std::uint32_t>(value), 4); };
  for (int material = 0; material < 2; ++material) {
    std::string positions, normals, uvs, indices;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i) {
        const float x = step * static_cast<float>(i), z = -step * static_cast<float>(j + material * (rows + 3));
        const float y = 0.004F * std::sin(40 * x) * std::cos(55 * z) + 0.02F * step * rough(random);
        for (const float value : {x, y, z}) add(positions, value);
        for (const float value : {0.1F * rough(random), 1.5F, 0.1F * rough(random)}) add(normals, value);
        for (const float value : {20 * x + 3 * z, 31 * z}) add(uvs, value);
      }
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const auto a = static_cast<std::uint32_t>(j * (columns + 1) + i),
                   d = a + static_cast<std::uint32_t>(columns) + 1;
        for (const std::uint32_t v : {a, a + 1, d + 1, a, d + 1, d}) indices += little_endian(v, 4);
      }
    const auto count = static_cast<std::size_t>(corners);
    primitives.push_back({{"attributes",
                           {{"POSITION", add_accessor(positions, 5126, count, "VEC3")},
                            {"NORMAL", add_accessor(normals, 5126, count, "VEC3")},
                            {"TEXCOORD_0", add_accessor(uvs, 5126, count, "VEC2")}}},
                          {"indices", add_accessor(indices, 5125, indices.size() / 4, "SCALAR")},
                          {"material", material}});
  }
  nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0, 1, 2}}}}},
      {"nodes",
       {{{"mesh", 0}, {"translation", {0.05, -0.02, 0.7}}},
        {{"mesh", 0},
         {"translation", {0.4, 0.5, -0.3}},
         {"rotation", {0.36, -0.48, 0.64, 0.48}},
         {"scale", {1, 0.7, 1.4}}},
        {{"mesh", 0}, {"translation", {-0.5, 0.3, 0.1}}, {"rotation", {0.5, 0.5, 0.1, 0.7}}, {"scale", {-1, 1, 1}}}}},
      {"meshes", {{{"primitives", primitives}}}},
      {"materials", {{{"name", "grain"}, {"extras", grain}}, {{"name", "plain"}, {"extras", plain}}}}};
  if (!image.empty())
    gltf["images"] = {{{"name", "haptic.height.grain"}, {"mimeType", "image/png"}, {"bufferView", add_view(image)}}};
  gltf["buffers"] = {{{"byteLength", data.size()}}};
  gltf["bufferViews"] = views;
  gltf["accessors"] = accessors;
  std::string json = gltf.dump();
  json += std::string((4 - json.size() % 4) % 4, ' ');
  const auto size = [](std::size_t s) { return little_endian(static_cast<std::uint32_t>(s), 4); };
  return "glTF" + size(2) + size(12 + 8 + json.size() + 8 + data.size()) + size(json.size()) + "JSON" + json +
         size(data.size()) + std::string("BIN\0", 4) + data;
}

}  // namespace papilla::testing
