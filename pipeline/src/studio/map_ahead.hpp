// SPDX-License-Identifier: MIT
#pragma once

#include "../prepared_bake.hpp"

namespace papilla {

/// Puts into the bake's cache what bake_scene() of a piece will look for there and what does not wait for the grain:
/// its surfaces repaired and mapped. Nothing happens without a cache, or where the rule leaves the size of the grain to
/// its picture. What fails is left to the bake. @param rules  with one material, `rule`, for all.
/// Cost: that of unwrap_part() without align_phase().
void map_ahead(Scene piece, const Materials& rules, const MaterialRule& rule, const BakeOptions& options,
               const WholeScene& whole);

}  // namespace papilla
