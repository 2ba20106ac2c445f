// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace papilla::gltf {

/// The first member without which tinygltf takes no file and that the text lacks or has otherwise, for messages:
/// "accessors[3].componentType is missing". Empty when there is none.
std::string find_missing_member(const nlohmann::ordered_json& document);

}  // namespace papilla::gltf
