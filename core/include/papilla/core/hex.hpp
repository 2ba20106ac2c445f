// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

namespace papilla {

/// Two lower-case hexadecimal digits for each byte.
std::string hex_digits(std::span<const unsigned char> bytes);

}  // namespace papilla
