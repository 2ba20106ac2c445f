// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace papilla::cad {

/// Checks that the DATA sections of a STEP file (ISO 10303-21) are lists of `#number = ... ;` with closed strings and
/// balanced parentheses, each number given once. The library's parser may loop for ever on others.
/// Cost: one pass over the file, which is held in memory.
/// @throws InvalidInput naming the line; IoError when the file can't be read.
void check_step_syntax(const std::filesystem::path& path);

/// Checks the frame of an IGES file of fixed format: lines of 80 columns, sections S, G, D, P, T in this order,
/// directory entries of two lines of one type each, and their pointers into the parameter section and back. The
/// library's parser may loop or crash on others. Cost: one pass over the file, which is held in memory.
/// @throws InvalidInput naming the line; IoError when the file can't be read.
void check_iges_syntax(const std::filesystem::path& path);

}  // namespace papilla::cad
