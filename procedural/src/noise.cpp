// SPDX-License-Identifier: MIT
#include "noise.hpp"

#include <cmath>

#include "papilla/core/cpu_clones.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr double k_gain = 1.5;

inline double fade(double t) noexcept { return t * t * t * (t * (t * 6 - 15) + 10); }
inline double low_half(std::uint32_t h) noexcept { return (static_cast<int>(h & 0xFFFFU) - 32768) * (1.0 / 32768); }
inline double high_half(std::uint32_t h) noexcept { return (static_cast<int>(h >> 16) - 32768) * (1.0 / 32768); }
inline double slope(std::uint32_t h, double dx, double dy) noexcept { return low_half(h) * dx + high_half(h) * dy; }
inline double slope(std::uint32_t h, double dx, double dy, double dz) noexcept {
  const auto part = [](std::uint32_t bits) { return (static_cast<int>(bits & 1023U) - 512) * (1.0 / 512); };
  return part(h) * dx + part(h >> 10) * dy + part(h >> 20) * dz;
}
inline std::uint32_t lattice(double cell) noexcept {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell));
}

template <bool periodic>
inline double noise_at(double px, double py, double period_x, double period_y, std::uint32_t seed) noexcept {
  double cx = std::floor(px), cy = std::floor(py);
  const double dx = px - cx, dy = py - cy;
  double nx = cx + 1, ny = cy + 1;
  if constexpr (periodic) {
    cx -= period_x * std::floor(cx / period_x);
    cy -= period_y * std::floor(cy / period_y);
    nx = cx + 1 < period_x ? cx + 1 : 0;
    ny = cy + 1 < period_y ? cy + 1 : 0;
  }
  const std::uint32_t x0 = lattice(cx), x1 = lattice(nx), y0 = lattice(cy), y1 = lattice(ny);
  const double a = slope(mix_bits(x0, y0, seed), dx, dy), b = slope(mix_bits(x1, y0, seed), dx - 1, dy);
  const double c = slope(mix_bits(x0, y1, seed), dx, dy - 1), d = slope(mix_bits(x1, y1, seed), dx - 1, dy - 1);
  const double u = fade(dx), v = fade(dy);
  const double top = a + u * (b - a), bottom = c + u * (d - c);
  return k_gain * (top + v * (bottom - top));
}

}  // namespace

PAPILLA_CPU_CLONES("avx2")
static void open_row(const double* x, const double* y, int n, const Octave& o, double* out) {
  const double fx = o.frequency_x, fy = o.frequency_y, sx = o.shift_x, sy = o.shift_y;
  const std::uint32_t seed = o.seed;
  for (int i = 0; i < n; ++i)
    out[i] = noise_at<false>(clamp_coordinate(x[i] * fx + sx), clamp_coordinate(y[i] * fy + sy), 0, 0, seed);
}

PAPILLA_CPU_CLONES("avx2")
static void periodic_row(const double* x, const double* y, int n, const Octave& o, double* out) {
  const double fx = o.frequency_x, fy = o.frequency_y, sx = o.shift_x, sy = o.shift_y;
  const double px = o.period_x, py = o.period_y;
  const std::uint32_t seed = o.seed;
  for (int i = 0; i < n; ++i)
    out[i] = noise_at<true>(clamp_coordinate(x[i] * fx + sx), clamp_coordinate(y[i] * fy + sy), px, py, seed);
}

PAPILLA_CPU_CLONES("avx2")
static void space_row(const double* x, const double* y, const double* z, int n, const Octave& o, double* out) {
  const double fx = o.frequency_x, fy = o.frequency_y, sx = o.shift_x, sy = o.shift_y;
  const double rx = o.period_x > 0 ? o.period_x : 4 * k_most_coordinate,
               ry = o.period_y > 0 ? o.period_y : 4 * k_most_coordinate;
  const std::uint32_t seed = o.seed;
  for (int i = 0; i < n; ++i) {
    const double px = clamp_coordinate(x[i] * fx + sx), py = clamp_coordinate(y[i] * fy + sy),
                 pz = clamp_coordinate(z[i] * fx);
    double cx = std::floor(px), cy = std::floor(py);
    const double cz = std::floor(pz);
    const double dx = px - cx, dy = py - cy, dz = pz - cz;
    double nx = cx + 1, ny = cy + 1;
    if (o.period_x > 0) {
      cx -= rx * std::floor(cx / rx);
      nx = cx + 1 < rx ? cx + 1 : 0;
    }
    if (o.period_y > 0) {
      cy -= ry * std::floor(cy / ry);
      ny = cy + 1 < ry ? cy + 1 : 0;
    }
    const double u = fade(dx), v = fade(dy), w = fade(dz);
    double layer[2];
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t s = seed + 0x68E31DA4U * (lattice(cz) + static_cast<std::uint32_t>(k));
      const std::uint32_t x0 = lattice(cx), x1 = lattice(nx), y0 = lattice(cy), y1 = lattice(ny);
      const double ez = dz - k;
      const double a = slope(mix_bits(x0, y0, s), dx, dy, ez), b = slope(mix_bits(x1, y0, s), dx - 1, dy, ez);
      const double c = slope(mix_bits(x0, y1, s), dx, dy - 1, ez), d = slope(mix_bits(x1, y1, s), dx - 1, dy - 1, ez);
      const double top = a + u * (b - a), bottom = c + u * (d - c);
      layer[k] = top + v * (bottom - top);
    }
    out[i] = k_gain * (layer[0] + w * (layer[1] - layer[0]));
  }
}

void noise_row(const double* x, const double* y, int n, const Octave& octave, double* out) {
  if (octave.period_x > 0 && octave.period_y > 0)
    periodic_row(x, y, n, octave, out);
  else
    open_row(x, y, n, octave, out);
}

void noise_row(const double* x, const double* y, const double* z, int n, const Octave& octave, double* out) {
  space_row(x, y, z, n, octave, out);
}

}  // namespace papilla::procedural_detail
