// SPDX-License-Identifier: MIT
#include "papilla/core/random_token.hpp"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "papilla/core/error.hpp"

namespace papilla {

std::string random_token() {
  constexpr std::string_view k_hex = "0123456789abcdef";
  std::array<unsigned char, k_random_token_bytes> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw IoError("random numbers of the system: " + std::generic_category().message(errno));
  std::string token;
  for (const unsigned char byte : bytes) (token += k_hex[byte >> 4U]) += k_hex[byte & 0xfU];
  return token;
}

}  // namespace papilla
