// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "papilla/core/vec.hpp"

namespace papilla::testing {

/// From (x, z) to the closest point of the curve (a, height(a)), by a scan no wider than it can be far, and golden
/// sections.
template <class Height>
Vec3 way_to_curve(const Height& height, double x, double z) {
  constexpr int steps = 4000;
  constexpr double k_golden = 0.382;
  const auto square = [&](double a) { return (a - x) * (a - x) + std::pow(height(a) - z, 2); };
  const double far = std::abs(height(x) - z) + 1e-6;
  const auto at = [&](int i) { return x + far * (2.0 * i / steps - 1); };
  int best = 0;
  for (int i = 0; i <= steps; ++i)
    if (square(at(i)) < square(at(best))) best = i;
  double low = at(best - 1), high = at(best + 1);
  for (int i = 0; i < 80; ++i) {
    const double a = low + k_golden * (high - low), b = high - k_golden * (high - low);
    if (square(a) < square(b))
      high = b;
    else
      low = a;
  }
  const double a = 0.5 * (low + high);
  return {a - x, 0, height(a) - z};
}

}  // namespace papilla::testing
