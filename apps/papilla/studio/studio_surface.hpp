// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "http/page_server.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"

namespace papilla::app {

/// A short name for a text of any length: 16 hexadecimal digits of its SHA-256.
std::string short_name(const std::string& text);

/// A surface as the page gets it: the length of a JSON text in four bytes, least first, the text, blanks up to a
/// multiple of four, and the arrays whose places ("at" in bytes, "count" of numbers) the text tells: positions [mm],
/// normals, uv with v downwards, measured, seams as 32-bit floats, indices as 32-bit integers.
SharedText surface_bytes(const StudioSurface& surface);

}  // namespace papilla::app
