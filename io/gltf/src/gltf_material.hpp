// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_accessor.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::gltf {

/// Copies images, textures and materials of a document to a scene, in the same order.
void read_materials(const Document& document, AccessorReader& reader, Scene& scene);

}  // namespace papilla::gltf
