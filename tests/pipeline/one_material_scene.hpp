// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <utility>

#include "papilla/io/scene.hpp"

namespace papilla::test {

/// One triangle of a part and material of these names. @param color linear, with alpha.
inline Scene one_material_scene(const std::string& part, const std::string& material,
                                const std::array<double, 4>& color) {
  Part triangle;
  triangle.name = part;
  triangle.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.mesh.triangles = {{0, 1, 2}};
  triangle.materials = {0};
  Scene scene = single_part_scene(std::move(triangle), "test");
  scene.materials.resize(1);
  scene.materials[0].name = material;
  scene.materials[0].base_color = color;
  return scene;
}

}  // namespace papilla::test
