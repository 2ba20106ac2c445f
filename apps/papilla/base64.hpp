// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace papilla::app {

/// The bytes in base64 with padding, without line breaks (RFC 4648, section 4).
std::string base64(std::span<const std::byte> bytes);

}  // namespace papilla::app
