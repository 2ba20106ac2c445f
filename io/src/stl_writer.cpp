// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <ostream>
#include <string>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "placed_mesh.hpp"
#include "scene_losses.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is written in place");

/// The records of STL, gathered into blocks on their way to a file.
class RecordWriter {
 public:
  explicit RecordWriter(std::ostream& out) : out_(out) {}

  void write(const PlacedMesh& mesh) {
    const auto order = corner_order(mesh);
    for (const Triangle& triangle : mesh.part->mesh.triangles) {
      const Vec3 a = mesh.positions[triangle[order[0]]], b = mesh.positions[triangle[order[1]]],
                 c = mesh.positions[triangle[order[2]]];
      append(normalized(cross(b - a, c - a)));
      append(a);
      append(b);
      append(c);
      block_.append(2, '\0');
      if (block_.size() > k_block_size) flush();
    }
  }

  void flush() {
    out_.write(block_.data(), static_cast<std::streamsize>(block_.size()));
    block_.clear();
  }

 private:
  static constexpr std::size_t k_block_size = 1 << 16;

  void append(Vec3 v) {
    for (const double x : {v.x, v.y, v.z}) {
      const float number = static_cast<float>(x);
      if (!std::isfinite(number)) throw InvalidInput(fmt::format("write_stl: {} is no 32-bit float", x));
      char raw[4];
      std::memcpy(raw, &number, sizeof raw);
      block_.append(raw, sizeof raw);
    }
  }

  std::ostream& out_;
  std::string block_;
};

std::string header(std::uint32_t triangles) {
  std::string bytes = fmt::format("binary STL by papilla {}, millimetres", version());
  bytes.resize(84, '\0');
  std::memcpy(bytes.data() + 80, &triangles, sizeof triangles);
  return bytes;
}

}  // namespace

std::vector<std::string> write_stl(const Scene& scene, const std::filesystem::path& path) {
  const std::vector<Instance> shown = instances(scene);
  std::size_t count = 0;
  for (const Instance& instance : shown) count += scene.parts[instance.part].mesh.triangles.size();
  if (count > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(fmt::format("write_stl: {} triangles are more than STL can hold", count));
  constexpr std::uintmax_t k_head = 84, k_record = 50;
  write_atomically(
      path,
      [&](std::ostream& out) {
        out << header(static_cast<std::uint32_t>(count));
        RecordWriter records(out);
        for (const Instance& instance : shown) records.write(place(scene, instance));
        records.flush();
      },
      k_head + k_record * count);
  return scene_losses(scene, {});
}

}  // namespace papilla
