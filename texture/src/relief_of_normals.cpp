// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/texture/relief_of_normals.hpp"

#include <cmath>
#include <numbers>

#include "fft.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/vec.hpp"

namespace papilla {
namespace {

constexpr double k_smoothing = 0.003;
constexpr double k_steepest = 20;

/// (∂h/∂x, ∂h/∂y), y down, of a texel.
Vec2 slope_of(const unsigned char* pixel, double scale) {
  const auto component = [&](int k) { return pixel[k] / 127.5 - 1; };
  const double z = std::max(component(2), 1e-3);
  const Vec2 slope{-component(0) * scale / z, component(1) * scale / z};
  const double length = std::hypot(slope.x, slope.y);
  return length > k_steepest ? k_steepest / length * slope : slope;
}

}  // namespace

HeightMap relief_of_normals(const ColorImage& map, double scale, double pitch_mm_x, double pitch_mm_y) {
  const std::size_t texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  if (map.width < 1 || map.height < 1 || map.pixels.size() != 3 * texels)
    throw InvalidInput("relief_of_normals: the map is empty or has another size than its texels");
  if (!(pitch_mm_x > 0 && pitch_mm_y > 0 && std::isfinite(pitch_mm_x + pitch_mm_y + scale)))
    throw InvalidInput("relief_of_normals: pitch and scale must be finite, the pitch positive");
  texture_detail::RealFft2d across(map.width, map.height), down(map.width, map.height);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const std::size_t at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
      const Vec2 slope = slope_of(map.pixels.data() + 3 * at, scale);
      across.real(x, y) = slope.x, down.real(x, y) = slope.y;
    }
  across.forward();
  down.forward();
  const std::size_t columns = across.spectrum_width();
  for (int row = 0; row < map.height; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double wx = 2 * std::numbers::pi * static_cast<double>(column) / map.width,
                   wy = 2 * std::numbers::pi * row / map.height;
      // Central differences are i sin(w) / pitch, second ones times the pitch (2 - 2 cos(w)) / pitch.
      const double dx = std::sin(wx) / pitch_mm_x, dy = std::sin(wy) / pitch_mm_y;
      const double bend = (2 - 2 * std::cos(wx)) / pitch_mm_x + (2 - 2 * std::cos(wy)) / pitch_mm_y;
      const double denominator = dx * dx + dy * dy + k_smoothing * bend * bend;
      std::complex<double>& value = across.spectrum()[static_cast<std::size_t>(row) * columns + column];
      const std::complex<double> other = down.spectrum()[static_cast<std::size_t>(row) * columns + column];
      const std::complex<double> sum = dx * value + dy * other;
      value = denominator > 0 ? std::complex(sum.imag(), -sum.real()) / denominator : std::complex(0.0, 0.0);
    }
  across.backward();
  HeightMap relief{map.width, map.height, Values<float>(texels), pitch_mm_x, pitch_mm_y, true};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      relief.at(x, y) = static_cast<float>(across.real(x, y) / static_cast<double>(texels));
  return relief;
}

}  // namespace papilla
