// SPDX-License-Identifier: MIT
#include "papilla/core/unit_name.hpp"

#include <array>
#include <charconv>
#include <utility>

namespace papilla {

std::string unit_name(double millimetres) {
  static constexpr std::array<std::pair<double, const char*>, 7> k_units = {
      {{1e-3, "um"}, {1, "mm"}, {10, "cm"}, {1000, "m"}, {25.4, "in"}, {304.8, "ft"}, {1e6, "km"}}};
  for (const auto& [length, name] : k_units)
    if (length == millimetres) return name;
  std::array<char, 32> digits{};
  const auto written = std::to_chars(digits.begin(), digits.end(), millimetres);
  return std::string(digits.begin(), written.ptr) + " mm";
}

}  // namespace papilla
