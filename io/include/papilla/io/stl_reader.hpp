// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/read_options.hpp"

namespace papilla {

/// Reads a binary or ASCII STL. Positions equal in every bit are merged, so the surface is connected where the file's
/// numbers agree; the file's facet normals are ignored, the winding counts. Degenerate triangles are kept.
///
/// A file whose size is 84 + 50·n for the n at byte 80 is binary, whatever its first word; so is a larger one
/// that does not begin with "solid" (a warning reports the surplus). ASCII: keywords in any case, any white space,
/// numbers with a decimal point whatever the locale; every solid becomes a part of its name.
/// Cost: linear, about 0.2 µs and 100 bytes per triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming the file and the triangle that is missing, not
/// finite
///         or (ASCII) the line that can't be understood.
Scene read_stl(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace papilla
