// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "json/json.hpp"
#include "papilla/pipeline/studio/studio_document.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"

namespace papilla::app {

/// A change as a page asks for it: {"kind", "surfaces": [[part, slot], …], "material", "values": {pointer: value},
/// "title"}, of decals {"kind", "decal", "onto", "values", "title"}, of carriers likewise with "carrier": "onto" is the
/// number of a use, whose part alone it is for, or null for all parts.
/// @param scene null: there is none. @throws InvalidInput for a kind or a surface that is none; Json::exception.
StudioEdit edit_of(const Json& json, const StudioScene* scene);

}  // namespace papilla::app
