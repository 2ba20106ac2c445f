// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// New texture coordinates of a triangle of an instance.
struct NewUv {
  std::size_t instance = 0, triangle = 0;
  std::array<Vec2, 3> uv;  ///< As a scene has them, v up.
};

/// A material that an atlas shows.
struct AtlasMaterial {
  std::uint32_t material = 0;
  bool keeps_relief = false;  ///< Its normal map stays on the old coordinates.
};

/// Gives triangles new coordinates on channel 0; the old ones move to channel 1 where it is free. A part whose
/// instances get unlike coordinates is written once for each; levels of detail, which have no such coordinates, are
/// left out and reported as losses. The pictures and the haptic height map of `materials` that lay on channel 0 now lie
/// on channel 1, but for base colour, metallic-roughness, and the normal map of those that do not keep theirs.
/// @param all  instances(scene). @param materials  those that the triangles show.
void set_atlas_uv(Scene& scene, std::span<const Instance> all, std::vector<NewUv> changes,
                  std::span<const AtlasMaterial> materials);

}  // namespace papilla
