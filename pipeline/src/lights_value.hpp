// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "json_value.hpp"
#include "papilla/pipeline/stereo_file.hpp"

namespace papilla {

/// What LIGHTS.json holds, as read_lights() reads it.
StereoLights lights_of_value(const JsonValue& value, std::size_t photographs);

/// What REF.json holds, as read_references() reads it. @param source  the file: profiles are looked for beside it.
std::vector<HeightReference> references_of_value(const JsonValue& value, const std::filesystem::path& source);

}  // namespace papilla
