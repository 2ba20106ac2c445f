// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace papilla {

/// The bytes in base64 with padding, without line breaks [RFC 4648, section 4].
std::string encode_base64(std::span<const std::byte> bytes);

/// The inverse; padding may be missing. Nothing when a character is not base64.
std::optional<std::string> decode_base64(std::string_view text);

/// The bytes of a base64 data: URI [RFC 2397]; nothing when it is none or its text is not base64.
std::optional<std::string> decode_data_uri(std::string_view uri);

}  // namespace papilla
