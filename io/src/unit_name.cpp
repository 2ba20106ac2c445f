// SPDX-License-Identifier: MIT
#include "unit_name.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>

namespace papilla {

std::string unit_name(double millimetres) {
  static constexpr std::array<std::pair<double, const char*>, 7> k_units = {
      {{1e-3, "um"}, {1, "mm"}, {10, "cm"}, {1000, "m"}, {25.4, "in"}, {304.8, "ft"}, {1e6, "km"}}};
  for (const auto& [length, name] : k_units)
    if (length == millimetres) return name;
  return fmt::format("{} mm", millimetres);
}

}  // namespace papilla
