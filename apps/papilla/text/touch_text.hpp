// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/pipeline/material_differences.hpp"

namespace papilla::app {

/// Which of the materials nobody tells apart, how the others differ, and what of the reliefs is not felt, with what
/// leaving it out would save. Empty without materials.
std::string touch_text(const TouchReport& report);

}  // namespace papilla::app
