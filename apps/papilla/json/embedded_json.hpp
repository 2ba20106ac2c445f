// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "json/json.hpp"

namespace papilla::app {

/// JSON that may stand in a script element: no "<" in it.
inline std::string embedded_json(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

}  // namespace papilla::app
