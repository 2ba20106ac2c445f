// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "json_value.hpp"
#include "papilla/pipeline/object_texture_rules.hpp"

namespace papilla {

/// An entry of "decals" of a file; pictures are relative to it. @throws InvalidInput naming the place.
DecalRule read_decal(const JsonValue& value, const std::filesystem::path& source);

/// An entry of "replace". @throws InvalidInput naming the place.
CarrierRule read_carrier(const JsonValue& value, const std::filesystem::path& source);

}  // namespace papilla
