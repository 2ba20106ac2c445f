// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace papilla::texture_detail {

/// Limited-memory BFGS on top of a preconditioner H₀ in place of the usual scaled identity, in the compact form
///   H = H₀ + [S H₀Y] [R⁻ᵀ(D + YᵀH₀Y)R⁻¹, −R⁻ᵀ; −R⁻¹, 0] [S H₀Y]ᵀ,
/// S the last steps, Y the changes of the gradient, R the upper triangle of SᵀY, D its diagonal: every step reads the
/// pairs twice and applies H₀ once. The pairs are most of the memory and only shape the next direction: floats.
/// Byrd, Nocedal and Schnabel, Representations of quasi-Newton matrices, 1994, equation 3.1.
class CurvatureMemory {
 public:
  using Field = std::vector<double>;

  /// Takes the step `scale` · `direction` from where the gradient was `before.gradient`; a pair of no positive
  /// curvature is not kept.
  struct Slope {
    const Field& gradient;
    const Field& preconditioned;  ///< H₀ · gradient.
  };
  void add(double scale, const Field& direction, const Slope& before, const Slope& now);

  /// −H · gradient of the last slope added (the first: no pair). @return its product with the gradient.
  double direction(const Slope& now, Field& result) const;

 private:
  static constexpr std::size_t k_most_pairs = 4;
  using Row = std::array<double, k_most_pairs>;

  void drop_oldest();

  struct Pair {
    std::vector<float> step, change;  ///< s and H₀ y.
  };
  std::size_t count_ = 0;
  std::array<Pair, k_most_pairs> pairs_;        ///< The oldest first.
  std::array<Row, k_most_pairs> sy_{}, yhy_{};  ///< sᵢᵀyⱼ for i ≤ j; yᵢᵀH₀yⱼ.
  Row sg_{}, yhg_{};                            ///< sᵢᵀg and yᵢᵀH₀g of the last gradient.
};

}  // namespace papilla::texture_detail
