// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

/// The solids of an ASCII STL, one part each.
/// @param file  what messages call it.
/// @throws InvalidInput as read_stl().
std::vector<Part> read_ascii_stl(std::string_view text, const std::string& file, double unit,
                                 std::vector<std::string>& warnings);

}  // namespace papilla
