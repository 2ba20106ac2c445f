// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace papilla::procedural_detail {

using Rgb = std::array<double, 3>;

/// The names of the X Window System, sorted.
std::vector<std::string_view> colour_names();

/// The colour of that name, in lower case, or nothing.
std::optional<Rgb> named_colour(std::string_view name) noexcept;

}  // namespace papilla::procedural_detail
