// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "weather/weather_build.hpp"

namespace papilla::app {

struct WeatherLiveOptions {
  int port = 0;          ///< Of the page; 0: any that is free.
  bool no_open = false;  ///< Don't start a browser.
};

/// Serves a page of the scene until SIGINT, SIGTERM or the deadline. Whenever the configuration or a file that it rests
/// on is saved, the materials that change are painted anew and shown; the files are built again when nothing has been
/// saved for a second. An edit that comes while a picture is painted is taken next, in place of all between; it
/// interrupts what takes longer than half a second, but never twice in a row. Mistakes are printed and shown.
/// @param build  as built last. @return the page's address.
/// @throws IoError when the port is taken; Cancelled.
std::string follow_weather(const WeatherBuildOptions& options, const WeatherLiveOptions& live, WeatherBuilder& builder,
                           const VerbContext& context, WeatherBuild& build);

}  // namespace papilla::app
