// SPDX-License-Identifier: MIT
#include "papilla/pipeline/pictures/uv_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "papilla/core/bounds.hpp"
#include "pictures/border_edges.hpp"
#include "pictures/pixel_text.hpp"

namespace papilla {
namespace {

constexpr Rgb k_ink = {0, 0, 0}, k_wrong = {220, 30, 30};
constexpr int k_margin = 16, k_legend_height = 64, k_bar_height = 18, k_letters_scale = 2;

/// Viridis at nine even steps (S. van der Walt, N. Smith, 2015, CC0).
constexpr std::array<Rgb, 9> k_viridis = {{{68, 1, 84},
                                           {71, 44, 122},
                                           {59, 81, 139},
                                           {44, 113, 142},
                                           {33, 144, 141},
                                           {39, 173, 129},
                                           {92, 200, 99},
                                           {170, 220, 50},
                                           {253, 231, 37}}};

Rgb viridis(double x) {
  const double place = std::clamp(x, 0.0, 1.0) * (k_viridis.size() - 1);
  const std::size_t i = std::min<std::size_t>(static_cast<std::size_t>(place), k_viridis.size() - 2);
  Rgb colour{};
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<unsigned char>(
        std::lround(k_viridis[i][c] + (place - static_cast<double>(i)) * (k_viridis[i + 1][c] - k_viridis[i][c])));
  return colour;
}

struct Canvas {
  ColorImage image;
  Canvas(int width, int height) : image{width, height, {}} {
    image.pixels.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255);
  }
  void set(int x, int y, const Rgb& colour) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    std::copy(colour.begin(), colour.end(), &image.pixels[index(x, y)]);
  }
  std::size_t index(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  }
};

void fill_triangle(Canvas& canvas, std::array<Vec2, 3> p, const Rgb& colour) {
  const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
  const int first = std::max(0, static_cast<int>(std::ceil(low - 0.5)));
  const int last = std::min(canvas.image.height - 1, static_cast<int>(std::floor(high - 0.5)));
  for (int row = first; row <= last; ++row) {
    const double y = row + 0.5;
    double x0 = std::numeric_limits<double>::infinity(), x1 = -x0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 a = p[k], b = p[(k + 1) % 3];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
      x0 = std::min(x0, x), x1 = std::max(x1, x);
    }
    for (int x = std::max(0, static_cast<int>(std::ceil(x0 - 0.5))); x + 0.5 < x1 && x < canvas.image.width; ++x)
      canvas.set(x, row, colour);
  }
}

/// A line of the given width in samples.
void draw_line(Canvas& canvas, Vec2 a, Vec2 b, double width, const Rgb& colour) {
  const Vec2 d = b - a;
  const double length = norm(d);
  if (!(length > 0)) return;
  const Vec2 side{-0.5 * width * d.y / length, 0.5 * width * d.x / length};
  fill_triangle(canvas, {a - side, b - side, b + side}, colour);
  fill_triangle(canvas, {a - side, b + side, a + side}, colour);
}

void draw_legend(Canvas& canvas, int top, double worst) {
  const int left = 2 * k_margin, right = canvas.image.width - 2 * k_margin;
  for (int x = left; x < right; ++x)
    for (int y = 0; y < k_bar_height; ++y) canvas.set(x, top + y, viridis((x - left + 0.5) / (right - left)));
  constexpr int ticks = 4;
  for (int i = 0; i <= ticks; ++i) {
    const double part = static_cast<double>(i) / ticks;
    const int x = left + static_cast<int>(std::lround(part * (right - 1 - left)));
    for (int y = 0; y < 5; ++y) canvas.set(x, top + k_bar_height + y, k_ink);
    draw_text(fmt::format("{:.2f}{}", 4 + part * (worst - 4), i == ticks ? "+" : ""), x, top + k_bar_height + 8,
              k_letters_scale, [&](int px, int py) { canvas.set(px, py, k_ink); });
  }
}

/// Averages squares of samples into pixels.
void downsample(const Canvas& fine, int samples, Canvas& target) {
  const int divisor = samples * samples;
  for (int y = 0; y < fine.image.height / samples; ++y)
    for (int x = 0; x < fine.image.width / samples; ++x) {
      std::array<int, 3> sum{};
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i)
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += fine.image.pixels[fine.index(x * samples + i, y * samples + j) + c];
      target.set(x, y,
                 {static_cast<unsigned char>(sum[0] / divisor), static_cast<unsigned char>(sum[1] / divisor),
                  static_cast<unsigned char>(sum[2] / divisor)});
    }
}

Bounds2 bounds_of(const CornerAttribute<Vec2>& uv) {
  Bounds2 bounds;
  for (std::size_t t = 0; t < uv.indices.size(); ++t)
    if (uv.has_value(t))
      for (const Index i : uv.indices[t]) bounds.add(uv.values[i]);
  return bounds.is_empty() ? Bounds2{{0, 0}, {1, 1}} : bounds;
}

}  // namespace

Rgb distortion_colour(const TriangleDistortion& distortion, double worst) {
  if (distortion.flipped || !distortion.measured) return k_wrong;
  return viridis((distortion.symmetric_dirichlet - 4) / (worst - 4));
}

ColorImage draw_uv_layout(const CornerAttribute<Vec2>& uv, const DistortionReport& report,
                          const UvLayoutOptions& options) {
  const Bounds2 b = bounds_of(uv);
  const Vec2 size = b.size();
  const double larger = std::max({size.x, size.y, std::numeric_limits<double>::min()});
  const double inner = options.side_px - 2 * k_margin;
  const int width = std::max(256, static_cast<int>(std::lround(inner * size.x / larger)) + 2 * k_margin);
  const int height = std::max(2 * k_margin + 1, static_cast<int>(std::lround(inner * size.y / larger)) + 2 * k_margin);
  Canvas fine(width * options.samples, height * options.samples);
  const auto place = [&](Index i) {
    const Vec2 p = uv.values[i] - b.low;
    return options.samples * Vec2{k_margin + inner * (p.x / larger), height - k_margin - inner * (p.y / larger)};
  };
  for (std::size_t t = 0; t < uv.indices.size(); ++t) {
    if (!uv.has_value(t)) continue;
    fill_triangle(fine, {place(uv.indices[t][0]), place(uv.indices[t][1]), place(uv.indices[t][2])},
                  distortion_colour(report.per_triangle[t], options.worst));
  }
  const std::vector<std::array<bool, 3>> borders = border_edges(uv.indices);
  for (std::size_t t = 0; t < borders.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (borders[t][k])
        draw_line(fine, place(uv.indices[t][k]), place(uv.indices[t][(k + 1) % 3]), options.samples, k_ink);
  Canvas canvas(width, height + k_legend_height);
  downsample(fine, options.samples, canvas);
  draw_legend(canvas, height + k_margin / 2, options.worst);
  return canvas.image;
}

}  // namespace papilla
