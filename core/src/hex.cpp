// SPDX-License-Identifier: MIT
#include "papilla/core/hex.hpp"

namespace papilla {

std::string hex_digits(std::span<const unsigned char> bytes) {
  constexpr const char* k_digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) (text += k_digits[byte >> 4U]) += k_digits[byte & 0xfU];
  return text;
}

}  // namespace papilla
