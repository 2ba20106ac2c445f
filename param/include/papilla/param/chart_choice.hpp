// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace papilla {

/// How a chart was mapped, where the method has several ways to do it.
struct ChartChoice {
  std::uint32_t chart = 0;  ///< Number in the chart set that was given.
  std::string method;       ///< Of automatic "exact", "planar" or "best"; of others their name and what of it was done.
  std::string reason;       ///< One line, with the number that decided.
};

}  // namespace papilla
