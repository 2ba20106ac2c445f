// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace papilla::io_detail {

/// Brightness over stored grey of an ICC profile: CIE Y of R = G = B = i / 1024, or of grey, over that of white, by the
/// relative colorimetric intent. Never falls, ends at 1. Empty when there is no such curve: the bytes are no profile,
/// or one of another kind of picture, or its curve falls.
/// @param colours of a pixel: 3 or 1.
std::vector<float> profile_curve(std::span<const std::byte> profile, int colours);

/// The ICC profile of a grey picture with that curve, at least two values at equal steps; the same curve gives the same
/// bytes.
std::vector<std::byte> profile_of_curve(const std::vector<float>& curve);

}  // namespace papilla::io_detail
