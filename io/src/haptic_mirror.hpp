// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "glb_buffer.hpp"

namespace papilla {

/// Repeats the height maps of haptic tags as MPEG_material_haptic (ISO/IEC DIS 23090-14, second edition; a draft): a
/// material at the root for each tag with a map, its vibrotactileTexture of type High_Resolution with the map's scale
/// and offset in extras, and hapticMaterialIndex on each mesh that wears a single material. The draft holds textures
/// only: constants stay in the tags.
/// @param gltf with materials, meshes and nodes. @param buffer gets the pictures of the maps, each once.
/// @returns what has no place, one sentence each.
std::vector<std::string> mirror_mpeg_haptics(GlbBuffer::Json& gltf, GlbBuffer& buffer);

/// Repeats static and dynamic friction of haptic tags as KHR_physics_rigid_bodies (a draft): a physics material at the
/// root for each tag, and a collider of the node's own mesh on each node that wears a single tagged material. Levels of
/// detail are no colliders.
/// @param not_mirrored gets what has no place, one sentence each.
void mirror_khr_physics(GlbBuffer::Json& gltf, std::vector<std::string>& not_mirrored);

}  // namespace papilla
