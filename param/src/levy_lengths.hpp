// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include "levy_rows.hpp"
#include "map_energy.hpp"
#include "rest_shape.hpp"
#include "sparse_cholesky.hpp"

namespace papilla::param_detail {

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

}  // namespace papilla::param_detail
