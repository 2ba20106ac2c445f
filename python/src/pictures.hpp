// SPDX-License-Identifier: MIT
#pragma once

#include "papilla/io/rgba_image.hpp"
#include "papilla/procedural/library.hpp"
#include "papilla/procedural/texture.hpp"
#include "papilla/texture/height_grid.hpp"
#include "papilla/texture/height_map.hpp"
#include "papilla/texture/image.hpp"
#include "record.hpp"

/// The classes that are no plain structs, for whoever has them as arguments or fields.
namespace papilla::python {

template <>
struct IsBoundClass<GreyImage> : BoundByHand<true> {};
template <>
struct IsBoundClass<ColorImage> : BoundByHand<true> {};
template <>
struct IsBoundClass<RgbaImage> : BoundByHand<true> {};
template <>
struct IsBoundClass<LinearImage> : BoundByHand<true> {};
template <>
struct IsBoundClass<HeightMap> : BoundByHand<true> {};
template <>
struct IsBoundClass<HeightGrid> : BoundByHand<true> {};
template <>
struct IsBoundClass<RecipeLibrary> : BoundByHand<false> {};
template <>
struct IsBoundClass<ProceduralTexture> : BoundByHand<false> {};

}  // namespace papilla::python
