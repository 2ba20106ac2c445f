// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/read_options.hpp"

namespace papilla {

/// Reads an OFF file of Geomview, ASCII or binary (big endian), as one part: [ST][C][N]OFF with normals, colours (three
/// or four numbers; integers are divided by 255; sRGB) and texture coordinates of vertices, polygons of any shape, and
/// colours of faces. The keyword may be missing; "#" begins a comment; numbers have a decimal point whatever the
/// locale. Vertices are not merged. Numbers of a colour map are listed in `losses`; faces of fewer than three corners,
/// and values other than positions that are not finite in `warnings`. Cost: linear in the file's size, quadratic in the
/// corners of a concave polygon; the file's size, and about 60 bytes per triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, line (ASCII) or byte, and reason for
///         everything else, also for points of another dimension than three (4OFF, nOFF).
/// Source: Geomview manual, "OFF Files", http://www.geomview.org/docs/html/OFF.html
Scene read_off(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace papilla
