// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/texture/image.hpp"

namespace papilla::texture_detail {

/// The picture made to tile from left to right: see prepare_picture(). Narrower by the overlap.
GreyImage cut_across(const GreyImage& image, bool periodic_down);

/// Rows become columns.
GreyImage transposed(const GreyImage& image);

}  // namespace papilla::texture_detail
