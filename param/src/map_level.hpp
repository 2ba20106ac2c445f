// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "border_guard.hpp"
#include "disk_hierarchy.hpp"
#include "rest_shape.hpp"

namespace papilla::param_detail {

/// One state of a hierarchy as a mesh of its own, and the map of it.
struct MapLevel {
  std::vector<Index> vertices;  ///< Their numbers in the chart.
  std::vector<Triangle> triangles;
  std::vector<RestShape> rest;
  std::vector<BorderPair> border;
  std::vector<Vec2> uv;
  double area = 0;  ///< Of the rest shapes.
};

/// @param uv of all vertices of the chart.
/// @param least_area triangles count as having at least this area.
MapLevel current_level(const DiskHierarchy& hierarchy, std::span<const Vec3> positions, std::span<const Vec2> uv,
                       double least_area);

/// Moves one vertex after the other to lower the symmetric Dirichlet energy, every one at most once per sweep, until a
/// sweep gains less than `tolerance` of the energy. No triangle turns over.
/// @param guarded the border does not run into itself either.
/// @return how many sweeps were made: one when the map was smooth already.
int relax(MapLevel& level, int sweeps, double tolerance, bool guarded);

}  // namespace papilla::param_detail
