// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/pipeline/unwrap_scene.hpp"

namespace papilla {

/// The stages of unwrap_part() that other grain leaves as they are, into the cache of the options.
/// @pre options.method.cache. @throws as unwrap_part().
void unwrap_ahead(TriangleMesh mesh, const PartContext& context, const UnwrapOptions& options);

}  // namespace papilla
