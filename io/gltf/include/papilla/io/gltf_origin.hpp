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
    std::uint32_t mesh = 0;
    std::vector<std::optional<std::uint32_t>> materials;  ///< By slot; none: the default material.
    std::vector<Primitive> primitives;                    ///< Those that draw triangles.
  };
  std::vector<Part> parts;           ///< As Scene::parts.
  std::vector<std::uint32_t> nodes;  ///< As Scene::nodes; of an instance: the node that lists it.
};

}  // namespace papilla
