// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "json/json.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla::app {

/// What a page shows of a material's grain: grain_json() with "photo" (card_photo()), "relief" {width, height, size_mm,
/// mm: the heights of blocks of samples, at most 192 a side, as 32-bit floats in base64}, "doubts" (grain_doubts()),
/// and "depth_mm", "rms_mm" of all samples.
Json card_json(const MaterialRule& rule, const Grain& grain);

}  // namespace papilla::app
