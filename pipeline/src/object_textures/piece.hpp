// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/core/bounds.hpp"
#include "papilla/pipeline/object_textures.hpp"

namespace papilla {

/// apply_object_textures() of a piece of a scene, with carriers that look as they would in the whole.
/// @param whole  box of that scene.
ObjectTextures apply_to_piece(Scene& piece, const Bounds3& whole, const Materials& rules,
                              const ObjectTexturePlaces& places, const ObjectTextureOptions& options);

}  // namespace papilla
