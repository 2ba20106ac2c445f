// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/io/scene.hpp"

namespace papilla {

inline constexpr std::size_t k_stl_header_size = 84, k_stl_record_size = 50;

/// The number of triangles that a binary STL's first 84 bytes promise.
std::uint64_t stl_declared_triangles(std::string_view head);

/// Reads a binary STL in blocks, so that the file is never in memory as a whole.
/// @param head  the file's first bytes, at least the header when the file is that long.
/// @param size  of the file.
/// @throws IoError, InvalidInput as read_stl().
Part read_binary_stl(const std::filesystem::path& path, std::string_view head, std::uint64_t size, double unit,
                     std::vector<std::string>& warnings);

}  // namespace papilla
