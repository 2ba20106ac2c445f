// SPDX-License-Identifier: MIT
#include "papilla/core/random_token.hpp"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "papilla/core/error.hpp"
#include "papilla/core/hex.hpp"

namespace papilla {

std::string random_token() {
  std::array<unsigned char, k_random_token_bytes> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw IoError("random numbers of the system: " + std::generic_category().message(errno));
  return hex_digits(bytes);
}

}  // namespace papilla
