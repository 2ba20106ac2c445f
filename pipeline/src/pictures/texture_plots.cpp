// SPDX-License-Identifier: MIT
#include "pictures/texture_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/units.hpp"

namespace papilla {
namespace {

using Style = PlotSeries::Style;

/// Heights along the middle row or column, thinned to about 2000.
std::vector<Vec2> profile(const HeightMap& map, bool row) {
  const int count = row ? map.width : map.height, fixed = row ? map.height / 2 : map.width / 2;
  const double pitch = row ? map.pitch_mm_x : map.pitch_mm_y;
  std::vector<Vec2> points;
  const int step = std::max(1, count / 2000);
  for (int i = 0; i < count; i += step)
    points.push_back(
        {(i + 0.5) * (pitch > 0 ? pitch : 1), static_cast<double>(row ? map.at(i, fixed) : map.at(fixed, i))});
  return points;
}

}  // namespace

Plot log_log_plot(std::span<const FractalReading> readings) {
  Plot plot{.title = "Fractal dimension, 95 % interval",
            .x_name = "scale: side, window or lag [pixels]",
            .y_name = "measure, relative to that at the least scale",
            .log_x = true,
            .log_y = true,
            .log_x_base = 2};
  for (const FractalReading& reading : readings) {
    if (!reading.curve) continue;
    const FractalEstimate* e = reading.estimate;
    PlotSeries drawn{reading.has_dimension()
                         ? fmt::format("{}: D = {:.3f} [{:.3f}, {:.3f}]", reading.name, e->dimension, e->low, e->high)
                         : fmt::format("{}: no dimension", reading.name),
                     {}};
    drawn.look = static_cast<int>(plot.series.size());
    double first = 0;
    for (const ScalePoint& point : *reading.curve) {
      if (!(point.scale > 0 && point.measure > 0)) continue;
      if (first == 0) first = point.measure;
      drawn.points.push_back({point.scale, point.measure / first});
    }
    plot.series.push_back(std::move(drawn));
  }
  return plot;
}

Plot hurst_plot(const FshotSignature& signature) {
  Plot plot{.title = fmt::format("Hurst exponent by direction: Sta {:.3f}, Str {:.3f} at {:.0f}°", signature.sta,
                                 signature.str, signature.angle_deg),
            .polar = true,
            .radius = 1.2};
  plot.width_px = plot.height_px = 520;
  PlotSeries measured{"", {}, Style::points, 0}, ellipse{"", {}, Style::line, 1};
  for (const DirectionalHurst& d : signature.directions)
    for (const double turn : {0.0, 180.0})
      measured.points.push_back({d.angle_deg + turn, std::clamp(d.hurst, 0.0, 1.2)});
  if (signature.str > 0 && signature.sta > 0) {
    const double minor = signature.sta, major = signature.sta / signature.str;
    for (int angle = 0; angle <= 360; ++angle) {
      const double from_minor = (angle - signature.angle_deg) * k_radians_per_degree;
      ellipse.points.push_back(
          {1.0 * angle, 1 / std::hypot(std::cos(from_minor) / minor, std::sin(from_minor) / major)});
    }
  }
  plot.series = {std::move(measured), std::move(ellipse)};
  return plot;
}

Plot section_plot(const HeightMap& map) {
  Plot plot{.title = "Height along the middle",
            .x_name = map.pitch_mm_x > 0 ? "position [mm]" : "position [pixels]",
            .y_name = "height [mm]"};
  plot.series = {{"row", profile(map, true), Style::line, 0}, {"column", profile(map, false), Style::line, 1}};
  return plot;
}

}  // namespace papilla
