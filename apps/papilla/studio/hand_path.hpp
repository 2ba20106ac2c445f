// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

#include "papilla/haptic/trajectory.hpp"

namespace papilla::app {

/// Places of a pointer while it presses, as they come from a page: linear between them, constant before and after. One
/// thread adds, another reads.
class HandPath {
 public:
  static constexpr std::size_t k_most = 100000;  ///< Samples that wait; later ones are left out.

  /// @pre finite. One that is not later than the one before is left out.
  void add(const Trajectory::Sample& sample);
  /// The pointer is lifted at this time. Once; also before the samples up to there have come.
  void lift(double t);
  void clear();

  /// Where the hand is at `t` [m], which never runs back: what is older is forgotten. @pre is_begun().
  Vec3 position(double t);
  bool is_begun() const;
  double begin_s() const;  ///< Of the first sample. @pre is_begun().
  double newest_s() const;
  std::optional<double> lifted_s() const;

 private:
  mutable std::mutex mutex_;
  std::deque<Trajectory::Sample> samples_;
  std::optional<double> lifted_;
};

}  // namespace papilla::app
