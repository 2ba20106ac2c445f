// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"

namespace papilla {

/// The relief over the same rectangle with another number of samples, band-limited: the Fourier series of the
/// relief, cut at the lower of the two Nyquist frequencies, is evaluated at the new sample centres. A periodic relief
/// stays exactly periodic; others are continued by reflection. Waves that both grids resolve keep amplitude and
/// place; shorter ones are removed, not aliased. Steep edges ring by up to 9 % of their height.
/// Cost: one FFT of each size (four times the samples for reliefs that are not periodic). Deterministic.
/// @param width,height new number of samples, 1 to 16384.
/// @throws InvalidInput when the relief is empty or not finite or a size is out of range.
HeightMap resample(const HeightMap& relief, int width, int height);

/// The `width` × `height` pixels from (left, top) on, with pitch and bits of the picture.
/// Cost: O(pixels of the part). @throws InvalidInput when the part is empty or not within the picture.
GreyImage crop(const GreyImage& image, int left, int top, int width, int height);

/// The middle of a picture, at most `most_side` pixels a side; the picture itself when it is no larger.
/// @throws InvalidInput when the picture is empty or most_side below 1.
GreyImage middle_part(const GreyImage& image, int most_side);

}  // namespace papilla
