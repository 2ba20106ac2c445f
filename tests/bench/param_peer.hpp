// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla::bench {

/// What a program beside this one made of a mesh.
struct PeerMap {
  double cpu_seconds = 0, peak_mib = 0;
  CornerAttribute<Vec2> uv;
};

/// Runs the program that the environment variable PAPILLA_PARAM_PEER names, for maps that no packaged library has:
///     PROGRAM METHOD MESH.off RESULT
/// writes "cpu_seconds peak_mib" and then a line "u v" per vertex to RESULT; cpu_seconds from arrays in memory to
/// arrays in memory. Methods of one chart: lscm, slim20 (20 iterations), slimconv (until the energy falls by less than
/// 1e-5, 300 iterations at most).
/// @return nothing without such a program, when it fails, or when its uv are not finite.
std::optional<PeerMap> peer_map(const std::string& method, const TriangleMesh& mesh);

/// The same for methods that make charts of their own (xatlas): a line "u v" per corner of every triangle.
std::optional<PeerMap> peer_atlas(const std::string& method, const TriangleMesh& mesh);

}  // namespace papilla::bench
