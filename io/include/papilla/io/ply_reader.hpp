// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/read_options.hpp"

namespace papilla {

/// Reads a PLY 1.0 file, ASCII or binary of either byte order, with properties of any type in any order, as one part.
///
/// Of vertices: x y z, nx ny nz, red green blue alpha (integers are divided by their largest value; sRGB), and texture
/// coordinates s t, u v, texture_u texture_v or texture_s texture_t. Of faces: the list vertex_indices or
/// vertex_index (polygons of any shape are cut into triangles), texcoord (a pair per corner, as MeshLab writes it),
/// texnumber, red green blue alpha. Of tristrips: vertex_indices, −1 starts a new strip. Every "comment TextureFile"
/// becomes a material with that picture. Vertices are not merged.
/// Other properties and elements are listed in `losses`; faces of fewer than three corners, values other than positions
/// that are not finite, and pictures that are missing in `warnings`.
/// Cost: linear in the file's size, quadratic in the corners of a concave polygon; the file's size, and about 60 bytes
/// per triangle. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, line (ASCII) or byte, and reason for
///         everything else.
/// Source: Turk, "The PLY Polygon File Format", 1994.
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace papilla
