// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_accessor.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::gltf {

/// EXT_mesh_gpu_instancing: a node that shows its mesh at many places gets a child for every place, and shows nothing
/// itself. Attributes of the instances other than their places are losses.
/// @pre scene.nodes are the document's, in the same order.
/// @throws InvalidInput when the attributes differ in number, or a place is not finite.
void expand_instances(const Document& document, AccessorReader& reader, Scene& scene);

}  // namespace papilla::gltf
