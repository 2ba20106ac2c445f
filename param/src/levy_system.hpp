// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "levy_rows.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {

/// One coordinate of every vertex: a free unknown, perhaps shared with others, or a fixed value.
struct Unknowns {
  static constexpr Index k_fixed = ~Index{0};
  std::vector<Index> of_vertex;  ///< k_fixed: not free.
  std::vector<double> value;     ///< Per vertex: the fixed value, or the current one.
  Index count = 0;
};

/// Minimises Σ (smoothness row)² + Σ (length row)² + Σ (orthogonality row)² over one coordinate, others being held.
class LevySystem {
 public:
  struct Weights {
    double smoothness, orthogonality, length;
  };

  LevySystem(const ChartSurface& chart, const LinearRows& smoothness, const LinearRows& length, Weights weights,
             const Unknowns& unknowns);

  /// Factors and solves; the symbolic part is that of the first call.
  void solve(std::span<const std::array<double, 3>> orthogonality, Unknowns& unknowns);

  /// Gauss-Seidel sweeps on the same normal equations, until one changes the sum by less than `tolerance`.
  /// @return sweeps made.
  int sweep(std::span<const std::array<double, 3>> orthogonality, Unknowns& unknowns, int most, double tolerance) const;

 private:
  struct Row {
    std::span<const Index> vertex;
    std::span<const double> coefficient;
    double weight;
  };
  std::size_t row_count() const { return smoothness_.count() + length_.count() + chart_.triangles.size(); }
  Row row(std::size_t r, std::span<const std::array<double, 3>> orthogonality) const;

  const ChartSurface& chart_;
  const LinearRows &smoothness_, &length_;
  Weights weights_;
  Elements elements_;  ///< The free unknowns of each row.
  std::vector<Vec3> where_;
  std::unique_ptr<SparseCholesky<double>> factor_;
};

/// Values that make every smoothness row zero, given fixed values at all other vertices. `symmetric`: c(i,k) = c(k,i).
/// @return false when the system is singular.
bool solve_smooth(const ChartSurface& chart, const LinearRows& rows, bool symmetric, std::vector<Vec2>& uv);

}  // namespace papilla::param_detail
