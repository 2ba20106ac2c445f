// SPDX-License-Identifier: MIT
#include "papilla/core/one_line.hpp"

#include <cstdint>
#include <optional>

namespace papilla {
namespace {

constexpr std::string_view k_hex = "0123456789abcdef";

/// A character of UTF-8 and its length in bytes.
struct Character {
  std::uint32_t code;
  std::size_t bytes;
};

/// The first character [RFC 3629]; nothing when the bytes are none.
std::optional<Character> first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < bytes) return std::nullopt;
  std::uint32_t code = lead & (0x7fU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return std::nullopt;
    code = code << 6 | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t k_least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < k_least[bytes] || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return std::nullopt;
  return Character{code, bytes};
}

bool steers(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code <= 0x9f) || code == 0x61c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

std::string escape(std::uint32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\r') return "\\r";
  if (code == '\t') return "\\t";
  std::string text = "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) text += k_hex[code >> shift & 0xfU];
  return text;
}

std::string shown_but(std::string_view text, bool line_feeds_stay) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (!character) {
      const auto byte = static_cast<unsigned char>(text[0]);
      result += "\\x";
      result += k_hex[byte >> 4U];
      result += k_hex[byte & 0xfU];
    } else if (steers(character->code) && !(line_feeds_stay && character->code == '\n')) {
      result += escape(character->code);
    } else {
      result += text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return result;
}

}  // namespace

std::string shown(std::string_view name) { return shown_but(name, false); }

std::string shown_lines(std::string_view text) { return shown_but(text, true); }

}  // namespace papilla
