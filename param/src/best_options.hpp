// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "multilevel_map.hpp"
#include "papilla/param/best.hpp"

namespace papilla::param_detail {

/// @throws InvalidInput, in the name of `function`, for options out of range.
void check_best_options(const BestOptions& options, std::string_view function);

MultilevelOptions multilevel_options(const BestOptions& options);

}  // namespace papilla::param_detail
