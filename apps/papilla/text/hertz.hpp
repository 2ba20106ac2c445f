// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "shown_format.hpp"

namespace papilla::app {

/// Three digits of a frequency, more before the point: 41.7, 1009.
inline std::string hertz(double hz) { return hz < 1000 ? shown_format("{:.3g}", hz) : shown_format("{:.0f}", hz); }

}  // namespace papilla::app
