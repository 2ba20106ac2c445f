// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "papilla/io/scene.hpp"

namespace papilla::test {

/// An oblong plate of 64 x 40 mm in the plane of two axes that are turned about all three, away from the origin.
struct TurnedPlate {
  static constexpr double k_width = 64, k_height = 40;
  Vec3 right, up, normal, origin{310, -120, 80};

  TurnedPlate() {
    const double a = 0.7, b = 0.4, c = -0.5;
    const auto turned = [&](Vec3 p) {
      p = {p.x, p.y * std::cos(c) - p.z * std::sin(c), p.y * std::sin(c) + p.z * std::cos(c)};
      p = {p.x * std::cos(b) + p.z * std::sin(b), p.y, -p.x * std::sin(b) + p.z * std::cos(b)};
      return Vec3{p.x * std::cos(a) - p.y * std::sin(a), p.x * std::sin(a) + p.y * std::cos(a), p.z};
    };
    right = turned({1, 0, 0}), up = turned({0, 1, 0}), normal = turned({0, 0, 1});
  }

  /// A place on it [mm], from its lower left corner.
  Vec3 at(double x, double y) const { return origin + x * right + y * up; }

  /// As a scene of one part "plate"; with uv of `mm_per_unit` where that is above 0.
  Scene scene(double mm_per_unit = 0) const {
    constexpr int k_columns = 8, k_rows = 5;
    Part part;
    part.name = "plate";
    part.materials = {0};
    for (int j = 0; j <= k_rows; ++j)
      for (int i = 0; i <= k_columns; ++i) {
        const double x = k_width * i / k_columns, y = k_height * j / k_rows;
        part.mesh.positions.push_back(at(x, y));
        if (mm_per_unit > 0) part.mesh.uv.values.push_back({x / mm_per_unit, y / mm_per_unit});
      }
    for (int j = 0; j < k_rows; ++j)
      for (int i = 0; i < k_columns; ++i) {
        const auto low = static_cast<Index>(j * (k_columns + 1) + i), high = low + k_columns + 1;
        part.mesh.triangles.push_back({low, low + 1, high + 1});
        part.mesh.triangles.push_back({low, high + 1, high});
      }
    if (mm_per_unit > 0) part.mesh.uv.indices = part.mesh.triangles;
    Scene scene = single_part_scene(std::move(part), "OBJ");
    scene.materials.resize(1);
    scene.materials[0].name = "plain";
    return scene;
  }
};

}  // namespace papilla::test
