// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>

#include "flat_mesh.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written in place");

template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void append_real(std::string& bytes, double value) {
  const auto number = static_cast<float>(value);
  if (!std::isfinite(number)) throw InvalidInput(fmt::format("write_ply: {} is no 32-bit float", value));
  append(bytes, number);
}

void append_real(std::string& bytes, Vec3 v) {
  append_real(bytes, v.x);
  append_real(bytes, v.y);
  append_real(bytes, v.z);
}

void append_real(std::string& bytes, Vec2 v) {
  append_real(bytes, v.x);
  append_real(bytes, v.y);
}

/// A list of a pair per corner, or of none.
void append_corners(std::string& bytes, const std::optional<std::array<Vec2, 3>>& uv) {
  append(bytes, static_cast<std::uint8_t>(uv ? 6 : 0));
  if (uv)
    for (const Vec2 corner : *uv) append_real(bytes, corner);
}

/// Colours that are not finite are white.
void append_color(std::string& bytes, const Color& color) {
  const auto byte = [](double x) { return static_cast<std::uint8_t>(std::isfinite(x) ? std::lround(255 * x) : 255); };
  append(bytes, byte(srgb_from_linear(static_cast<double>(color.r))));
  append(bytes, byte(srgb_from_linear(static_cast<double>(color.g))));
  append(bytes, byte(srgb_from_linear(static_cast<double>(color.b))));
  append(bytes, byte(std::clamp(static_cast<double>(color.a), 0.0, 1.0)));
}

std::string header(const FlatMesh& mesh) {
  std::string text = fmt::format("ply\nformat binary_little_endian 1.0\ncomment papilla {}, millimetres\n", version());
  const auto properties = [&](const char* type, std::initializer_list<const char*> names) {
    for (const char* name : names) text += fmt::format("property {} {}\n", type, name);
  };
  text += fmt::format("element vertex {}\n", mesh.positions.size());
  properties("float", {"x", "y", "z"});
  if (!mesh.normals.empty()) properties("float", {"nx", "ny", "nz"});
  if (!mesh.uv.empty()) properties("float", {"s", "t"});
  if (!mesh.cad_uv.empty()) properties("float", {"cad_u", "cad_v"});
  if (!mesh.colors.empty()) properties("uchar", {"red", "green", "blue", "alpha"});
  text += fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", mesh.triangles.size());
  if (!mesh.triangle_uv.empty()) text += "property list uchar float texcoord\n";
  if (!mesh.triangle_cad_uv.empty()) text += "property list uchar float cad_uv\n";
  return text + "end_header\n";
}

}  // namespace

std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path) {
  const FlatMesh mesh = flatten(scene);
  std::string bytes = header(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    append_real(bytes, mesh.positions[v]);
    if (!mesh.normals.empty()) append_real(bytes, mesh.normals[v]);
    if (!mesh.uv.empty()) append_real(bytes, mesh.uv[v]);
    if (!mesh.cad_uv.empty()) append_real(bytes, mesh.cad_uv[v]);
    if (!mesh.colors.empty()) append_color(bytes, mesh.colors[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    append(bytes, std::uint8_t{3});
    for (const Index corner : mesh.triangles[t]) append(bytes, corner);
    if (!mesh.triangle_uv.empty()) append_corners(bytes, mesh.triangle_uv[t]);
    if (!mesh.triangle_cad_uv.empty()) append_corners(bytes, mesh.triangle_cad_uv[t]);
  }
  write_atomically(path, bytes);
  return scene_losses(scene, mesh.keeps);
}

}  // namespace papilla
