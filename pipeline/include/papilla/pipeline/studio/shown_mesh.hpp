// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "papilla/meshing/triangle_mesh.hpp"
#include "papilla/param/measure.hpp"

namespace papilla {

/// A surface as a graphics card takes it: corners that agree in place, normal and uv (and uv1) share a vertex.
struct ShownMesh {
  std::vector<float> positions;        ///< 3 a vertex, mm.
  std::vector<float> normals;          ///< 3 a vertex, unit.
  std::vector<float> uv;               ///< 2 a vertex, v upwards; 0 where a triangle has none.
  std::vector<float> uv1;              ///< The second ones likewise; empty: not asked for.
  std::vector<float> measured;         ///< 2 a vertex: stretch L2, angle error in degrees; -1 where not measured.
  std::vector<std::uint32_t> indices;  ///< 3 a triangle.
  std::vector<float> seams;            ///< 6 a piece: the edges at which uv jump or end, mm.
};

/// Normals are the mesh's own, or vertex_normals(). Distortion is averaged by area at the vertices.
/// Cost: O(n log n). Deterministic.
/// @param report of measure_distortion() with its triangles, or without: then nothing is measured.
/// @param has_uv1 the second texture coordinates are asked for.
ShownMesh shown_mesh(const TriangleMesh& mesh, const DistortionReport& report = {}, bool has_uv1 = false);

/// What is shown as a mesh of one slot, whose corners have normals, uv, and uv1 where these are there.
TriangleMesh triangle_mesh(const ShownMesh& shown);

}  // namespace papilla
