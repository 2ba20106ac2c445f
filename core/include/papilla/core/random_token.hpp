// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace papilla {

constexpr std::size_t k_random_token_bytes = 16;

/// 128 bits from the system's random numbers as 32 lower-case hexadecimal digits: a name that nobody can guess.
/// @throws IoError when the system gives none.
std::string random_token();

}  // namespace papilla
