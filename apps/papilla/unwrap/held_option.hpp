// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/pipeline/placed_constraints.hpp"

namespace papilla::app {

/// "X,Y,Z=U,V", and "@PART" behind it, as a pin. @throws UsageError quoting the text when it is nothing such.
PlacedPin parse_pin(const std::string& text);

/// "u:X,Y,Z;X,Y,Z...", "v=VALUE:X,Y,Z;...", and "@PART" behind it, as a line of equal u or v.
/// @throws UsageError quoting the text when it is nothing such.
PlacedIsoLine parse_iso_line(const std::string& text);

}  // namespace papilla::app
