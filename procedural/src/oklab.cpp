// SPDX-License-Identifier: MIT
#include "oklab.hpp"

#include <algorithm>
#include <cmath>

#include "papilla/core/srgb.hpp"

namespace papilla::procedural_detail {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Ottosson, 2020: linear sRGB to cone responses, their cube roots to L, a, b, and back.
constexpr Matrix k_cones{{{0.4122214708, 0.5363325363, 0.0514459929},
                          {0.2119034982, 0.6806995451, 0.1073969566},
                          {0.0883024619, 0.2817188376, 0.6299787005}}};
constexpr Matrix k_lab{{{0.2104542553, 0.7936177850, -0.0040720468},
                        {1.9779984951, -2.4285922050, 0.4505937099},
                        {0.0259040371, 0.7827717662, -0.8086757660}}};
constexpr Matrix k_roots{
    {{1, 0.3963377774, 0.2158037573}, {1, -0.1055613458, -0.0638541728}, {1, -0.0894841775, -1.2914855480}}};
constexpr Matrix k_linear{{{4.0767416621, -3.3077115913, 0.2309699292},
                           {-1.2684380046, 2.6097574011, -0.3413193965},
                           {-0.0041960863, -0.7034186147, 1.7076147010}}};

Rgb times(const Matrix& m, const Rgb& v) {
  Rgb out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[i] += m[i][k] * v[k];
  return out;
}

Rgb linear_of(const Oklch& c) {
  Rgb cones = times(k_roots, {c.lightness, c.chroma * std::cos(c.hue), c.chroma * std::sin(c.hue)});
  for (double& v : cones) v = v * v * v;
  return times(k_linear, cones);
}

bool is_shown(const Rgb& linear) {
  constexpr double k_slack = 1e-4;  // The matrices are rounded; less than half a step of 8 bits.
  return std::all_of(linear.begin(), linear.end(), [](double v) { return v >= -k_slack && v <= 1 + k_slack; });
}

}  // namespace

Oklch oklch_of(const Rgb& srgb) {
  Rgb cones{};
  for (std::size_t k = 0; k < 3; ++k) cones[k] = linear_from_srgb(srgb[k]);
  cones = times(k_cones, cones);
  for (double& v : cones) v = std::cbrt(v);
  const Rgb lab = times(k_lab, cones);
  return {lab[0], std::hypot(lab[1], lab[2]), std::atan2(lab[2], lab[1])};
}

Rgb srgb_of(Oklch colour) {
  constexpr int k_halvings = 24;
  colour.lightness = std::clamp(colour.lightness, 0.0, 1.0);
  if (!is_shown(linear_of(colour))) {
    double low = 0, high = colour.chroma;
    for (int i = 0; i < k_halvings; ++i) {
      colour.chroma = (low + high) / 2;
      (is_shown(linear_of(colour)) ? low : high) = colour.chroma;
    }
    colour.chroma = low;
  }
  Rgb srgb = linear_of(colour);
  for (double& v : srgb) v = srgb_from_linear(v);
  return srgb;
}

}  // namespace papilla::procedural_detail
