// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap/held_option.hpp"

#include <charconv>
#include <cmath>

#include "exit_code.hpp"
#include "vector_option.hpp"

namespace papilla::app {
namespace {

/// Cuts "@PART" off the end.
std::string take_part(std::string& text) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos) return {};
  std::string part = text.substr(at + 1);
  text.erase(at);
  return part;
}

bool read_number(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end && std::isfinite(value);
}

}  // namespace

PlacedPin parse_pin(const std::string& text) {
  PlacedPin pin;
  std::string rest = text;
  pin.part = take_part(rest);
  const std::size_t equals = rest.find('='), comma = rest.find(',', equals);
  if (equals == std::string::npos || comma == std::string::npos ||
      !read_number(rest.substr(equals + 1, comma - equals - 1), pin.uv.x) ||
      !read_number(rest.substr(comma + 1), pin.uv.y))
    throw UsageError("--pin '" + text + "': expected X,Y,Z=U,V or X,Y,Z=U,V@PART");
  pin.position = parse_vector("--pin", rest.substr(0, equals));
  return pin;
}

PlacedIsoLine parse_iso_line(const std::string& text) {
  const auto refuse = [&]() -> PlacedIsoLine {
    throw UsageError("--iso-line '" + text +
                     "': expected u:X,Y,Z;X,Y,Z or v=VALUE:X,Y,Z;X,Y,Z, with two points or more, and @PART behind it");
  };
  PlacedIsoLine line;
  std::string rest = text;
  line.part = take_part(rest);
  const std::size_t colon = rest.find(':');
  if (colon == std::string::npos || (rest[0] != 'u' && rest[0] != 'v')) return refuse();
  line.is_u = rest[0] == 'u';
  if (colon > 1) {
    double value = 0;
    if (rest[1] != '=' || !read_number(rest.substr(2, colon - 2), value)) return refuse();
    line.value = value;
  }
  for (std::size_t begin = colon + 1; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find(';', begin), rest.size());
    line.points.push_back(parse_vector("--iso-line", rest.substr(begin, end - begin)));
    begin = end + 1;
  }
  return line.points.size() < 2 ? refuse() : line;
}

}  // namespace papilla::app
