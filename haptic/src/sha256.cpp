// SPDX-License-Identifier: MIT
#include "papilla/haptic/sha256.hpp"

#include <sha2.h>

#include <array>
#include <cstdint>

#include "papilla/core/hex.hpp"

namespace papilla {

std::string sha256_hex(std::span<const std::byte> bytes) {
  SHA2_CTX context;
  SHA256Init(&context);
  SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest{};
  SHA256Final(digest.data(), &context);
  return hex_digits(digest);
}

}  // namespace papilla
