// SPDX-License-Identifier: MIT
#include "papilla/core/plain_number.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace papilla {

std::string plain_number(double value) {
  const double size = std::abs(value);
  const bool plain = size == 0 || (size >= 1e-6 && size <= 1e12);
  std::array<char, 64> text{};
  const auto written = std::to_chars(text.data(), text.data() + text.size(), value,
                                     plain ? std::chars_format::fixed : std::chars_format::general);
  return {text.data(), written.ptr};
}

}  // namespace papilla
