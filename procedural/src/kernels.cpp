// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "noise.hpp"
#include "program.hpp"

namespace papilla::procedural_detail {
namespace {

constexpr double k_pi = std::numbers::pi;
/// Further octaves are finer than the resolution of a double.
constexpr double k_most_octaves = 30;

double clamp_to(double x, double low, double high) { return x < low ? low : x > high ? high : x; }
double finite(double v) { return std::isfinite(v) ? v : 0; }
double quotient(double a, double b) { return b == 0 ? 0 : a / b; }
double modulo(double a, double b) { return b == 0 ? 0 : a - b * std::floor(a / b); }
double power(double a, double b) { return finite(std::pow(a, b)); }
double bias(double a, double x) {
  return x <= 0 ? 0 : power(x, quotient(std::log(clamp_to(a, 1e-9, 1 - 1e-9)), std::log(0.5)));
}
double smooth(double a, double b, double x) {
  if (x < a) return 0;
  if (x >= b) return 1;
  const double t = (x - a) / (b - a);
  return t * t * (3 - 2 * t);
}
std::uint32_t bits_of(double v) {
  const double scaled = clamp_to(std::isnan(v) ? 0 : v, -1e9, 1e9);
  const double whole = std::floor(scaled);
  return mix_bits(static_cast<std::uint32_t>(static_cast<std::int32_t>(whole)),
                  static_cast<std::uint32_t>((scaled - whole) * 4294967295.0), 17);
}
std::uint32_t cell_of(double v) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(clamp_to(std::isnan(v) ? 0 : v, -1e9, 1e9))));
}

double segment_distance(double x1, double y1, double x2, double y2, double u, double v) {
  const double dx = x2 - x1, dy = y2 - y1, length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? clamp_to(((u - x1) * dx + (v - y1) * dy) / length2, 0, 1) : 0;
  return std::hypot(u - x1 - t * dx, v - y1 - t * dy);
}
double outside(double low, double high, double x) {
  return std::max({std::min(low, high) - x, x - std::max(low, high), 0.0});
}

double hue_of(double r, double g, double b) {
  const double most = std::max({r, g, b}), range = most - std::min({r, g, b});
  if (range <= 0) return 0;
  const double sixth = most == r ? (g - b) / range : most == g ? 2 + (b - r) / range : 4 + (r - g) / range;
  return modulo(sixth / 6, 1);
}
double hsv_part(double h, double s, double v, double shift) {
  const double k = modulo(shift + 6 * h, 6);
  return v - v * clamp_to(s, 0, 1) * std::max(0.0, std::min({k, 4 - k, 1.0}));
}

// Kernels from functions of 1 to 6 numbers.
#define PAPILLA_K1(name, expr)                             \
  void name(double* out, const double* const* in, int n) { \
    const double* p = in[0];                               \
    for (int i = 0; i < n; ++i) {                          \
      const double a = p[i];                               \
      out[i] = (expr);                                     \
    }                                                      \
  }
#define PAPILLA_K2(name, expr)                             \
  void name(double* out, const double* const* in, int n) { \
    const double *p = in[0], *q = in[1];                   \
    for (int i = 0; i < n; ++i) {                          \
      const double a = p[i], b = q[i];                     \
      out[i] = (expr);                                     \
    }                                                      \
  }
#define PAPILLA_K3(name, expr)                             \
  void name(double* out, const double* const* in, int n) { \
    const double *p = in[0], *q = in[1], *r = in[2];       \
    for (int i = 0; i < n; ++i) {                          \
      const double a = p[i], b = q[i], c = r[i];           \
      out[i] = (expr);                                     \
    }                                                      \
  }
#define PAPILLA_K4(name, expr)                                             \
  void name(double* out, const double* const* in, int n) {                 \
    for (int i = 0; i < n; ++i) {                                          \
      const double a = in[0][i], b = in[1][i], c = in[2][i], d = in[3][i]; \
      out[i] = (expr);                                                     \
    }                                                                      \
  }
#define PAPILLA_K6(name, expr)                                                                         \
  void name(double* out, const double* const* in, int n) {                                             \
    for (int i = 0; i < n; ++i) {                                                                      \
      const double a = in[0][i], b = in[1][i], c = in[2][i], d = in[3][i], e = in[4][i], f = in[5][i]; \
      out[i] = (expr);                                                                                 \
    }                                                                                                  \
  }

PAPILLA_K2(k_add, a + b)
PAPILLA_K2(k_subtract, a - b)
PAPILLA_K2(k_multiply, a* b)
PAPILLA_K2(k_divide, b == 0 ? 0 : a / b)
PAPILLA_K1(k_negate, -a)
PAPILLA_K1(k_square, a* a)
PAPILLA_K1(k_cube, a* a* a)
PAPILLA_K1(k_absolute, std::abs(a))
PAPILLA_K1(k_arc_cosine, std::acos(clamp_to(a, -1, 1)))
PAPILLA_K1(k_arc_tangent, std::atan(a))
PAPILLA_K2(k_bias, bias(a, b))
PAPILLA_K3(k_boxstep, clamp_to(b == a ? (c >= b ? 1 : 0) : (c - a) / (b - a), 0, 1))
PAPILLA_K1(k_cosine, finite(std::cos(a)))
PAPILLA_K1(k_churn, unit_number(bits_of(a)))
PAPILLA_K3(k_clamp, clamp_to(a, b, c))
PAPILLA_K1(k_clampunit, clamp_to(a, 0, 1))
PAPILLA_K6(k_coldist, (a - d) * (a - d) + (b - e) * (b - e) + (c - f) * (c - f))
PAPILLA_K4(k_dist, std::sqrt((a - c) * (a - c) + (b - d) * (b - d)))
PAPILLA_K1(k_floor, std::floor(a))
PAPILLA_K2(k_gain, b < 0.5 ? bias(1 - a, 2 * b) / 2 : 1 - bias(1 - a, 2 - 2 * b) / 2)
PAPILLA_K3(k_hue, hue_of(a, b, c))
PAPILLA_K3(k_saturation, quotient(std::max({a, b, c}) - std::min({a, b, c}), std::max({a, b, c})))
PAPILLA_K3(k_value, std::max({a, b, c}))
PAPILLA_K2(k_heartbeat, modulo(a, b) > b / 2 ? finite(std::sin(quotient(modulo(a, b) * 4 * k_pi, b))) : 0)
PAPILLA_K3(k_hsv_red, hsv_part(a, b, c, 5))
PAPILLA_K3(k_hsv_green, hsv_part(a, b, c, 3))
PAPILLA_K3(k_hsv_blue, hsv_part(a, b, c, 1))
PAPILLA_K2(k_huedist, 0.5 - std::abs(modulo(a - b, 1) - 0.5))
PAPILLA_K3(k_interpolate, a + c * (b - a))
PAPILLA_K6(k_linedist, segment_distance(a, b, c, d, e, f))
PAPILLA_K1(k_log, a > 0 ? std::log(a) : 0)
PAPILLA_K2(k_max, a > b ? a : b)
PAPILLA_K2(k_min, a < b ? a : b)
PAPILLA_K2(k_mod, modulo(a, b))
PAPILLA_K4(k_moddist, 1 - 1.7 * std::hypot(a - modulo(c, 1), b - modulo(d, 1)))
PAPILLA_K6(k_ovaldist, std::hypot(quotient(e - a, c), quotient(f - b, d)))
PAPILLA_K2(k_power, power(a, b))
PAPILLA_K3(k_pulse, (c >= a ? 1 : 0) - (c >= b ? 1 : 0))
PAPILLA_K6(k_rectangledist, std::max(outside(a, c, e), outside(b, d, f)))
PAPILLA_K6(k_rectangledist2, outside(a, c, e) + outside(b, d, f))
PAPILLA_K4(k_region, unit_number(mix_bits(cell_of(c* a), cell_of(d* b), 29)))
PAPILLA_K3(k_random, unit_number(mix_bits(cell_of(a), cell_of(b), 31 + cell_of(c))))
PAPILLA_K1(k_sine, finite(std::sin(a)))
PAPILLA_K4(k_smoothpulse, smooth(a, b, d) - smooth(c, c + b - a, d))
PAPILLA_K3(k_smoothstep, smooth(a, b, c))
PAPILLA_K1(k_square_root, a > 0 ? std::sqrt(a) : 0)
PAPILLA_K2(k_step, a >= b ? 1 : 0)
PAPILLA_K1(k_tangent, finite(std::tan(a)))

constexpr double k_zeros[k_row] = {};

void k_noise1(double* out, const double* const* in, int n) { noise_row(in[0], k_zeros, n, {.shift_y = 0.37}, out); }
void k_noise2(double* out, const double* const* in, int n) { noise_row(in[0], in[1], n, {}, out); }
void k_noise3(double* out, const double* const* in, int n) { noise_row(in[0], in[1], in[2], n, {}, out); }

/// Sum of octaves over 1 to 3 dimensions; the last input is the number of octaves at each point.
template <int dimensions, bool absolute>
void k_turbulence(double* out, const double* const* in, int n) {
  const double* octaves = in[dimensions];
  double most = 0;
  for (int i = 0; i < n; ++i) most = std::max(most, octaves[i]);
  most = std::min(std::ceil(most), k_most_octaves);
  std::fill_n(out, n, 0.0);
  double noise[k_row], depth[k_row];
  double frequency = 1;
  for (int k = 0; k < static_cast<int>(most); ++k, frequency *= 2) {
    // The shift keeps the zeros of the lattices from meeting.
    const Octave octave{.frequency_x = frequency,
                        .frequency_y = frequency,
                        .shift_x = 0.171875 * k,
                        .shift_y = 0.37 + 0.328125 * k,
                        .seed = static_cast<std::uint32_t>(k)};
    if constexpr (dimensions == 3) {
      for (int i = 0; i < n; ++i) depth[i] = in[2][i];
      noise_row(in[0], in[1], depth, n, octave, noise);
    } else {
      noise_row(in[0], dimensions == 2 ? in[1] : k_zeros, n, octave, noise);
    }
    for (int i = 0; i < n; ++i) {
      const double part = octaves[i] - k, weight = (part < 1 ? (part > 0 ? part : 0) : 1) / frequency;
      out[i] += weight * (absolute ? std::abs(noise[i]) : noise[i]);
    }
  }
}

constexpr KernelInfo k_kernels[] = {{"+", 2, k_add, ""},
                                    {"-", 2, k_subtract, ""},
                                    {"*", 2, k_multiply, ""},
                                    {"/", 2, k_divide, ""},
                                    {"%", 2, k_mod, ""},
                                    {"^", 2, k_power, ""},
                                    {"negate", 1, k_negate, ""},
                                    {"square", 1, k_square, ""},
                                    {"cube", 1, k_cube, ""},
                                    {"abs", 1, k_absolute, ""},
                                    {"absturbulence", 2, k_turbulence<1, true>, ""},
                                    {"absturbulence2d", 3, k_turbulence<2, true>, ""},
                                    {"absturbulence3d", 4, k_turbulence<3, true>, ""},
                                    {"acos", 1, k_arc_cosine, ""},
                                    {"atan", 1, k_arc_tangent, ""},
                                    {"bias", 2, k_bias, ""},
                                    {"boxstep", 3, k_boxstep, ""},
                                    {"c", 1, k_cosine, ""},
                                    {"churn", 1, k_churn, ""},
                                    {"clamp", 3, k_clamp, ""},
                                    {"clampunit", 1, k_clampunit, ""},
                                    {"coldist", 6, k_coldist, ""},
                                    {"dist", 2, k_dist, "uv"},
                                    {"floor", 1, k_floor, ""},
                                    {"gain", 2, k_gain, ""},
                                    {"gethsvhue", 3, k_hue, ""},
                                    {"gethsvsaturation", 3, k_saturation, ""},
                                    {"gethsvvalue", 3, k_value, ""},
                                    {"heartbeat", 2, k_heartbeat, ""},
                                    {"hsv_red", 3, k_hsv_red, ""},
                                    {"hsv_green", 3, k_hsv_green, ""},
                                    {"hsv_blue", 3, k_hsv_blue, ""},
                                    {"huedist", 2, k_huedist, ""},
                                    {"interpolate", 3, k_interpolate, ""},
                                    {"linedist", 4, k_linedist, "uv"},
                                    {"log", 1, k_log, ""},
                                    {"max", 2, k_max, ""},
                                    {"min", 2, k_min, ""},
                                    {"mod", 2, k_mod, ""},
                                    {"moddist", 2, k_moddist, "uv"},
                                    {"noise", 1, k_noise1, ""},
                                    {"noise2d", 2, k_noise2, ""},
                                    {"noise3d", 3, k_noise3, ""},
                                    {"ovaldist", 4, k_ovaldist, "uv"},
                                    {"pow", 2, k_power, ""},
                                    {"pulse", 3, k_pulse, ""},
                                    {"random", 3, k_random, ""},
                                    {"rectangledist", 4, k_rectangledist, "uv"},
                                    {"rectangledist2", 4, k_rectangledist2, "uv"},
                                    {"region", 2, k_region, "uv"},
                                    {"s", 1, k_sine, ""},
                                    {"smoothpulse", 4, k_smoothpulse, ""},
                                    {"smoothstep", 3, k_smoothstep, ""},
                                    {"sqrt", 1, k_square_root, ""},
                                    {"step", 2, k_step, ""},
                                    {"tan", 1, k_tangent, ""},
                                    {"turbulence", 2, k_turbulence<1, false>, ""},
                                    {"turbulence2d", 3, k_turbulence<2, false>, ""},
                                    {"turbulence3d", 4, k_turbulence<3, false>, ""}};

}  // namespace

const KernelInfo* find_kernel(std::string_view name) noexcept {
  const auto it =
      std::find_if(std::begin(k_kernels), std::end(k_kernels), [&](const KernelInfo& k) { return k.name == name; });
  return it == std::end(k_kernels) ? nullptr : it;
}

std::string_view kernel_name(Kernel kernel) noexcept {
  return std::find_if(std::begin(k_kernels), std::end(k_kernels),
                      [&](const KernelInfo& k) { return k.kernel == kernel; })
      ->name;
}

}  // namespace papilla::procedural_detail
