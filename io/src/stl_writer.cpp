// SPDX-License-Identifier: MIT
#include "papilla/io/stl_writer.hpp"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "placed_mesh.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is written in place");

void append(std::string& bytes, Vec3 v) {
  for (const double x : {v.x, v.y, v.z}) {
    const float number = static_cast<float>(x);
    if (!std::isfinite(number)) throw InvalidInput(fmt::format("write_stl: {} is no 32-bit float", x));
    char raw[4];
    std::memcpy(raw, &number, sizeof raw);
    bytes.append(raw, sizeof raw);
  }
}

void append(std::string& bytes, const PlacedMesh& mesh) {
  const auto order = corner_order(mesh);
  for (const Triangle& triangle : mesh.part->mesh.triangles) {
    const Vec3 a = mesh.positions[triangle[order[0]]], b = mesh.positions[triangle[order[1]]],
               c = mesh.positions[triangle[order[2]]];
    append(bytes, normalized(cross(b - a, c - a)));
    append(bytes, a);
    append(bytes, b);
    append(bytes, c);
    bytes.append(2, '\0');
  }
}

}  // namespace

void write_stl(const Scene& scene, const std::filesystem::path& path) {
  std::string bytes = fmt::format("binary STL by papilla {}, millimetres", version());
  bytes.resize(84, '\0');
  for (const Instance& instance : instances(scene)) append(bytes, place(scene, instance));
  const std::size_t count = (bytes.size() - 84) / 50;
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(fmt::format("write_stl: {} triangles are more than STL can hold", count));
  const auto number = static_cast<std::uint32_t>(count);
  std::memcpy(bytes.data() + 80, &number, sizeof number);
  write_atomically(path, bytes);
}

}  // namespace papilla
