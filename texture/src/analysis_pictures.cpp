// SPDX-License-Identifier: MIT
#include "papilla/texture/analysis_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "checks.hpp"

namespace papilla {
namespace {

using Color = std::array<unsigned char, 3>;
constexpr Color k_lattice_color = {255, 64, 32}, k_minimum_color = {32, 200, 255}, k_vector_color = {255, 220, 0};
constexpr unsigned char k_middle_grey = 128;

unsigned char byte(double grey) { return static_cast<unsigned char>(std::lround(255 * std::clamp(grey, 0.0, 1.0))); }

/// One panel of the strip: a window into the picture, clipping what is drawn outside.
class Panel {
 public:
  Panel(ColorImage& picture, int left, int width) : picture_(picture), left_(left), width_(width) {}
  int width() const { return width_; }
  int height() const { return picture_.height; }

  void set(int x, int y, const Color& color) {
    if (x < 0 || y < 0 || x >= width_ || y >= picture_.height) return;
    const auto start = 3 * texture_detail::pixel_index(left_ + x, y, picture_.width);
    std::copy(color.begin(), color.end(), picture_.pixels.begin() + static_cast<std::ptrdiff_t>(start));
  }
  template <typename Grey>
  void fill(const Grey& grey) {
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width_; ++x) {
        const unsigned char value = byte(grey(x, y));
        set(x, y, {value, value, value});
      }
  }
  void line(Vec2 from, Vec2 to, const Color& color) {
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * norm(to - from))));
    for (int i = 0; i <= steps; ++i) {
      const Vec2 p = from + (static_cast<double>(i) / steps) * (to - from);
      set(static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)), color);
    }
  }
  void cross_mark(Vec2 at, const Color& color) {
    line(at - Vec2{1, 0}, at + Vec2{1, 0}, color);
    line(at - Vec2{0, 1}, at + Vec2{0, 1}, color);
  }

 private:
  ColorImage& picture_;
  int left_, width_;
};

struct Range {
  double low = 0, high = 1;
  double operator()(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

template <typename Values>
Range range_of(const Values& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {static_cast<double>(*low), static_cast<double>(*high)};
}

/// Both families of lattice lines through the centre of the panel, bent where the lattice is.
void draw_lattice(Panel& panel, const std::array<Vec2, 2>& vectors, const Displacement* displacement) {
  constexpr double k_piece_px = 4;
  const Vec2 centre{panel.width() / 2.0, panel.height() / 2.0};
  const double diagonal = std::hypot(panel.width(), panel.height());
  const double area = std::abs(cross(vectors[0], vectors[1]));
  for (const auto& [along, step] : {std::pair{vectors[0], vectors[1]}, std::pair{vectors[1], vectors[0]}}) {
    const int lines = static_cast<int>(diagonal * norm(along) / area / 2) + 1;
    const Vec2 half = (diagonal / norm(along)) * along;
    for (int k = -lines; k <= lines; ++k) {
      const Vec2 middle = centre + static_cast<double>(k) * step;
      if (displacement == nullptr) {
        panel.line(middle - half, middle + half, k_lattice_color);
        continue;
      }
      const int pieces = static_cast<int>(std::ceil(2 * diagonal / k_piece_px));
      Vec2 from{};
      for (int i = 0; i <= pieces; ++i) {
        const Vec2 straight = middle + (2.0 * i / pieces - 1) * half;
        const bool near = straight.x > -diagonal && straight.y > -diagonal && straight.x < panel.width() + diagonal &&
                          straight.y < panel.height() + diagonal;
        const Vec2 to = near ? bent_place(*displacement, straight) : straight;
        if (i > 0) panel.line(from, to, k_lattice_color);
        from = to;
      }
    }
  }
}

void draw_matrix(Panel& panel, const SymmetryAnalysis& analysis) {
  const FeatureMatrix matrix = analysis.matrix.distortion.empty() ? feature_matrix(analysis.picture) : analysis.matrix;
  const Range range = range_of(matrix.distortion);
  const int centre_x = panel.width() / 2, centre_y = panel.height() / 2;
  panel.fill([&](int x, int y) {
    return range(matrix.at(std::clamp(x - centre_x, -matrix.reach_x, matrix.reach_x),
                           std::clamp(y - centre_y, -matrix.reach_y, matrix.reach_y)));
  });
  const Vec2 centre{static_cast<double>(centre_x), static_cast<double>(centre_y)};
  for (const Vec2 minimum : analysis.lattice.minima) {
    panel.cross_mark(centre + minimum, k_minimum_color);
    panel.cross_mark(centre - minimum, k_minimum_color);
  }
  if (!analysis.lattice.found) return;
  for (const Vec2 vector : analysis.lattice.vectors_px) panel.line(centre, centre + vector, k_vector_color);
}

}  // namespace

ColorImage to_color_image(const GreyImage& image) {
  texture_detail::require_image(image, "to_color_image");
  ColorImage picture{image.width, image.height, Values<unsigned char>(3 * image.pixels.size())};
  Panel(picture, 0, image.width).fill([&](int x, int y) { return static_cast<double>(image.at(x, y)); });
  return picture;
}

ColorImage symmetry_strip(const SymmetryAnalysis& analysis) {
  const GreyImage& image = analysis.picture;
  texture_detail::require_image(image, "symmetry_strip");
  constexpr int k_panels = 5, k_gap = 4;
  const int width = image.width, stride = width + k_gap;
  ColorImage strip{k_panels * stride - k_gap, image.height, {}};
  strip.pixels.assign(3 * static_cast<std::size_t>(strip.width) * static_cast<std::size_t>(strip.height),
                      k_middle_grey);
  const Range range = range_of(image.pixels);

  Panel original(strip, 0, width), matrix(strip, stride, width);
  original.fill([&](int x, int y) { return range(static_cast<double>(image.at(x, y))); });
  if (analysis.lattice.found)
    draw_lattice(original, analysis.lattice.vectors_px,
                 analysis.deformation ? &analysis.deformation->displacement : nullptr);
  draw_matrix(matrix, analysis);
  if (!analysis.part) return strip;

  const SymmetricPart& part = *analysis.part;
  const GreyImage& cell = part.primitive;
  const double zoom =
      std::min(static_cast<double>(width) / cell.width, static_cast<double>(image.height) / cell.height);
  Panel primitive(strip, 2 * stride, width), synthesis(strip, 3 * stride, width), difference(strip, 4 * stride, width);
  primitive.fill([&](int x, int y) {
    const int column = static_cast<int>(x / zoom), row = static_cast<int>(y / zoom);
    return column < cell.width && row < cell.height ? range(static_cast<double>(cell.at(column, row))) : 0.5;
  });
  synthesis.fill([&](int x, int y) { return range(static_cast<double>(part.synthesis.at(x, y))); });
  difference.fill(
      [&](int x, int y) { return 0.5 + (range(static_cast<double>(part.residual.at(x, y))) - range(0)) / 2; });
  return strip;
}

}  // namespace papilla
