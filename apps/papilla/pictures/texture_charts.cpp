// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/texture_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "papilla/core/units.hpp"
#include "papilla/core/vec.hpp"

namespace papilla::app {
namespace {

constexpr std::array<const char*, 6> k_colors = {"#1f6fb4", "#d1495b", "#2a9d63", "#8e5ea2", "#c77d1f", "#444444"};
constexpr double k_width = 640, k_height = 440, k_margin = 60;

std::string document(const std::string& body, double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\"><rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{2}</svg>\n",
      width, height, body);
}

std::string text(double x, double y, const std::string& content, const char* anchor = "middle",
                 const char* color = "#222") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", x, y, anchor, color,
                     content);
}

std::string line(Vec2 from, Vec2 to, const char* color = "#ccc") {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", from.x, from.y,
                     to.x, to.y, color);
}

std::string path(const std::vector<Vec2>& points, const char* color, bool closed = false) {
  std::string d;
  for (const Vec2 p : points) d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : "L", p.x, p.y);
  return fmt::format("<path d=\"{}{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", d, closed ? "Z" : "",
                     color);
}

std::string dot_mark(Vec2 at, const char* color) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", at.x, at.y, color);
}

/// Ticks at 1, 2 or 5 times a power of ten, about five of them, within a range.
std::vector<double> round_ticks(double low, double high) {
  if (!(high > low)) return {low};
  const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9) + 1e-9 * step; ++k)
    ticks.push_back(k * step + 0.0);  // Not −0.
  return ticks;
}

/// Maps values to the frame of a chart.
struct Frame {
  double low_x, high_x, low_y, high_y;
  Vec2 operator()(double x, double y) const {
    const double across = high_x > low_x ? (x - low_x) / (high_x - low_x) : 0.5;
    const double up = high_y > low_y ? (y - low_y) / (high_y - low_y) : 0.5;
    return {k_margin + across * (k_width - 2 * k_margin), k_height - k_margin - up * (k_height - 2 * k_margin)};
  }
  std::string border() const {
    return path({(*this)(low_x, low_y), (*this)(high_x, low_y), (*this)(high_x, high_y), (*this)(low_x, high_y)},
                "#888", true);
  }
};

/// At most `most` samples of a row of heights.
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

std::string log_log_chart(const std::vector<LogLogSeries>& series) {
  struct Curve {
    std::string label;
    std::vector<Vec2> points;
  };
  std::vector<Curve> curves;
  Frame frame{0, 0, 0, 0};
  for (const LogLogSeries& one : series) {
    Curve curve{fmt::format("{}: D = {:.3f} [{:.3f}, {:.3f}]", one.name, one.estimate.dimension, one.estimate.low,
                            one.estimate.high),
                {}};
    for (const ScalePoint& point : one.estimate.curve) {
      if (!(point.scale > 0 && point.measure > 0)) continue;
      const double x = std::log2(point.scale), y = std::log2(point.measure);
      curve.points.push_back({x, curve.points.empty() ? 0 : y});
      if (curve.points.size() == 1) curve.points[0].y = y;
    }
    if (curve.points.empty()) continue;
    const double first = curve.points[0].y;
    for (Vec2& p : curve.points) {
      p.y -= first;
      frame.high_x = std::max(frame.high_x, std::ceil(p.x));
      frame.low_y = std::min(frame.low_y, std::floor(p.y));
      frame.high_y = std::max(frame.high_y, std::ceil(p.y));
    }
    curves.push_back(std::move(curve));
  }
  std::string body;
  for (double x = frame.low_x; x <= frame.high_x; ++x) {
    body += line(frame(x, frame.low_y), frame(x, frame.high_y));
    body += text(frame(x, 0).x, k_height - k_margin + 18, fmt::format("{:.0f}", std::exp2(x)));
  }
  const double step = std::max(1.0, std::ceil((frame.high_y - frame.low_y) / 8));
  for (double y = frame.low_y; y <= frame.high_y; y += step) {
    body += line(frame(frame.low_x, y), frame(frame.high_x, y));
    body += text(k_margin - 8, frame(0, y).y + 4, fmt::format("2^{:.0f}", y), "end");
  }
  body += frame.border();
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const char* color = k_colors[i % k_colors.size()];
    std::vector<Vec2> points;
    for (const Vec2 p : curves[i].points) points.push_back(frame(p.x, p.y));
    body += path(points, color);
    for (const Vec2 p : points) body += dot_mark(p, color);
    body += text(k_width - k_margin + 12, k_margin + 12 + 18 * static_cast<double>(i), curves[i].label, "start", color);
  }
  body += text(k_width / 2, k_height - 14, "scale: side, window or lag [pixels]");
  body += text(k_width / 2, 30, "measure, relative to that at the least scale");
  constexpr double k_legend = 230;
  const char* slopes[] = {"Counts fall with slope \u2212D;", "fshot and best rise with H = 3 \u2212 D.",
                          "In brackets: 95 % interval."};
  double y = k_margin + 30 + 18 * static_cast<double>(curves.size());
  for (const char* note : slopes) body += text(k_width - k_margin + 12, y += 16, note, "start", "#666");
  return document(body, k_width + k_legend, k_height);
}

std::string hurst_chart(const FshotSignature& signature) {
  constexpr double k_side = 460, k_radius = 165;  // Of H = 1.
  const Vec2 centre{k_side / 2, k_side / 2};
  const auto at = [&](double angle, double hurst) {
    return centre + k_radius * hurst * Vec2{std::cos(angle), std::sin(angle)};
  };
  std::string body;
  for (const double h : {0.25, 0.5, 0.75, 1.0}) {
    body += fmt::format("<circle cx=\"{0:.0f}\" cy=\"{0:.0f}\" r=\"{1:.1f}\" fill=\"none\" stroke=\"#ccc\"/>\n",
                        centre.x, k_radius * h);
  }
  body += line({centre.x - k_radius, centre.y}, {centre.x + k_radius, centre.y});
  body += line({centre.x, centre.y - k_radius}, {centre.x, centre.y + k_radius});
  for (const int degrees : {0, 45, 90, 135, 180, 225, 270, 315}) {
    const Vec2 label = at(degrees * k_radians_per_degree, 1.09);
    body += text(label.x, label.y + 4, fmt::format("{}\u00b0", degrees), "middle", "#888");
  }
  for (const DirectionalHurst& d : signature.directions)
    for (const double turn : {0.0, 180.0})
      body += dot_mark(at((d.angle_deg + turn) * k_radians_per_degree, std::clamp(d.hurst, 0.0, 1.2)), k_colors[0]);
  if (signature.str > 0 && signature.sta > 0) {
    const double minor = signature.sta, major = signature.sta / signature.str;
    const double turn = signature.angle_deg * k_radians_per_degree;
    std::vector<Vec2> ellipse;
    for (int i = 0; i < 180; ++i) {
      const double t = 2 * std::numbers::pi * i / 180, u = minor * std::cos(t), v = major * std::sin(t);
      ellipse.push_back(
          centre + k_radius * Vec2{u * std::cos(turn) - v * std::sin(turn), u * std::sin(turn) + v * std::cos(turn)});
    }
    body += path(ellipse, k_colors[1], true);
  }
  for (const double h : {0.25, 0.5, 0.75, 1.0}) {
    const Vec2 label = at(-0.39, h);  // Between two labelled directions.
    body += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"28\" height=\"14\" fill=\"white\" opacity=\"0.8\"/>\n",
                        label.x - 14, label.y - 10);
    body += text(label.x, label.y + 1, fmt::format("{:.2f}", h), "middle", "#555");
  }
  body += text(k_side / 2, 18,
               fmt::format("Hurst exponent by direction: Sta {:.3f}, Str {:.3f} at {:.0f}\u00b0", signature.sta,
                           signature.str, signature.angle_deg));
  body += text(12, k_side - 24, "points: measured (below 0 drawn at 0)", "start", k_colors[0]);
  body += text(12, k_side - 8, "curve: ellipse; angles from x (right) towards y (down)", "start", k_colors[1]);
  return document(body, k_side, k_side);
}

std::string section_chart(const HeightMap& map) {
  const std::vector<Vec2> row = profile(map, true), column = profile(map, false);
  Frame frame{0, 0, 1e300, -1e300};
  for (const auto* points : {&row, &column})
    for (const Vec2 p : *points) {
      frame.high_x = std::max(frame.high_x, p.x);
      frame.low_y = std::min(frame.low_y, p.y);
      frame.high_y = std::max(frame.high_y, p.y);
    }
  std::string body;
  for (const double x : round_ticks(0, frame.high_x)) {
    body += line(frame(x, frame.low_y), frame(x, frame.high_y));
    body += text(frame(x, 0).x, k_height - k_margin + 18, fmt::format("{:.4g}", x));
  }
  for (const double y : round_ticks(frame.low_y, frame.high_y)) {
    body += line(frame(0, y), frame(frame.high_x, y));
    body += text(k_margin - 6, frame(0, y).y + 4, fmt::format("{:.4g}", y), "end");
  }
  body += frame.border();
  std::size_t color = 0;
  for (const auto* points : {&row, &column}) {
    std::vector<Vec2> drawn;
    for (const Vec2 p : *points) drawn.push_back(frame(p.x, p.y));
    body += path(drawn, k_colors[color]);
    body += text(k_width - k_margin - 110 * static_cast<double>(color), k_margin - 8,
                 color == 0 ? "middle row" : "middle column", "end", k_colors[color]);
    ++color;
  }
  body += text(k_width / 2, k_height - 14, map.pitch_mm_x > 0 ? "position [mm]" : "position [pixels]");
  body += text(k_width / 2, 30, "height [mm]");
  return document(body, k_width, k_height);
}

}  // namespace papilla::app
