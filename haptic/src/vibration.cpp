// SPDX-License-Identifier: MIT
#include "papilla/haptic/vibration.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla {
namespace {

constexpr double k_fade_s = 5e-3;
constexpr double k_steepest = 3;  // Of a height from sample to sample; beyond, charts meet.
constexpr double k_ripple_db = 0.1;
constexpr int k_low_pass_sections = 4;  // Of order 2 each.
constexpr double k_least_load_n = 1e-3;

/// A filter of order 2 in transposed direct form II.
struct Section {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0, z1 = 0, z2 = 0;

  double operator()(double x) noexcept {
    const double y = b0 * x + z1;
    z1 = b1 * x - a1 * y + z2;
    z2 = b2 * x - a2 * y;
    return y;
  }
};

/// s at which the bilinear transform gives that frequency, over 2·sample rate.
double warped(double hz, double sample_rate_hz) { return std::tan(std::numbers::pi * hz / sample_rate_hz); }

/// w²/(s² + d·s + w²), unity at 0, by the bilinear transform with s in units of 2·sample rate.
Section low_pass_section(double w2, double d) {
  const double a0 = 1 + d + w2;
  return {w2 / a0, 2 * w2 / a0, w2 / a0, 2 * (w2 - 1) / a0, (1 - d + w2) / a0};
}

Section butterworth_high_pass(double hz, double sample_rate_hz) {
  const double w = warped(hz, sample_rate_hz), d = std::numbers::sqrt2 * w, a0 = 1 + d + w * w;
  return {1 / a0, -2 / a0, 1 / a0, 2 * (w * w - 1) / a0, (1 - d + w * w) / a0};
}

std::array<Section, k_low_pass_sections> chebyshev_low_pass(double hz, double sample_rate_hz) {
  const double w = warped(hz, sample_rate_hz), ripple = std::sqrt(std::pow(10, k_ripple_db / 10) - 1);
  const double order = 2.0 * k_low_pass_sections, mu = std::asinh(1 / ripple) / order;
  std::array<Section, k_low_pass_sections> sections;
  for (int k = 0; k < k_low_pass_sections; ++k) {
    const double angle = std::numbers::pi * (2 * k + 1) / (2 * order);
    const double re = w * std::sinh(mu) * std::sin(angle), im = w * std::cosh(mu) * std::cos(angle);
    sections[static_cast<std::size_t>(k)] = low_pass_section(re * re + im * im, 2 * re);
  }
  // Unity at 0 is the bottom of the ripple: its middle is to be 1.
  const double gain = 2 / (1 + std::sqrt(1 + ripple * ripple));
  for (double Section::*numerator : {&Section::b0, &Section::b1, &Section::b2}) sections[0].*numerator *= gain;
  return sections;
}

/// Between b and c at share t, with the points before and after.
Vec3 catmull_rom(const std::array<VibrationTick, 4>& path, double t) {
  const Vec3 &a = path[0].proxy, &b = path[1].proxy, &c = path[2].proxy, &d = path[3].proxy;
  const Vec3 p1 = 0.5 * (c - a), p2 = a - 2.5 * b + 2 * c - 0.5 * d, p3 = 0.5 * (d - a) + 1.5 * (b - c);
  return b + t * (p1 + t * (p2 + t * p3));
}

void check(const VibrationOptions& options) {
  const auto require = [](bool holds, const char* name, double value) {
    if (!holds)
      throw InvalidInput(std::string("Vibration: ") + name + " " + std::to_string(value) + " is out of range");
  };
  require(options.rate_hz >= 100 && options.rate_hz <= 20000, "rate_hz", options.rate_hz);
  require(options.sample_rate_hz >= 8000 && options.sample_rate_hz <= 192000, "sample_rate_hz", options.sample_rate_hz);
  require(options.high_hz <= 0.4 * options.sample_rate_hz, "high_hz", options.high_hz);
  require(options.low_hz > 0 && options.low_hz < options.high_hz, "low_hz", options.low_hz);
  require(options.effective_mass_kg > 0 && std::isfinite(options.effective_mass_kg), "effective_mass_kg",
          options.effective_mass_kg);
}

}  // namespace

struct Vibration::State {
  State(const ContactSurface& surface_, const VibrationOptions& options_)
      : surface(&surface_),
        options(options_),
        high_pass(butterworth_high_pass(options_.low_hz / 3, options_.sample_rate_hz)),
        low_pass(chebyshev_low_pass(options_.high_hz, options_.sample_rate_hz)) {}

  /// The height where the path is, without what jumped.
  double height_at(Vec3 point) {
    const double reach = 2 * surface->contact_radius_m() + surface->tallest_relief_m();
    const auto base = surface->closest_point(point, 2 * reach);
    if (!base) return height;
    const double way = norm(base->point - last_base), now = base->height_m;
    const double tolerance = surface->tolerance_m();
    if (touching == 0 || std::abs(now - last_height) > k_steepest * way + tolerance) offset = height - now;
    last_base = base->point;
    last_height = now;
    return now + offset;
  }

  float sample(double t) {
    const bool touches = path[1].in_contact && path[2].in_contact;
    double a = 0;
    if (touches) {
      const double now = height_at(catmull_rom(path, t)), rate = options.sample_rate_hz;
      // The first two heights of a contact make no difference of second order: it began, and did not jump there.
      if (++touching > 2) a = (now - 2 * height + height_before) * rate * rate;
      height_before = std::exchange(height, now);
    } else {
      touching = 0;
    }
    a = high_pass(a);
    for (Section& section : low_pass) a = section(a);
    const double step = 1 / (k_fade_s * options.sample_rate_hz);
    fade = std::clamp(fade + (touches ? step : -step), 0.0, 1.0);
    const double load = (1 - t) * path[1].load_n + t * path[2].load_n;
    if (!(load > k_least_load_n)) return 0;
    const double most = load / options.effective_mass_kg, gain = 0.5 - 0.5 * std::cos(std::numbers::pi * fade);
    return static_cast<float>(gain * most * std::tanh(a / most));
  }

  const ContactSurface* surface;
  VibrationOptions options;
  Section high_pass;
  std::array<Section, k_low_pass_sections> low_pass;
  std::array<VibrationTick, 4> path{};  ///< The oldest first.
  int ticks = 0;
  double phase = 0;  ///< Of the next sample in the tick, in samples.
  int touching = 0;  ///< Samples since contact began.
  Vec3 last_base;
  double last_height = 0, offset = 0;
  double height = 0, height_before = 0;  ///< Of the two samples before.
  double fade = 0;
};

Vibration::Vibration(const ContactSurface& surface, const VibrationOptions& options) {
  check(options);
  state_ = std::make_unique<State>(surface, options);
}
Vibration::Vibration(Vibration&&) noexcept = default;
Vibration& Vibration::operator=(Vibration&&) noexcept = default;
Vibration::~Vibration() = default;

void Vibration::tick(const VibrationTick& now, std::vector<float>& samples) {
  State& s = *state_;
  if (s.ticks == 0) s.path.fill({now.proxy, 0, false});
  ++s.ticks;
  std::rotate(s.path.begin(), s.path.begin() + 1, s.path.end());
  s.path.back() = now;
  const double per_tick = s.options.sample_rate_hz / s.options.rate_hz;
  for (; s.phase < per_tick; s.phase += 1) samples.push_back(s.sample(s.phase / per_tick));
  s.phase -= per_tick;
}

}  // namespace papilla
