// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// The triangles of a part that show one material, as the part's first instance stands.
struct SurfaceGroup {
  std::uint32_t part = 0, node = 0, slot = 0, material = 0;
  double area_m2 = 0;
  Bounds3 box_m;  ///< In the frame of the glTF file.
};

/// All of a scene, in the order of the first instances. Cost: one pass over the triangles.
std::vector<SurfaceGroup> surface_groups(const Scene& scene);

}  // namespace papilla
