// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "json/json.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/procedural/library.hpp"
#include "studio/studio_atlases.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

/// Recipes while they are being written: docs/studio.md has requests and answers. Nothing here changes the document.
/// Places in texts are counted in UTF-16 units, as pages count.
class StudioRecipe {
 public:
  struct Handlers {
    const RecipeLibrary& library;
    std::function<std::filesystem::path()> folder;  ///< Of the document.
    /// A material of the document as it is now; nothing when there is none of that name.
    std::function<std::optional<MaterialRule>(const std::string& material)> rule;
    StudioAtlases& atlases;
  };
  explicit StudioRecipe(Handlers handlers) : handlers_(std::move(handlers)) {}

  /// {"types": {name: {"note", "parameters": [{"name", "kind", "low", "high", "preset", "note"}]}}, "common": the same
  /// list, "recipes": {name: text}}.
  Json language() const;
  /// {"text", "time"} of a material. @throws InvalidInput when it has no recipe.
  Json recipe_of(const std::string& material) const;
  /// What a text is and looks like on a material: {"problem", "textures", "uses_time", "needs_atlas", "cancelled",
  /// "look", "surfaces", "under_way"}. A newer request ends one that runs.
  SharedText look(const Json& wanted);
  Json completions(const Json& wanted) const;
  /// A text with a layer moved, inserted or removed. @throws InvalidInput as those of recipe_outline.hpp.
  Json layers(const Json& wanted) const;
  SharedText pictures(const Json& wanted) const;
  SharedText mutations(const Json& wanted) const;

 private:
  /// Of a recipe on the surfaces of a material, where it or that of the document reads them.
  Json looks_on_surfaces(const Json& wanted, const MaterialRule& rule, const ProceduralTexture& tiling, Json& answer,
                         const ProgressCallback& progress, std::string& pixels) const;
  /// Whether the surfaces of a material are shown with an atlas.
  bool has_atlases(const MaterialRule& rule) const;

  Handlers handlers_;
  std::atomic<std::uint64_t> newest_{0};
  mutable std::mutex picture_mutex_;  ///< One list of pictures after the other: looks go before.
};

void add_recipe_routes(StudioRoutes& routes, StudioRecipe& recipe);

}  // namespace papilla::app
