// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "papilla/core/one_line.hpp"

namespace papilla::app {

/// Two spaces a level. Bytes that are not UTF-8 are replaced; what could steer a terminal is escaped.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return shown_lines(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

}  // namespace papilla::app
