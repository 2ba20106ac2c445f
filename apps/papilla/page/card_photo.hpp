// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/texture/image.hpp"

namespace papilla::app {

/// A photograph as a card shows it: whole pixels averaged to at most 256 on the longer side, a PNG in base64.
std::string card_photo(const ColorImage& photograph);

}  // namespace papilla::app
