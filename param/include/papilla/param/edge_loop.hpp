// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

struct EdgeLoopOptions {
  double feature_angle_deg = 30;  ///< Edges bent by more are seen as such; in [0, 180].
  double most_turn_deg = 45;      ///< The loop ends where it would have to turn by more; in [0, 180].
};

/// A line along which a surface ends or bends.
struct EdgeLoop {
  std::vector<Vec3> points;  ///< Two or more, in order; of a closed one the first is not repeated.
  bool is_closed = false;
};

/// The line of edges that is nearest to a place: of the border edges, those of three triangles and those bent by more
/// than the feature angle, the nearest one, followed both ways. At each vertex it goes on over the edge of these that
/// turns least, until there is none that turns by at most `most_turn_deg`, or until it comes back. Its direction is the
/// one in which its largest component, end to end, grows; of a closed one, that of the edge that was picked. Equal
/// positions must be one vertex. O(n log n); deterministic.
/// @throws InvalidInput when a position is not finite, an index or option is out of range, or the mesh has no such
///         edge.
EdgeLoop edge_loop_near(const TriangleMesh& mesh, Vec3 place, const EdgeLoopOptions& options = {});

/// The direction of length 1 in which the loop runs where it is nearest to p. O(points).
Vec3 direction_near(const EdgeLoop& loop, Vec3 p);

}  // namespace papilla
