// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/core/vec.hpp"
#include "papilla/texture/feature_matrix.hpp"

namespace papilla::texture_detail {

/// A feature matrix as correlation: c(t) = 1 − d²(t) / mean(d²), smoothed by a Gaussian of about one pixel, so that
/// c averages 0 and is 1 at a perfect repetition.
class CorrelationMap {
 public:
  explicit CorrelationMap(const FeatureMatrix& matrix);

  int reach_x() const noexcept { return reach_x_; }
  int reach_y() const noexcept { return reach_y_; }
  /// False when the picture is flat: then there is nothing to correlate.
  bool usable() const noexcept { return usable_; }
  /// Share of the variance that is not white pixel noise, in [0, 1]: c extrapolated to t = 0.
  double attainable() const noexcept { return attainable_; }

  double at(int dx, int dy) const { return values_[index(dx, dy)]; }
  /// Whether a bilinear look-up is possible at t.
  bool contains(Vec2 t) const;
  double sample(Vec2 t) const;  ///< Bilinear. @pre contains(t)
  /// The vertex of the parabola through the 3 × 3 values around a grid point that is a local maximum.
  Vec2 refined_peak(int dx, int dy) const;
  /// Local maxima (3 × 3) of the half plane dy > 0 or (dy = 0, dx > 0), further than 2 pixels from the origin.
  std::vector<Vec2> peaks() const;
  /// The local maximum reached by climbing from t, at most 3 steps, sub-pixel; t itself when there is none.
  Vec2 climb(Vec2 t) const;

 private:
  std::size_t index(int dx, int dy) const {
    return static_cast<std::size_t>(dy + reach_y_) * static_cast<std::size_t>(2 * reach_x_ + 1) +
           static_cast<std::size_t>(dx + reach_x_);
  }
  bool is_peak(int dx, int dy) const;
  void smooth();

  int reach_x_, reach_y_;
  bool usable_ = false;
  double attainable_ = 0;
  std::vector<double> values_;
};

}  // namespace papilla::texture_detail
