// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "papilla/cache/stage_cache.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"

namespace papilla {

/// Keys of what a bake remembers, for plans: what will be found.
/// @throws as make_grain() for recipes that can't be compiled.
Digest grain_key(const MaterialRule& rule, const RecipeLibrary& library);
Digest uv_key(const TriangleMesh& mesh, PartContext context, const UnwrapOptions& options);

/// The grain that make_grain() would find.
std::optional<Grain> find_grain(const MaterialRule& rule, const RecipeLibrary& library, const StageCache& cache);

}  // namespace papilla
