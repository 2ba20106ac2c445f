// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "json/json.hpp"
#include "papilla/io/scene.hpp"

namespace papilla::app {

bool is_shown_by_browsers(const EncodedImage& image);

/// The picture of a texture as the pages read it, or null where there is none that browsers show: not KTX2, and of the
/// two channels that a mesh has.
Json texture_json(const Scene& scene, const std::optional<TextureReference>& reference);

/// A tag without the bytes of its pictures, which travel on their own.
Json tag_json(MaterialTag tag);

/// Name, colours and pictures of a material of the scene as the pages read them.
Json look_json(const Scene& scene, const Material& material);

}  // namespace papilla::app
