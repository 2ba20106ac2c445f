// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/trace_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace papilla::app {
namespace {

constexpr double k_left = 80, k_top = 44, k_width = 620, k_height = 420, k_legend = 320, k_bottom = 60;

/// Eight colours that differ for every kind of colour vision (M. Okabe, K. Ito, 2008), the last for dark text.
constexpr std::array<const char*, 8> k_colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                               "#56B4E9", "#E69F00", "#6B6B00", "#000000"};

struct Axes {
  double x0, x1, y0, y1;  ///< Decades.
  double x(double seconds) const { return k_left + k_width * (std::log10(std::max(seconds, 1e-9)) - x0) / (x1 - x0); }
  double y(double error) const {
    const double e = error > 0 ? std::max(std::log10(error), y0) : y0;
    return k_top + k_height * (1 - (e - y0) / (y1 - y0));
  }
};

Axes axes_of(const std::vector<TraceCurve>& curves) {
  Axes a{1e9, -1e9, 1e9, -1e9};
  for (const TraceCurve& curve : curves)
    for (const TraceSample& s : curve.trace) {
      const double x = std::log10(std::max(s.seconds, 1e-6));
      a.x0 = std::min(a.x0, x), a.x1 = std::max(a.x1, x);
      if (!(s.error > 0) || !std::isfinite(s.error)) continue;
      a.y0 = std::min(a.y0, std::log10(s.error)), a.y1 = std::max(a.y1, std::log10(s.error));
    }
  if (!(a.x0 <= a.x1)) a.x0 = a.x1 = 0;
  if (!(a.y0 <= a.y1)) a.y0 = a.y1 = 0;
  a.x0 = std::floor(a.x0), a.x1 = std::max(std::ceil(a.x1), a.x0 + 1);
  a.y0 = std::floor(std::max(a.y0, a.y1 - 14)), a.y1 = std::max(std::ceil(a.y1), a.y0 + 1);
  return a;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

/// Samples that no other one beats, from the fastest to the slowest.
Trace front_of(const std::vector<TraceCurve>& curves) {
  Trace all;
  for (const TraceCurve& curve : curves) all.insert(all.end(), curve.trace.begin(), curve.trace.end());
  std::sort(all.begin(), all.end(), [](const TraceSample& a, const TraceSample& b) {
    return a.seconds != b.seconds ? a.seconds < b.seconds : a.error < b.error;
  });
  Trace front;
  for (const TraceSample& s : all)
    if (std::isfinite(s.error) && (front.empty() || s.error < front.back().error)) front.push_back(s);
  return front;
}

std::string grid(const Axes& a) {
  std::string svg;
  for (double x = a.x0; x <= a.x1; ++x)
    svg += fmt::format(
        "<line x1='{0:.1f}' x2='{0:.1f}' y1='{1:.1f}' y2='{2:.1f}' stroke='#ddd'/><text x='{0:.1f}' y='{3:.1f}' "
        "text-anchor='middle'>{4:g} s</text>\n",
        a.x(std::pow(10, x)), k_top, k_top + k_height, k_top + k_height + 18, std::pow(10, x));
  const double step = a.y1 - a.y0 > 8 ? 2 : 1;
  for (double y = a.y0; y <= a.y1; y += step)
    svg += fmt::format(
        "<line x1='{0:.1f}' x2='{1:.1f}' y1='{2:.1f}' y2='{2:.1f}' stroke='#ddd'/><text x='{3:.1f}' y='{4:.1f}' "
        "text-anchor='end'>{5:g}</text>\n",
        k_left, k_left + k_width, a.y(std::pow(10, y)), k_left - 6, a.y(std::pow(10, y)) + 4, std::pow(10, y));
  return svg;
}

std::string staircase(const Axes& a, const Trace& front) {
  std::string points;
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (i > 0) points += fmt::format("{:.1f},{:.1f} ", a.x(front[i].seconds), a.y(front[i - 1].error));
    points += fmt::format("{:.1f},{:.1f} ", a.x(front[i].seconds), a.y(front[i].error));
  }
  return "<polyline points='" + points + "' fill='none' stroke='#ccc' stroke-width='6'/>\n";
}

}  // namespace

void mark_front(std::vector<TraceCurve>& curves) {
  const Trace front = front_of(curves);
  for (TraceCurve& curve : curves)
    curve.in_front = std::any_of(curve.trace.begin(), curve.trace.end(), [&](const TraceSample& s) {
      return std::any_of(front.begin(), front.end(),
                         [&](const TraceSample& f) { return f.seconds == s.seconds && f.error == s.error; });
    });
}

std::string trace_plot_svg(const std::string& title, const std::string& error_name,
                           const std::vector<TraceCurve>& curves) {
  const Axes a = axes_of(curves);
  const double rows = 17.0 * static_cast<double>(curves.size()) + k_top;
  const double height = std::max(k_top + k_height + k_bottom, rows + 10);
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{:.0f}' height='{:.0f}' font-family='sans-serif' "
      "font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n<text x='{:.0f}' y='22' font-size='15'>{}"
      "</text>\n<text x='{:.0f}' y='{:.0f}' text-anchor='middle'>run time</text>\n<text x='16' y='{:.0f}' "
      "transform='rotate(-90 16 {:.0f})' text-anchor='middle'>{}</text>\n",
      k_left + k_width + k_legend, height, k_left, escaped(title), k_left + k_width / 2, k_top + k_height + 40,
      k_top + k_height / 2, k_top + k_height / 2, escaped(error_name));
  svg += grid(a) + staircase(a, front_of(curves));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* colour = k_colours[i % k_colours.size()];
    const char* dash = i / k_colours.size() % 2 == 0 ? "none" : "5 3";
    std::string points, dots;
    for (const TraceSample& s : curves[i].trace) {
      if (!std::isfinite(s.error)) continue;
      points += fmt::format("{:.1f},{:.1f} ", a.x(s.seconds), a.y(s.error));
      dots += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3' fill='{}'/>", a.x(s.seconds), a.y(s.error), colour);
    }
    svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='1.5' stroke-dasharray='{}'/>{}\n",
                       points, colour, dash, dots);
    const double y = k_top + 17.0 * static_cast<double>(i) + 6, x = k_left + k_width + 14;
    svg += fmt::format(
        "<line x1='{0:.0f}' x2='{1:.0f}' y1='{2:.1f}' y2='{2:.1f}' stroke='{3}' stroke-width='2' "
        "stroke-dasharray='{4}'/><text x='{5:.0f}' y='{6:.1f}' font-weight='{7}'>{8}</text>\n",
        x, x + 22, y, colour, dash, x + 28, y + 4, curves[i].in_front ? "bold" : "normal", escaped(curves[i].name));
  }
  return svg + "</svg>\n";
}

}  // namespace papilla::app
