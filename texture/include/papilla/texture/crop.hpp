// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"

namespace papilla {

/// The `width` × `height` pixels from (left, top) on, with pitch and bits of the picture.
/// Cost: O(pixels of the part). @throws InvalidInput when the part is empty or not within the picture.
GreyImage crop(const GreyImage& image, int left, int top, int width, int height);

/// The middle of a picture, at most `most_side` pixels a side; the picture itself when it is no larger.
/// @throws InvalidInput when the picture is empty or most_side below 1.
GreyImage middle_part(const GreyImage& image, int most_side);

}  // namespace papilla
