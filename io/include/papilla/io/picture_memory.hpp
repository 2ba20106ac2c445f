// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace papilla {

/// Bytes that a picture may take in memory, with what is computed from it pixel by pixel: half of the machine's memory,
/// or of the control group's where that has a limit, until set_picture_memory(). A picture that takes more is refused
/// before it is decoded, unless it is read in bands. One value for the process, as its memory is.
std::uint64_t picture_memory() noexcept;

/// Sets picture_memory(); 0 sets the default again.
void set_picture_memory(std::uint64_t bytes) noexcept;

}  // namespace papilla
