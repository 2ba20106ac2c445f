// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/child_process.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/temporary_folder.hpp"

namespace papilla {
namespace {

namespace fs = std::filesystem;
using Style = PlotSeries::Style;

constexpr std::array k_colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#6B6B00", "#000000"};
constexpr std::array k_dashes{"1", "2", "3", "4"};

/// A gnuplot string literal without escapes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += '\'';
    out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return out + "'";
}

bool can_be_drawn(const Plot& plot, Vec2 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && !(plot.log_x && p.x <= 0) && !(plot.log_y && p.y <= 0);
}

std::string data_of(const Plot& plot, const PlotSeries& series, std::size_t number) {
  std::string block = fmt::format("$d{} << END\n", number);
  for (const Vec2 p : series.points)
    if (can_be_drawn(plot, p)) block += fmt::format("{:.9g} {:.9g}\n", p.x, p.y);
  return block + "END\n";
}

std::string style_of(const PlotSeries& series) {
  const auto look = static_cast<std::size_t>(std::max(series.look, 0));
  const char* colour = k_colours[look % k_colours.size()];
  const char* dash = k_dashes[look / k_colours.size() % k_dashes.size()];
  const std::size_t mark = 1 + look % 13;
  switch (series.style) {
    case Style::line: return fmt::format("with lines lw 1.5 lc rgb '{}' dt {}", colour, dash);
    case Style::points: return fmt::format("with points pt {} ps 0.5 lc rgb '{}'", mark, colour);
    case Style::steps: return fmt::format("with histeps lw 1.5 lc rgb '{}' dt {}", colour, dash);
    case Style::band: return "with steps lw 7 lc rgb '#cccccc'";
    case Style::bars: return fmt::format("with boxes fs solid 0.7 lc rgb '{}'", colour);
    case Style::line_and_points: break;
  }
  return fmt::format("with linespoints lw 1.5 pt {} ps 0.6 lc rgb '{}' dt {}", mark, colour, dash);
}

bool has_points(const Plot& plot, const PlotSeries& series) {
  return std::any_of(series.points.begin(), series.points.end(), [&](Vec2 p) { return can_be_drawn(plot, p); });
}

/// Range of an axis.
struct Extent {
  double low = INFINITY, high = 0;
  double decades() const { return low < high ? std::log10(high / low) : 0; }
};

Extent extent_of(const Plot& plot, double Vec2::*axis) {
  if (plot.low.*axis < plot.high.*axis) return {plot.low.*axis, plot.high.*axis};
  Extent extent;
  for (const PlotSeries& series : plot.series)
    for (const Vec2 p : series.points)
      if (can_be_drawn(plot, p)) extent = {std::min(extent.low, p.*axis), std::max(extent.high, p.*axis)};
  return extent;
}

/// The number closest to `about` of 1, 2 or 5 times a power of ten.
double round_step(double about) {
  const double power = std::pow(10, std::floor(std::log10(about))), share = about / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

/// Ticks of a logarithmic axis that spans few decades: 1, 2 and 5 times powers of ten, or even steps below 0.8 decades.
std::string few_ticks(const Extent& extent) {
  std::string ticks;
  const auto add = [&](double value) { ticks += fmt::format("{}{:g}", ticks.empty() ? "" : ", ", value); };
  constexpr double k_narrow_decades = 0.8, k_steps = 5;
  if (extent.decades() < k_narrow_decades) {
    const double step = round_step((extent.high - extent.low) / k_steps);
    for (double n = std::ceil(extent.low / step); n * step <= extent.high; ++n) add(n * step);
    return ticks;
  }
  for (double power = std::floor(std::log10(extent.low)); power <= std::log10(extent.high); ++power)
    for (const int multiple : {1, 2, 5}) add(multiple * std::pow(10, power));
  return ticks;
}

/// Commands for a logarithmic axis: powers of ten; plain numbers for base 2 and where it spans few decades.
std::string log_axis(char axis, double base, const Extent& extent) {
  constexpr double k_few_decades = 2;
  std::string script = fmt::format("set logscale {} {:g}\n", axis, base);
  if (base != 10) return script + fmt::format("set format {} '%g'\n", axis);
  if (extent.decades() <= 0 || extent.decades() >= k_few_decades)
    return script + fmt::format("set format {} '10^{{%L}}'\n", axis);
  return script + fmt::format("set format {0} '%g'\nset {0}tics ({1})\n", axis, few_ticks(extent));
}

std::string axes_of(const Plot& plot) {
  std::string script;
  if (plot.log_x) script += log_axis('x', plot.log_x_base, extent_of(plot, &Vec2::x));
  if (plot.log_y) script += log_axis('y', 10, extent_of(plot, &Vec2::y));
  if (plot.polar)
    return script +
           "set polar\nset angles degrees\nset theta right clockwise\nset size square\nset grid polar 30\n"
           "unset border\nunset xtics\nunset ytics\nset rtics\n" +
           (plot.radius > 0 ? fmt::format("set rrange [0:{}]\n", plot.radius) : std::string());
  script += "set grid lc rgb '#dddddd'\nset mytics\nset autoscale xfix\n";
  if (plot.low.x < plot.high.x) script += fmt::format("set xrange [{:.9g}:{:.9g}]\n", plot.low.x, plot.high.x);
  if (plot.low.y < plot.high.y) script += fmt::format("set yrange [{:.9g}:{:.9g}]\n", plot.low.y, plot.high.y);
  for (const PlotLabel& label : plot.labels)
    script += fmt::format("set label {} at {:.9g},{:.9g} right offset -0.3,-0.7 noenhanced front\n", quoted(label.text),
                          label.at.x, label.at.y);
  if (plot.x_labels.empty()) return script;
  script += "set xtics rotate by -40 noenhanced (";
  for (std::size_t i = 0; i < plot.x_labels.size(); ++i)
    script += fmt::format("{}{} {}", i ? ", " : "", quoted(plot.x_labels[i]), i);
  return script +
         fmt::format(")\nset xrange [-0.6:{}]\nset boxwidth 0.7\n", static_cast<double>(plot.x_labels.size()) - 0.4);
}

std::string terminal_of(int width_px, int height_px) {
  return fmt::format(
      "set terminal svg size {},{} dynamic enhanced background 'white' font 'sans-serif,12'\nset encoding utf8\n"
      "set output 'plot.svg'\n",
      width_px, height_px);
}

std::string commands_of(const Plot& plot) {
  std::string script = fmt::format(
      "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n"
      "set key outside right top Left reverse noenhanced\n",
      quoted(plot.title), quoted(plot.x_name), quoted(plot.y_name));
  script += axes_of(plot);
  std::string command;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    if (!has_points(plot, series)) continue;
    script += data_of(plot, series, i);
    command += fmt::format("{}$d{} {} {}", command.empty() ? "plot " : ", ", i, style_of(series),
                           series.name.empty() ? "notitle" : "title " + quoted(series.name));
  }
  return script + command + "\n";
}

/// Runs gnuplot in a folder. @returns whether it is installed.
bool run_gnuplot(const fs::path& folder) try {
  ChildEnd end = ChildProcess({"gnuplot", "--default-settings", "plot.gp"}, folder).wait();
  if (end.exit_code == 0) return true;
  std::replace(end.messages.begin(), end.messages.end(), '\n', ' ');
  throw IoError("gnuplot: " + end.messages);
} catch (const ProgramMissing&) {
  return false;
}

}  // namespace

std::optional<std::string> plot_svg(const Plot& plot) { return plot_svg(std::span(&plot, 1)); }

std::optional<std::string> plot_svg(std::span<const Plot> plots) {
  std::vector<const Plot*> drawn;
  int height_px = 0;
  for (const Plot& plot : plots)
    if (std::any_of(plot.series.begin(), plot.series.end(), [&](const PlotSeries& s) { return has_points(plot, s); })) {
      drawn.push_back(&plot);
      height_px += plot.height_px;
    }
  if (drawn.empty()) return std::nullopt;
  std::string script = terminal_of(plots.front().width_px, height_px);
  if (drawn.size() > 1) script += fmt::format("set multiplot layout {},1\n", drawn.size());
  for (const Plot* plot : drawn) script += commands_of(*plot) + (drawn.size() > 1 ? "reset\n" : "");
  const TemporaryFolder folder("papilla-plot");
  write_atomically(folder.path() / "plot.gp", script);
  if (!run_gnuplot(folder.path())) return std::nullopt;
  return read_file(folder.path() / "plot.svg");
}

bool write_plot(const std::filesystem::path& file, const Plot& plot) { return write_plot(file, std::span(&plot, 1)); }

bool write_plot(const std::filesystem::path& file, std::span<const Plot> plots) {
  const auto svg = plot_svg(plots);
  if (svg) write_atomically(file, *svg);
  return svg.has_value();
}

}  // namespace papilla
