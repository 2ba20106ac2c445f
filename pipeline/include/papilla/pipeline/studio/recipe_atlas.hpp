// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "papilla/meshing/stain_transport.hpp"
#include "papilla/pipeline/studio/shown_mesh.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "papilla/procedural/texture.hpp"

namespace papilla {

struct MaterialSurface;

/// A surface laid out for recipes that look at the same of it: what of the surface each texel of a picture shows. Made
/// by StudioScene::recipe_atlas(), painted by recipe_looks().
struct RecipeAtlas {
  ShownMesh mesh;  ///< The surface as it is shown, at the coordinates of the picture, which repeats.
  std::shared_ptr<const MaterialSurface> surface;
  std::shared_ptr<const StainField> stains;  ///< Null: the recipes do not read `flow`.
};

/// What StudioScene::recipe_atlas() makes depends on this text alone: on the surface with its material but for the
/// recipe, what the recipe looks at (position, sky, flow, directions of dirt), and the side.
std::string recipe_atlas_key(const StudioWish& wish, const ProceduralTexture& texture, int side);

}  // namespace papilla
