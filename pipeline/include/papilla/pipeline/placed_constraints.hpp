// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papilla/param/levy.hpp"

namespace papilla {

/// The vertex nearest to a place gets this uv [mm].
struct PlacedPin {
  Vec3 position;
  Vec2 uv;
  std::string part = {};  ///< Pattern of names (* and ? match); empty: every part.
};

/// The vertices along shortest paths of edges between those nearest to the points share their u, or their v.
struct PlacedIsoLine {
  std::vector<Vec3> points;
  bool is_u = true;
  std::optional<double> value;  ///< [mm]; not given: found.
  std::string part;             ///< As in PlacedPin.
};

/// Whether what is meant for `pattern` is meant for the part of this name.
bool is_for_part(const std::string& pattern, const std::string& part);

/// The vertex of the mesh. Equal positions must be one vertex. Cost: O(n).
LevyPin pin_on(const TriangleMesh& mesh, const PlacedPin& pin);

/// The vertices of the mesh, in order. Equal positions must be one vertex. Cost: O(n log n) per pair of points.
/// @throws InvalidInput, naming the point, when no path of edges leads to it from the one before.
LevyIsoLine iso_line_on(const TriangleMesh& mesh, const PlacedIsoLine& line);

}  // namespace papilla
