// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "border_guard.hpp"
#include "chart_pieces.hpp"
#include "disk_hierarchy.hpp"
#include "rest_shape.hpp"

namespace papilla::param_detail {

/// A triangle of next to no area, and its own shape.
struct Sliver {
  Index triangle;
  RestShape shape;
};

/// One state of a hierarchy, or a whole chart, as a mesh of its own, and the map of it.
struct MapLevel {
  std::vector<Index> vertices;  ///< Their numbers in the chart.
  std::vector<Triangle> triangles;
  std::vector<RestShape> rest;
  std::vector<Sliver> slivers;  ///< Triangles whose rest shape has more area than they have themselves.
  std::vector<BorderPair> border;
  std::vector<Vec2> uv;
  double area = 0;  ///< Of the rest shapes.
};

/// @param uv of all vertices of the chart.
MapLevel current_level(const DiskHierarchy& hierarchy, std::span<const Vec3> positions, std::span<const Vec2> uv,
                       LeastArea least_area);

/// The whole chart, its triangles with their own shapes.
MapLevel whole_level(const ChartSurface& chart, std::vector<Vec2> uv);

/// What keeps the level's border away from itself, as the map is now.
BorderBarrier barrier_of(const MapLevel& level);

/// Moves one vertex after the other to lower the symmetric Dirichlet energy, every one at most once per sweep, until a
/// sweep gains less than `tolerance` of the energy. No triangle turns over. Chunks of vertices with consecutive numbers
/// are moved side by side, those with a neighbour in a later chunk after them: the same for any number of threads.
/// @param guarded the border does not run into itself either.
/// @return how many sweeps were made: one when the map was smooth already.
int relax(MapLevel& level, int sweeps, double tolerance, bool guarded);

/// Gives the slivers their own shapes, and moves the vertex opposite to each one's longest edge to where that shape
/// puts it, unless that raises the energy.
void restore_slivers(MapLevel& level, bool guarded);

}  // namespace papilla::param_detail
