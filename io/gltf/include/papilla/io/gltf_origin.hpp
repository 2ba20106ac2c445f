// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Where the parts and nodes of a scene stand in the glTF file that they were read from.
struct GltfOrigin {
  /// The triangles of a part that one primitive draws.
  struct Primitive {
    std::uint32_t number = 0;          ///< Within its mesh.
    std::uint32_t slot = 0;            ///< Of Part::materials.
    std::uint32_t first_triangle = 0;  ///< Within the part's mesh.
    std::vector<Triangle> vertices;    ///< Per triangle: numbers of the primitive's vertices.
  };
  struct Part {
    std::uint32_t mesh = 0;  ///< Several parts may name one: write_edited_gltf() then makes copies of it.
    std::vector<std::optional<std::uint32_t>> materials;  ///< By slot; none: the default material.
    std::vector<Primitive> primitives;                    ///< Those that draw triangles.
  };
  /// A use of a part as a coarser level of detail (MSFT_lod), which no node of the scene shows.
  struct Level {
    std::uint32_t node = 0;    ///< Of the file: shows it.
    std::uint32_t part = 0;    ///< Of the scene.
    std::uint32_t finest = 0;  ///< Node of the scene: the first to show the one part that stands there as finest level.
  };
  std::vector<Part> parts;           ///< As Scene::parts.
  std::vector<std::uint32_t> nodes;  ///< As Scene::nodes; of an instance: the node that lists it.
  std::vector<Level> levels;         ///< Of GltfReadOptions::coarser_parts; none where several parts are the finest.
};

}  // namespace papilla
