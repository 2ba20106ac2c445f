// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "papilla/texture/fractal.hpp"
#include "papilla/texture/image.hpp"
#include "papilla/texture/shape_from_shading.hpp"

namespace papilla {

/// An estimator of the fractal dimension of a picture.
struct FractalMethod {
  const char* name;
  int least_side;  ///< Of the picture, in pixels.
  /// Empty where the method finds no dimension of a surface.
  std::optional<FractalEstimate> (*estimate)(const GreyImage&);
};

/// All estimators, those of the literature first.
std::span<const FractalMethod> fractal_methods();

/// A method of shape from shading.
struct ShadingMethod {
  const char* name;
  ShadingResult (*solve)(const GreyImage&, const ShadingOptions&);
  bool iterates;
};

/// All methods.
std::span<const ShadingMethod> shading_methods();

}  // namespace papilla
