// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "chart_pieces.hpp"
#include "papilla/param/levy.hpp"

namespace papilla::param_detail {

/// Linear conditions (Σ coefficient · value)² on the values of a chart's vertices.
struct LinearRows {
  std::vector<Index> first{0}, vertex;
  std::vector<double> coefficient;
  std::size_t count() const { return first.size() - 1; }
  void add(std::span<const Index> vertices, std::span<const double> coefficients);
  double value(std::size_t row, std::span<const double> x) const;
};

/// Σ_i c(i,k) ν_i for every interior vertex k; the last entry of a row is that of k.
LinearRows smoothness_rows(const ChartSurface& chart, LevyWeights weights);

/// The jump of the derivative across every interior edge, times √((A_1 + A_2) / 3) / h and √S of a chart of area 1; see
/// flatten_levy().
LinearRows length_rows(const ChartSurface& chart);

/// √A ∇ν·∇w for every triangle, for given values w: coefficients per triangle and corner.
std::vector<std::array<double, 3>> orthogonality_rows(const ChartSurface& chart, std::span<const double> w);

}  // namespace papilla::param_detail
