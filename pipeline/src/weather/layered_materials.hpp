// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/weather_scene.hpp"

namespace papilla {

/// A scene each of whose materials has the same layers wherever it is shown.
struct LayeredScene {
  std::optional<Scene> scene;                      ///< None: the given one is so already.
  std::vector<std::vector<std::uint32_t>> layers;  ///< Of every material, ascending.
  std::vector<RuleUse> uses;                       ///< Of every layer.
};

/// Finds the surfaces that the layers lie on. A material on whose surfaces not the same layers lie gets copies, behind
/// all others; a part whose uses differ in that is split.
/// @throws InvalidInput as instances().
LayeredScene layer_materials(const Scene& scene, const WeatherConfig& config);

}  // namespace papilla
