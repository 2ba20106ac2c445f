// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "http/page_server.hpp"
#include "papilla/pipeline/studio/shown_levels.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"

namespace papilla::app {

/// A short name for a text of any length: 16 hexadecimal digits of its SHA-256.
std::string short_name(const std::string& text);

/// A surface as the page gets it: the length of a JSON text in four bytes, least first, the text, blanks up to a
/// multiple of four, and the arrays whose places ("at" in bytes, "count" of numbers) the text tells: positions [mm],
/// normals, uv with v downwards, uv1 where the haptic tag lies on those, measured, seams as 32-bit floats, indices as
/// 32-bit integers.
SharedText surface_bytes(const StudioSurface& surface);

/// Positions, normals, uv and indices likewise: {"arrays"}.
SharedText mesh_bytes(const ShownMesh& mesh);

/// Coarser levels of a surface: framed(), the text {"levels": [{"coverage", "at", "count"}, …]}, finest first, of their
/// indices as 32-bit integers.
SharedText level_bytes(const std::vector<ShownLevel>& levels);

/// A decal likewise: {"patches": [what is said of a surface, and "use"], "area_mm2", "triangles", "relief_mm",
/// "turned_off", "warnings"}.
SharedText decal_bytes(const StudioDecal& decal);

/// Carriers likewise: {"rectangles": [what is said of a surface, "world", and "use" or null], "entries": [{"carriers",
/// "triangles", "saved", "relief_mm"}], "warnings"}.
SharedText carrier_bytes(const StudioCarriers& carriers);

/// A picture of a look. @throws InvalidInput when there is none of that number.
PageAnswer picture_answer(const Scene& look, std::size_t number);

/// The PNG of the height map that a surface's tag names. @param file of the scene: maps beside it are found from here.
/// @throws InvalidInput when there is none, as find_height_bytes().
SharedText height_bytes(const StudioSurface& surface, const std::filesystem::path& file);

}  // namespace papilla::app
