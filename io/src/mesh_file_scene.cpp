// SPDX-License-Identifier: MIT
#include "mesh_file_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/srgb.hpp"
#include "papilla/core/unit_name.hpp"
#include "papilla/meshing/mesh_bounds.hpp"

namespace papilla {

Scene unitless_scene(std::string format, const ReadOptions& options, UpAxis convention) {
  const double unit = options.millimetres_per_unit.value_or(1);
  if (!(unit > 0 && unit <= 1e9))
    throw InvalidInput(fmt::format("ReadOptions: millimetres_per_unit = {} is not in (0, 1e9]", unit));
  Scene scene;
  scene.format = std::move(format);
  scene.unit = unit_name(unit);
  scene.millimetres_per_unit = unit;
  scene.up = options.up.value_or(convention);
  return scene;
}

Color color_from_srgb(double r, double g, double b, double alpha) {
  const auto linear = [](double x) { return static_cast<float>(linear_from_srgb(x)); };
  return {linear(r), linear(g), linear(b), static_cast<float>(std::clamp(alpha, 0.0, 1.0))};
}

void warn_of_doubtful_unit(Scene& scene) {
  constexpr double k_doubtful_mm = 10;
  Bounds3 bounds;
  for (const Part& part : scene.parts) bounds.add(bounds_of(part.mesh));
  if (bounds.is_empty() || !(bounds.diagonal() < k_doubtful_mm)) return;
  const Vec3 size = bounds.size();
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
