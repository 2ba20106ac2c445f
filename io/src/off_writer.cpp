// SPDX-License-Identifier: MIT
#include "papilla/io/mesh_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "flat_mesh.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"

namespace papilla {
namespace {

double finite(double value) {
  if (!std::isfinite(value)) throw InvalidInput(fmt::format("write_off: {} is not finite", value));
  return value;
}

/// A colour channel with a point, so that it is not taken for an integer.
std::string channel(double linear) { return fmt::format("{:.6f}", srgb_from_linear(finite(linear))); }

}  // namespace

std::vector<std::string> write_off(const Scene& scene, const std::filesystem::path& path) {
  FlatMesh mesh = flatten(scene);
  mesh.keeps.uv = mesh.triangle_uv.empty();
  mesh.keeps.cad_uv = false;
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}{}{}OFF\n# papilla {}, millimetres\n{} {} 0\n", mesh.uv.empty() ? "" : "ST",
                 mesh.colors.empty() ? "" : "C", mesh.normals.empty() ? "" : "N", version(), mesh.positions.size(),
                 mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = mesh.positions[v];
    fmt::format_to(out, "{} {} {}", p.x, p.y, p.z);
    if (!mesh.normals.empty()) {
      const Vec3 n = mesh.normals[v];
      fmt::format_to(out, " {} {} {}", finite(n.x), finite(n.y), finite(n.z));
    }
    if (!mesh.colors.empty()) {
      const Color c = mesh.colors[v];
      fmt::format_to(out, " {} {} {} {:.6f}", channel(static_cast<double>(c.r)), channel(static_cast<double>(c.g)),
                     channel(static_cast<double>(c.b)), finite(static_cast<double>(c.a)));
    }
    if (!mesh.uv.empty()) fmt::format_to(out, " {} {}", finite(mesh.uv[v].x), finite(mesh.uv[v].y));
    text.push_back('\n');
  }
  for (const Triangle& t : mesh.triangles) fmt::format_to(out, "3 {} {} {}\n", t[0], t[1], t[2]);
  write_atomically(path, {text.data(), text.size()});
  return scene_losses(scene, mesh.keeps);
}

}  // namespace papilla
