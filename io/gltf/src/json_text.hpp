// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace papilla::gltf {

using Json = nlohmann::ordered_json;

/// The text's value; is_discarded() when it is no JSON. Texts are parsed as views everywhere: each kind of iterator has
/// a parser of its own, 16 kB of the player.
inline Json json_of(std::string_view text) { return Json::parse(text, nullptr, false); }

/// In one line, with what is no UTF-8 replaced.
inline std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace papilla::gltf
