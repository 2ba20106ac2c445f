// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/vec.hpp"

namespace papilla {

/// Where the hand wants to be: positions over time, straight in between, at rest before and after.
class Trajectory {
 public:
  struct Sample {
    double t = 0;   ///< s
    Vec3 position;  ///< m
  };

  /// @throws InvalidInput naming the sample when there is none, a number is not finite, or times don't increase.
  explicit Trajectory(std::vector<Sample> samples);

  /// The position at time t; a sample's own time gives the sample's position exactly. O(log n), noexcept.
  Vec3 position(double t) const noexcept;

  double start_s() const noexcept { return samples_.front().t; }
  double end_s() const noexcept { return samples_.back().t; }
  const std::vector<Sample>& samples() const noexcept { return samples_; }

 private:
  std::vector<Sample> samples_;
};

/// Reads CSV whose first four columns are t, x, y, z in seconds and metres; further columns are ignored, so that a
/// recording is a trajectory as well. A first line that starts with no number is a heading; empty lines and lines
/// that start with # are skipped. Numbers have a decimal point in every locale.
/// @param name what messages call the text.
/// @throws InvalidInput naming name:line and the reason.
Trajectory parse_trajectory(std::string_view csv, const std::string& name);

}  // namespace papilla
