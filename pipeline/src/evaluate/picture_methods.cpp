// SPDX-License-Identifier: MIT
#include "evaluate/picture_methods.hpp"

#include <array>
#include <utility>

#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/probability_dimension.hpp"

namespace papilla {
namespace {

std::optional<FractalEstimate> of_surface(FractalEstimate estimate) {
  return estimate.is_of_surface() ? std::optional(std::move(estimate)) : std::nullopt;
}

constexpr std::array<FractalMethod, 6> k_fractal = {
    {{"box", 32, [](const GreyImage& image) { return of_surface(box_dimension(image)); }},
     {"information", 32, [](const GreyImage& image) { return of_surface(information_dimension(image)); }},
     {"correlation", 32, [](const GreyImage& image) { return of_surface(correlation_dimension(image)); }},
     {"probability", 66, [](const GreyImage& image) { return of_surface(probability_dimension(image)); }},
     {"fshot", 32, [](const GreyImage& image) { return of_surface(fshot_dimension(image).estimate); }},
     {"best", 32, [](const GreyImage& image) { return best_dimension(image).estimate; }}}};

constexpr std::array<ShadingMethod, 4> k_shading = {
    {{"wiener",
      [](const GreyImage& image, const ShadingOptions& options) -> ShadingResult {
        return shape_from_shading_wiener(image, options);
      },
      false},
     {"variational", shape_from_shading_variational, true},
     {"pentland", shape_from_shading_pentland, false},
     {"tsai-shah", shape_from_shading_tsai_shah, true}}};

}  // namespace

std::span<const FractalMethod> fractal_methods() { return k_fractal; }

std::span<const ShadingMethod> shading_methods() { return k_shading; }

}  // namespace papilla
