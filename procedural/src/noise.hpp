// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace papilla::procedural_detail {

/// A well mixed 32-bit number of three others.
inline std::uint32_t mix_bits(std::uint32_t a, std::uint32_t b, std::uint32_t seed) noexcept {
  std::uint32_t h = a * 0x9E3779B1U + b * 0x85EBCA77U + seed * 0xC2B2AE3DU;
  h ^= h >> 15;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12;
  h *= 0x297A2D39U;
  h ^= h >> 15;
  return h;
}
inline double unit_number(std::uint32_t h) noexcept { return h * (1.0 / 4294967296.0); }

/// Largest coordinate of a lattice, so that its numbers fit into 32 bits.
inline constexpr double k_most_coordinate = 1e9;
/// A coordinate within ±k_most_coordinate; the lower end for NaN.
inline double clamp_coordinate(double v) noexcept {
  v = v > -k_most_coordinate ? v : -k_most_coordinate;
  return v < k_most_coordinate ? v : k_most_coordinate;
}

/// How an octave of noise lies in the plane.
struct Octave {
  double frequency_x = 1, frequency_y = 1;  ///< Cells per unit.
  double shift_x = 0, shift_y = 0;          ///< In cells.
  double period_x = 0, period_y = 0;        ///< In cells, whole numbers; 0: does not repeat.
  std::uint32_t seed = 0;
};

/// Gradient noise with quintic fade: 0 at lattice points, mean 0, rms 0.28, |noise| <= 1.5 and nearly always < 1.
/// Gradients are uniform in a square. out[i] = noise(x[i], y[i]); numbers that are not finite count as 0.
/// Cost: 4 hashes a point, vectorised.
void noise_row(const double* x, const double* y, int n, const Octave& octave, double* out);
/// The same in space; the third coordinate is z[i] and has frequency_x as frequency.
void noise_row(const double* x, const double* y, const double* z, int n, const Octave& octave, double* out);

}  // namespace papilla::procedural_detail
