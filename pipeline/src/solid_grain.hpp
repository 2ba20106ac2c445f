// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "papilla/pipeline/grain.hpp"
#include "papilla/procedural/texture.hpp"
#include "surface/painted_surface.hpp"

namespace papilla {

/// The grain of a surface that the rule's recipe was painted on.
/// @param tile  make_grain() of the rule, whose size one repeat has. @param name  of its pictures.
Grain solid_grain(const MaterialRule& rule, const Grain& tile, PaintedSurface painted, const std::string& name);

}  // namespace papilla
