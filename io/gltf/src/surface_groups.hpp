// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "papilla/core/bounds.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/io/tag_manifest.hpp"

namespace papilla {

/// The triangles of a part that show one material, as the part's first instance stands.
struct SurfaceGroup {
  std::uint32_t part = 0, node = 0, slot = 0, material = 0;
  double area_m2 = 0;
  Bounds3 box_m;  ///< In the frame of the glTF file.
};

/// Calls use(slot, corners) for each triangle of a part, in millimetres, in the frame of the part.
using UseTriangle = std::function<void(std::uint32_t slot, const std::array<Vec3, 3>& corners)>;
using PartTriangles = std::function<void(std::uint32_t part, const UseTriangle& use)>;

/// All of a scene, in the order of the first instances. Cost: one pass over the triangles.
std::vector<SurfaceGroup> surface_groups(const Scene& scene, const PartTriangles& triangles);

/// Those of the parts' meshes. @pre `scene` outlives the result.
PartTriangles mesh_triangles(const Scene& scene);

/// As of tag_manifest.hpp, with triangles that are elsewhere than in the parts' meshes.
TagManifest tag_manifest(const Scene& scene, const PartTriangles& triangles);
TagSurvival restore_tags(Scene& scene, const TagManifest& manifest, const PartTriangles& triangles);

}  // namespace papilla
