// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/vector_option.hpp"

#include <array>
#include <charconv>

#include "exit_code.hpp"

namespace papilla::app {

Vec3 parse_vector(const std::string& option, const std::string& text) {
  std::array<double, 3> values{};
  const char *position = text.data(), *end = text.data() + text.size();
  bool good = true;
  for (std::size_t i = 0; i < values.size() && good; ++i) {
    const auto [next, error] = std::from_chars(position, end, values[i]);
    const bool last = i + 1 == values.size();
    good = error == std::errc() && (last ? next == end : next != end && *next == ',');
    position = next + (last ? 0 : 1);
  }
  const Vec3 vector{values[0], values[1], values[2]};
  if (!good || !is_finite(vector)) throw UsageError(option + ": '" + text + "' is not three numbers X,Y,Z");
  return vector;
}

}  // namespace papilla::app
