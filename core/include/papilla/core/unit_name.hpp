// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace papilla {

/// "mm", "in", ... of a length in millimetres, or the number itself followed by " mm".
std::string unit_name(double millimetres);

}  // namespace papilla
