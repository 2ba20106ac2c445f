// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace papilla::procedural_detail {

/// Most points that a cell may hold.
inline constexpr int k_most_cell_points = 16;

enum class CellDistance { squared, manhattan, minkowski };

struct CellOptions {
  CellDistance distance = CellDistance::squared;
  double power_a = 1, power_b = 1;         ///< Of minkowski.
  int wanted = 1;                          ///< How many distances, 1 to 4.
  std::array<std::uint8_t, 256> counts{};  ///< Points of a cell by the low byte of its hash.
  double smooth = 0;                       ///< 1: all points in the middle of their cells.
  int displace_mode = 0;
  double displace = 0;
  double period_x = 0, period_y = 0;  ///< In cells, whole numbers; 0: does not repeat.
  std::uint32_t seed = 0;
};

/// A point near a texel.
struct CellHit {
  double x, y, dx, dy, id;
};

/// Distances to the nearest points of Worley's cells of side 1.
/// distance[k][i], k < wanted, ascending in k, no larger than on entry.
/// @param hits  null, or wanted x n entries for the nearest points, hits[k * n + i].
/// Looks at the cell and its two rings, and so finds all points up to one cell away plus the part within the cell.
/// Cost: points are made once a cell and run, then wanted comparisons a point and texel.
void cell_row(const double* raw_x, const double* raw_y, int n, const CellOptions& o, double* const* distance,
              CellHit* hits);

template <CellDistance metric>
double distance_of(double dx, double dy, double a, double b) noexcept {
  if constexpr (metric == CellDistance::squared) return dx * dx + dy * dy;
  if constexpr (metric == CellDistance::manhattan) return std::abs(dx) + std::abs(dy);
  return std::pow(std::abs(dx), a) + std::pow(std::abs(dy), b);
}

/// The same of a metric that is known late. @param a, b powers of minkowski.
inline double distance_of(CellDistance metric, double dx, double dy, double a, double b) noexcept {
  switch (metric) {
    case CellDistance::squared: return distance_of<CellDistance::squared>(dx, dy, a, b);
    case CellDistance::manhattan: return distance_of<CellDistance::manhattan>(dx, dy, a, b);
    case CellDistance::minkowski: break;
  }
  return distance_of<CellDistance::minkowski>(dx, dy, a, b);
}

}  // namespace papilla::procedural_detail
