// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "papilla/io/scene.hpp"
#include "papilla/pipeline/weather_scene.hpp"
#include "papilla/texture/image.hpp"

namespace papilla::app {

/// A scene at a time, as a picture.
struct WeatherView {
  double time = 0;
  ColorImage picture;
};

/// The scene seen from the front, above and the right.
ColorImage view_of(const Scene& scene);

/// A self-contained page: the scene before, the scene after with a slider over the times, what was done to each
/// material, the configuration as it was read.
/// @param live  the page reads itself again every two seconds; the slider stays where it is.
std::string weather_page(const std::string& title, const ColorImage& before, const std::vector<WeatherView>& after,
                         const std::vector<WeatheredMaterial>& materials, const std::string& config, bool live);

}  // namespace papilla::app
