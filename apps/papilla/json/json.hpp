// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

namespace papilla::app {

/// Keeps the order in which keys are written.
using Json = nlohmann::ordered_json;

/// Two spaces a level; bytes that are not UTF-8 are replaced.
inline std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace papilla::app
