// SPDX-License-Identifier: MIT
#pragma once

namespace papilla::procedural_detail {

/// Whether a dot of the 5 x 7 raster face is set; nothing is set outside of it and for characters beyond ASCII.
bool glyph_dot(char character, int column, int row) noexcept;

}  // namespace papilla::procedural_detail
