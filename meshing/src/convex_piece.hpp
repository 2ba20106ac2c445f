// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "papilla/core/vec.hpp"

namespace papilla::detail {

/// A planar convex polygon in space with at most 12 corners.
class ConvexPiece {
 public:
  static constexpr std::size_t k_capacity = 12;

  ConvexPiece() = default;
  ConvexPiece(const Vec3& a, const Vec3& b, const Vec3& c) : corners_{a, b, c}, size_(3) {}

  std::size_t size() const noexcept { return size_; }
  const Vec3& operator[](std::size_t i) const noexcept { return corners_[i]; }
  std::span<const Vec3> corners() const noexcept { return {corners_.data(), size_}; }
  void add(const Vec3& p) noexcept { corners_[size_++] = p; }

  Vec3 centre() const noexcept {
    Vec3 sum;
    for (const Vec3& p : corners()) sum = sum + p;
    return (1.0 / static_cast<double>(size_)) * sum;
  }

  /// Both sides of the plane normal . (p - origin) = 0; the one it points to comes second. A side that would not reach
  /// farther than `slack` (times the normal's length) from the plane stays empty, as does the side behind when rounding
  /// makes the outline cross the plane more than twice. With up to 11 corners.
  struct Halves;
  Halves cut(const Vec3& origin, const Vec3& normal, double slack) const noexcept;

 private:
  std::array<Vec3, k_capacity> corners_;
  std::size_t size_ = 0;
};

struct ConvexPiece::Halves {
  ConvexPiece behind, ahead;
};

inline ConvexPiece::Halves ConvexPiece::cut(const Vec3& origin, const Vec3& normal, double slack) const noexcept {
  std::array<double, k_capacity> height;
  bool has_behind = false, has_ahead = false;
  const auto crosses = [](double a, double b) { return (a < 0 && b > 0) || (a > 0 && b < 0); };
  for (std::size_t i = 0; i < size_; ++i) {
    height[i] = dot(corners_[i] - origin, normal);
    has_behind |= height[i] < -slack;
    has_ahead |= height[i] > slack;
  }
  std::size_t sign_changes = 0;
  for (std::size_t i = 0, last = size_ - 1; i < size_; last = i++)
    sign_changes += (height[i] <= 0) != (height[last] <= 0);
  Halves halves;
  if (!has_behind || !has_ahead || sign_changes > 2) {
    (has_ahead ? halves.ahead : halves.behind) = *this;
    return halves;
  }
  for (std::size_t i = 0; i < size_; ++i) {
    const std::size_t j = i + 1 == size_ ? 0 : i + 1;
    if (height[i] <= 0) halves.behind.add(corners_[i]);
    if (height[i] >= 0) halves.ahead.add(corners_[i]);
    if (crosses(height[i], height[j])) {
      const Vec3 p = corners_[i] + (height[i] / (height[i] - height[j])) * (corners_[j] - corners_[i]);
      halves.behind.add(p);
      halves.ahead.add(p);
    }
  }
  return halves;
}

}  // namespace papilla::detail
