// SPDX-License-Identifier: MIT
#include "mesh_file_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "papilla/core/error.hpp"
#include "unit_name.hpp"

namespace papilla {

Scene unitless_scene(std::string format, const ReadOptions& options, UpAxis habit) {
  const double unit = options.millimetres_per_unit;
  if (!(unit > 0 && unit <= 1e9))
    throw InvalidInput(fmt::format("ReadOptions: millimetres_per_unit = {} is not in (0, 1e9]", unit));
  Scene scene;
  scene.format = std::move(format);
  scene.unit = unit_name(unit);
  scene.millimetres_per_unit = unit;
  scene.up = options.up.value_or(habit);
  return scene;
}

void warn_of_doubtful_unit(Scene& scene) {
  constexpr double k_doubtful_mm = 10;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity}, high = -low;
  for (const Part& part : scene.parts)
    for (const Vec3& p : part.mesh.positions) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  const Vec3 size = high - low;
  if (scene.millimetres_per_unit != 1 || !(norm(size) < k_doubtful_mm)) return;
  scene.warnings.push_back(
      fmt::format("the file states no unit; in millimetres all of it is {:.3g} x {:.3g} x {:.3g}: are these metres?",
                  size.x, size.y, size.z));
}

void add_part_nodes(Scene& scene, const std::string& fallback_name) {
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    Part& part = scene.parts[i];
    if (part.name.empty()) part.name = fallback_name;
    Node node;
    node.name = part.name;
    node.part = i;
    scene.roots.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(std::move(node));
  }
  assign_part_ids(scene);
}

}  // namespace papilla
