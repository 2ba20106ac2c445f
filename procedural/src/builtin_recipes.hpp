// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace papilla::procedural_detail {

/// The library file that comes with the program.
extern const std::string_view k_builtin_recipes;

}  // namespace papilla::procedural_detail
