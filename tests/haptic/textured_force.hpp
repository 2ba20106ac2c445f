// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "haptic/contact_shapes.hpp"
#include "papilla/haptic/force_model.hpp"
#include "papilla/haptic/proxy.hpp"

namespace papilla::testing {

/// An analytic relief over a square of `size` metres, from 0 to `top`, with its gradient.
struct AnalyticRelief {
  double size, top;
  std::function<double(double, double)> height;
};

/// Waves of 2 mm along x.
inline AnalyticRelief sine_relief() {
  constexpr double size = 0.04, wave = 2e-3, amplitude = 5e-5;
  return {size, 2 * amplitude,
          [=](double x, double) { return amplitude * (1 + std::sin(2 * std::numbers::pi * x / wave)); }};
}

/// Spheres of radius 1.5 mm, 2 mm apart and 0.2 mm high, with a foot whose radius of curvature (0.4 mm) is well above
/// the depth of the probe.
inline AnalyticRelief sphere_relief() {
  constexpr double size = 0.02, pitch = 2e-3, radius = 1.5e-3, top = 2e-4;
  return {size, top, [=](double x, double y) {
            const double u = x - pitch * std::round(x / pitch), v = y - pitch * std::round(y / pitch);
            const double h = std::sqrt(std::max(0.0, radius * radius - u * u - v * v)) - radius + top;
            // A smooth foot with a continuous gradient: h²/(4w) around zero.
            constexpr double w = 6e-5;
            return h > w ? h : h < -w ? 0.0 : (h + w) * (h + w) / (4 * w);
          }};
}

struct ForceError {
  double rms_share = 0;  ///< Root mean square of the force's error over that of the force.
  double speed = 0;
};

/// Presses a point into the relief and moves it at `speed`. The reference is the closest point of the analytic surface,
/// found by descent in double precision from the last one.
inline ForceError force_error(const AnalyticRelief& relief, int pixels, double speed, int ticks) {
  std::vector<std::uint16_t> samples;
  for (int j = 0; j < pixels; ++j)
    for (int i = 0; i < pixels; ++i) {
      const double x = (i + 0.5) / pixels * relief.size, y = (j + 0.5) / pixels * relief.size;
      samples.push_back(static_cast<std::uint16_t>(std::lround(65535 * relief.height(x, y) / relief.top)));
    }
  HeightFieldOptions options;
  options.scale_m = relief.top;
  ContactMaterial material;
  material.stiffness = 500;
  material.height = 0;
  const ContactSurface surface(plate(20, 20, relief.size, relief.size), {material},
                               {HeightField(pixels, pixels, samples, options)}, 0);
  Proxy proxy(surface);
  const auto slope = [&](double x, double y, double dx, double dy) {
    constexpr double e = 1e-7;
    return (relief.height(x + e * dx, y + e * dy) - relief.height(x - e * dx, y - e * dy)) / (2 * e);
  };
  double error2 = 0, force2 = 0;
  Vec3 reference;
  for (int i = 0; i < ticks; ++i) {
    const double way = speed * 1e-3 * i;
    const double margin = relief.size / 8, stretch = relief.size - 2 * margin;
    const double x = margin + std::fmod(0.8 * way, stretch), y = margin + std::fmod(0.6 * way, stretch);
    const bool jumped = i == 0 || norm(Vec2{x - reference.x, y - reference.y}) > 1e-3;
    const Vec3 probe{x, y, relief.height(x, y) - 1e-4};
    if (jumped) {
      proxy.reset({x, y, 2e-3});
      reference = {x, y, relief.height(x, y)};
    }
    const ProxyState& state = proxy.update(probe, 1e-3);
    const Vec3 force = heightfield_force(surface, state, probe, {});
    // min (u − x)² + (v − y)² + (h(u, v) − z)², by damped fixed-point steps.
    for (int k = 0; k < 400; ++k) {
      const double lift = relief.height(reference.x, reference.y) - probe.z;
      const double gx = reference.x - x + lift * slope(reference.x, reference.y, 1, 0);
      const double gy = reference.y - y + lift * slope(reference.x, reference.y, 0, 1);
      reference.x -= 0.3 * gx;
      reference.y -= 0.3 * gy;
    }
    reference.z = relief.height(reference.x, reference.y);
    const Vec3 expected = material.stiffness * (reference - probe);
    if (jumped) continue;
    error2 += dot(force - expected, force - expected);
    force2 += dot(expected, expected);
  }
  return {std::sqrt(error2 / force2), speed};
}

}  // namespace papilla::testing
