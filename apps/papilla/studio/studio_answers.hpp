// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

PageAnswer json_answer(const Json& json);
PageAnswer bytes_answer(const char* type, SharedText bytes);
/// A JSON text with bytes behind it: the text's length in four bytes, least first; the text, blanks up to a multiple of
/// four; the bytes, whose places the text tells.
SharedText framed(const Json& json, const std::string& bytes);
std::string text_of(const std::vector<std::byte>& bytes);

/// Of a query. @throws InvalidInput when it is missing, or no whole number of at most nine digits.
const std::string& required(const Query& query, const char* name);
std::uint32_t number_of(const Query& query, const char* name);

/// A body. @throws InvalidInput when it is no JSON.
Json parsed(const std::string& body);

}  // namespace papilla::app
