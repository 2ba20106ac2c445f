// SPDX-License-Identifier: MIT
#include "vertex_step.hpp"

#include <limits>

namespace papilla::param_detail {
namespace {

constexpr int k_halvings = 10;

/// The parts of the energy that a step's slope promises between which the step for its logarithm is tried.
constexpr double k_far_promise = 0.3;
constexpr double k_most_promised = 0.75;

}  // namespace

double corner_energy(std::span<const CornerView> ring, Vec2 d) {
  double energy = 0;
  for (const CornerView& c : ring) {
    const Jacobian j{c.at_start.x + c.fx * d, c.at_start.y + c.fy * d};
    const double det = j.determinant();
    if (!(det > 0)) return std::numeric_limits<double>::infinity();
    energy += c.area * j.squared() * (1 + 1 / (det * det));
  }
  return energy;
}

Vec2 corner_step(std::span<const CornerView> ring) {
  double energy = 0, uu = 0, uv = 0, vv = 0;
  Vec2 gradient;
  for (const CornerView& c : ring) {
    const auto& [x, y] = c.at_start;
    const double inverse = 1 / cross(x, y), inverse2 = inverse * inverse, squared = c.at_start.squared();
    const double both = c.area * (1 + inverse2);
    energy += both * squared;
    const Vec2 by_squared = 2.0 * (c.fx * x + c.fy * y);
    const Vec2 by_det = c.fx * Vec2{y.y, -y.x} + c.fy * Vec2{-x.y, x.x};
    const double first = -2 * c.area * inverse2 * inverse, second = -3 * first * inverse * squared;
    gradient = gradient + both * by_squared + (first * squared) * by_det;
    const double diagonal = 2 * both * (c.fx * c.fx + c.fy * c.fy);
    uu += diagonal + 2 * first * by_squared.x * by_det.x + second * by_det.x * by_det.x;
    uv += first * (by_squared.x * by_det.y + by_squared.y * by_det.x) + second * by_det.x * by_det.y;
    vv += diagonal + 2 * first * by_squared.y * by_det.y + second * by_det.y * by_det.y;
  }
  // Shifted to be definite where the energy is not convex.
  const double mean = 0.5 * (uu + vv), radius = std::sqrt(0.25 * (uu - vv) * (uu - vv) + uv * uv);
  if (const double least = 0.01 * (mean + radius); mean - radius < least) {
    const double shift = least - (mean - radius);
    uu += shift, vv += shift;
  }
  const double det = uu * vv - uv * uv;
  if (!(det > 0)) return {};
  Vec2 step{-(vv * gradient.x - uv * gradient.y) / det, -(uu * gradient.y - uv * gradient.x) / det};
  // Newton's step for the logarithm goes further: from a wall like 1/x², three times as far.
  const double promised = std::min(-dot(gradient, step) / energy, k_most_promised);
  if (promised > k_far_promise) {
    const Vec2 longer = 1 / (1 - promised) * step;
    if (corner_energy(ring, longer) < (1 - promised) * energy) return longer;
  }
  for (int i = 0; i < k_halvings; ++i, step = 0.5 * step)
    if (corner_energy(ring, step) < energy) return step;
  return {};
}

}  // namespace papilla::param_detail
