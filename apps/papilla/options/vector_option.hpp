// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/core/vec.hpp"

namespace papilla::app {

/// "X,Y,Z" as a vector. @throws UsageError naming the option when the text is not three finite numbers.
Vec3 parse_vector(const std::string& option, const std::string& text);

}  // namespace papilla::app
