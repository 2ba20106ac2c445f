// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// Position of the hand over time: linear between samples, constant before and after.
class Trajectory {
 public:
  struct Sample {
    double t = 0;   ///< s
    Vec3 position;  ///< m
  };

  /// @throws InvalidInput naming the sample when there is none, a number is not finite, or times don't increase.
  explicit Trajectory(std::vector<Sample> samples);

  /// The position at time t, exact at the times of samples. O(log n), noexcept.
  Vec3 position(double t) const noexcept;

  double start_s() const noexcept { return samples_.front().t; }
  double end_s() const noexcept { return samples_.back().t; }
  const std::vector<Sample>& samples() const noexcept { return samples_; }

 private:
  std::vector<Sample> samples_;
};

/// Reads CSV whose first four columns are t, x, y, z in seconds and metres; further columns are ignored, so a recording
/// is a trajectory, too. A first line that does not start with a number is a heading; empty lines and lines that start
/// with # are skipped. The decimal separator is a point in every locale.
/// @param name of the text in messages.
/// @throws InvalidInput naming name:line and the reason.
Trajectory parse_trajectory(std::string_view csv, const std::string& name);

}  // namespace papilla
