// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "json_value.hpp"

namespace papilla {

/// read_json() of a text. @param name stands for the file in messages. @throws InvalidInput as read_json().
JsonValue::Json parse_json(const std::string& text, const std::string& name);

}  // namespace papilla
