// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// One series of a plot, in the axes' units. Points that are not finite, and points that are not positive on a
/// logarithmic axis, are left out.
struct PlotSeries {
  enum class Style { line_and_points, line, points, steps, band, bars };
  std::string name;  ///< In the legend; empty: none.
  std::vector<Vec2> points;
  Style style = Style::line_and_points;
  int look = 0;  ///< Series of equal look share colour, dash and mark; 8 colours that differ for every kind of colour
                 ///< vision [Okabe and Ito 2008], then the same ones dashed.
};

/// A text whose upper right corner is at a point in the axes' units.
struct PlotLabel {
  std::string text;
  Vec2 at;
};

/// A plot of any number of series. In polar plots x is the angle in degrees, clockwise from the right, and y the
/// radius.
struct Plot {
  std::string title = {}, x_name = {}, y_name = {};
  bool log_x = false, log_y = false, polar = false;
  double log_x_base = 10;                  ///< 10, or 2 for ticks at powers of two.
  double radius = 0;                       ///< Of a polar plot; 0: from the points.
  std::vector<std::string> x_labels = {};  ///< Instead of numbers: label i at x = i.
  std::vector<PlotSeries> series = {};
  std::vector<PlotLabel> labels = {};
  Vec2 low = {}, high = {};  ///< Ends of both axes; equal: from the points.
  int width_px = 960, height_px = 520;
};

/// The plot as SVG, drawn by gnuplot; nothing when it is not installed or the plot has no point. Names are quoted, so
/// that none can be a command. Deterministic for one version of gnuplot.
/// @throws IoError when the temporary folder can't be written or gnuplot fails.
std::optional<std::string> plot_svg(const Plot& plot);

/// Plots one below the other in one picture as wide as the first and as high as all; those without a point are left
/// out. Otherwise as above.
std::optional<std::string> plot_svg(std::span<const Plot> plots);

/// Writes the plot as SVG. @returns whether there is one. @throws IoError as plot_svg(), and when writing fails.
bool write_plot(const std::filesystem::path& file, const Plot& plot);
bool write_plot(const std::filesystem::path& file, std::span<const Plot> plots);

}  // namespace papilla
