// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "chart_pieces.hpp"
#include "map_energy.hpp"
#include "papilla/param/levy.hpp"
#include "rest_shape.hpp"
#include "sparse_cholesky.hpp"

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

/// Rounds that ask for lengths along the directions that a map has: each minimises
///     Σ_T A |∇m - λ R_T|² + smoothness R,
/// R_T being the rotation nearest to ∇m of the round before and λ the mean length of the first map's gradients. The
/// matrix is the same in all rounds, and for u and v, so that it is factored once.
class LengthRounds {
 public:
  /// @param pins vertices that keep their place.
  LengthRounds(const ChartSurface& chart, double smoothness, const LinearRows& smoothness_rows,
               const std::vector<std::pair<Index, Vec2>>& pins, const std::vector<Vec2>& uv);

  /// @return whether the symmetric Dirichlet energy fell; if not, the map stays as it was.
  bool advance();

  /// Σ_T A |∇m - λ R_T|² of the map, with its own rotations.
  double length_error() const;
  std::vector<Vec2> uv() const;

 private:
  double energy_of(const std::vector<Vec2>& uv) const;
  void factor(double smoothness, const LinearRows& smoothness_rows, const std::vector<std::pair<Index, Vec2>>& pins);

  const ChartSurface& chart_;
  std::vector<RestShape> rest_;
  double scale_ = 1;  ///< λ; everything else is divided by it.
  std::vector<Vec2> uv_;
  std::vector<Index> number_;  ///< Of the unknown of each vertex.
  std::vector<Vec2> held_;     ///< Right side that comes of vertices that keep their place.
  std::unique_ptr<SparseCholesky<double>> factor_;
  double energy_ = 0;
};

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
