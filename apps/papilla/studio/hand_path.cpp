// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/hand_path.hpp"

namespace papilla::app {

void HandPath::add(const Trajectory::Sample& sample) {
  const std::scoped_lock lock(mutex_);
  if (samples_.size() >= k_most || (!samples_.empty() && !(sample.t > samples_.back().t))) return;
  samples_.push_back(sample);
}

void HandPath::lift(double t) {
  const std::scoped_lock lock(mutex_);
  if (!lifted_) lifted_ = t;
}

void HandPath::clear() {
  const std::scoped_lock lock(mutex_);
  samples_.clear();
  lifted_.reset();
}

Vec3 HandPath::position(double t) {
  const std::scoped_lock lock(mutex_);
  while (samples_.size() > 1 && samples_[1].t <= t) samples_.pop_front();
  const Trajectory::Sample& a = samples_.front();
  if (samples_.size() == 1 || t <= a.t) return a.position;
  const Trajectory::Sample& b = samples_[1];
  return a.position + ((t - a.t) / (b.t - a.t)) * (b.position - a.position);
}

bool HandPath::is_begun() const {
  const std::scoped_lock lock(mutex_);
  return !samples_.empty();
}

double HandPath::begin_s() const {
  const std::scoped_lock lock(mutex_);
  return samples_.front().t;
}

double HandPath::newest_s() const {
  const std::scoped_lock lock(mutex_);
  return samples_.back().t;
}

std::optional<double> HandPath::lifted_s() const {
  const std::scoped_lock lock(mutex_);
  return lifted_;
}

}  // namespace papilla::app
