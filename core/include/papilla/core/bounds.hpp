// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "papilla/core/vec.hpp"

namespace papilla {

/// The lesser, or greater, of each coordinate.
constexpr Vec2 lower(Vec2 a, Vec2 b) noexcept { return {std::min(a.x, b.x), std::min(a.y, b.y)}; }
constexpr Vec2 upper(Vec2 a, Vec2 b) noexcept { return {std::max(a.x, b.x), std::max(a.y, b.y)}; }
constexpr Vec3 lower(Vec3 a, Vec3 b) noexcept { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
constexpr Vec3 upper(Vec3 a, Vec3 b) noexcept { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

/// The smallest axis-aligned box around all that was added; empty at first. The unit is the owner's. Coordinates that
/// are not a number are ignored.
template <class Vec>
struct Bounds {
  Vec low = everywhere(std::numeric_limits<double>::infinity());
  Vec high = everywhere(-std::numeric_limits<double>::infinity());

  constexpr void add(Vec p) noexcept {
    low = lower(low, p);
    high = upper(high, p);
  }
  constexpr void add(const Bounds& other) noexcept {
    low = lower(low, other.low);
    high = upper(high, other.high);
  }

  constexpr bool is_empty() const noexcept { return !(low.x <= high.x); }
  /// Zero when empty, as middle() and diagonal() are.
  constexpr Vec size() const noexcept { return is_empty() ? Vec{} : high - low; }
  constexpr Vec middle() const noexcept { return is_empty() ? Vec{} : 0.5 * (low + high); }
  double diagonal() const noexcept { return norm(size()); }

  /// True when no more than `margin` lies between the two along any axis.
  constexpr bool overlaps(const Bounds& other, double margin) const noexcept {
    return all_at_most(low, other.high, margin) && all_at_most(other.low, high, margin);
  }
  /// True when `other` lies within, by more than `margin` on every side.
  constexpr bool contains(const Bounds& other, double margin = 0) const noexcept {
    return all_below(low, other.low, margin) && all_below(other.high, high, margin);
  }

 private:
  static constexpr Vec2 of(double value, Vec2) noexcept { return {value, value}; }
  static constexpr Vec3 of(double value, Vec3) noexcept { return {value, value, value}; }
  static constexpr Vec everywhere(double value) noexcept { return of(value, Vec{}); }
  static constexpr bool all_at_most(Vec2 a, Vec2 b, double margin) noexcept {
    return a.x - margin <= b.x && a.y - margin <= b.y;
  }
  static constexpr bool all_at_most(Vec3 a, Vec3 b, double margin) noexcept {
    return a.x - margin <= b.x && a.y - margin <= b.y && a.z - margin <= b.z;
  }
  static constexpr bool all_below(Vec3 a, Vec3 b, double margin) noexcept {
    return a.x + margin < b.x && a.y + margin < b.y && a.z + margin < b.z;
  }
};

using Bounds2 = Bounds<Vec2>;
using Bounds3 = Bounds<Vec3>;

}  // namespace papilla
