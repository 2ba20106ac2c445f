// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "papilla/io/read_options.hpp"

namespace papilla {

/// Reads a Wavefront OBJ with its MTL files and pictures.
///
/// Parts: one per object (`o`); in a file without objects one per group (`g`); in a file without either one. `usemtl`
/// gives the material slots, groups within an object the face numbers. Vertices are numbered as in the file (those that
/// a part does not use are left out) and not merged. Polygons of any shape are cut into triangles; negative indices
/// count from the end; indices may point ahead. Numbers have a decimal point whatever the locale. Names may hold spaces
/// and any UTF-8. Six numbers behind `v` are a position and an sRGB colour.
/// Lines, points and free-form geometry are listed in `losses`; missing materials and pictures, faces of fewer than
/// three corners, and colours or normals that are not finite in `warnings`.
/// Cost: linear in the file's size, quadratic in the corners of a concave polygon. Deterministic.
/// @throws IoError when the file can't be read; InvalidInput naming file, line and reason for everything else.
Scene read_obj(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace papilla
