// SPDX-License-Identifier: MIT
#pragma once

#include "json_value.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla {

/// "unwrap" of MATERIALS.json: a word, or an object with a method, its options and the direction of the grain.
void read_unwrap(const JsonValue& value, MaterialRule& rule);

}  // namespace papilla
