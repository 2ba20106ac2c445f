// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "map_level.hpp"

namespace papilla::param_detail {

/// A disk with its holes filled by fans around new vertices, and its one border that is left.
struct FilledDisk {
  std::vector<Triangle> triangles;
  std::vector<Vec3> where;    ///< The level's vertices, then the middles of the holes.
  std::vector<Index> border;  ///< In the order of the triangles: the longest one.
  std::vector<double> angle;  ///< Of each border vertex: a full turn in proportion to the length of the edges, as far
                              ///< as that leaves none too short.
  double border_length = 0;
};

FilledDisk fill_holes(const MapLevel& level, std::span<const Vec3> positions);

/// The shortest ways along edges from the border to each vertex.
struct BorderDistance {
  std::vector<double> depth;
  std::vector<Index> before;  ///< The vertex before on the way; of border vertices, itself.
};

BorderDistance border_distance(const FilledDisk& disk);

}  // namespace papilla::param_detail
