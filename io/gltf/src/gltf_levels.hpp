// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_document.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::gltf {

/// Leaves out the coarser levels of detail (MSFT_lod): the nodes that a node lists as its lower levels, what stands
/// below them, the parts that only they show, and the screen coverages in the node's extras. Noted in Scene::losses.
/// @throws InvalidInput when a list names its own node or one that does not exist.
void keep_finest_levels(const Document& document, Scene& scene);

}  // namespace papilla::gltf
