// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace papilla {

/// The bytes of a base64 data: URI [RFC 2397, RFC 4648], with or without padding; nothing when it is none, or holds
/// characters that are not base64.
std::optional<std::string> decode_data_uri(std::string_view uri);

}  // namespace papilla
