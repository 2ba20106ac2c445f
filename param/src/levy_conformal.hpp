// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "levy_rows.hpp"

namespace papilla::param_detail {

/// smoothness R + conformality Σ A |∇v - ∇u turned by 90°|² + length L over the complex numbers u + iv.
struct ConformalTerms {
  double smoothness = 0, conformality = 1, length = 0;
  const LinearRows* smoothness_rows = nullptr;
  const LinearRows* length_rows = nullptr;
};

/// Minimises the terms with the given vertices held, or, without any, among the maps of given inertia; of area 1 then.
/// @param pins none, or at least two.
/// @return false when the solution is not finite.
bool solve_conformal_terms(const ChartSurface& chart, const ConformalTerms& terms,
                           const std::vector<std::pair<Index, Vec2>>& pins, std::vector<Vec2>& uv);

double conformal_residual(const ChartSurface& chart, const std::vector<Vec2>& uv);

}  // namespace papilla::param_detail
