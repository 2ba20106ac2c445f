// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_accessor.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::gltf {

/// Turns the meshes of a document into the parts of a scene, in the same order.
/// Adds a default material when a primitive names none. `scene.materials` must have been read.
void read_parts(const Document& document, AccessorReader& reader, Scene& scene);

}  // namespace papilla::gltf
