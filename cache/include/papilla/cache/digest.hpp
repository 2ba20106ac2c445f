// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace papilla {

/// SHA-256 (FIPS 180-4).
using Digest = std::array<std::uint8_t, 32>;

/// 64 lower-case hexadecimal digits.
std::string to_hex(const Digest& digest);

/// Computes a digest piece by piece, with the processor's own instructions where it has some: a gigabyte and more a
/// second. sha256_hex() of haptic/ is the player's, which is small and a tenth as fast.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void write(const void* data, std::size_t size);
  /// Of all that was written; ends the computation.
  Digest finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Of one run of bytes.
Digest sha256(const void* data, std::size_t size);

}  // namespace papilla
