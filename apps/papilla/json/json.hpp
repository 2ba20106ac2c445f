// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "json_text.hpp"

namespace papilla::app {

/// Keeps the order in which keys are written.
using Json = nlohmann::ordered_json;

}  // namespace papilla::app
