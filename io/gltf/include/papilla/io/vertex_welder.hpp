// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// Numbers points so that points equal in every bit share a number (−0 counts as 0). No tolerance: points that
/// differ in the last bit stay apart. The numbers follow the order of first appearance.
/// Cost: constant per point (a hash table with linear probing), 24 bytes per distinct point plus 4 to 16 of table.
/// @pre finite coordinates.
class VertexWelder {
 public:
  explicit VertexWelder(std::size_t expected_points = 0);

  /// The number of the point, new or known.
  /// @throws std::length_error when there are 2^32 − 1 distinct points.
  Index add(Vec3 point);

  /// numbers[i] = add(points[i]), faster than one by one: the memory of many is fetched at the same time.
  /// @pre numbers.size() == points.size().
  /// @throws std::length_error as add().
  void add(std::span<const Vec3> points, std::span<Index> numbers);

  const Values<Vec3>& points() const noexcept { return points_; }
  Values<Vec3> take_points() noexcept { return std::move(points_); }

 private:
  void reserve_slots(std::size_t further_points);
  std::size_t slot_of(Vec3 point, std::size_t first) const noexcept;
  Index add_at(Vec3 point, std::size_t first_slot);

  Values<Vec3> points_;
  std::vector<Index> table_;
};

}  // namespace papilla
