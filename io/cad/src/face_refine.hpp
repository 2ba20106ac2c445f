// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "face_patch.hpp"
#include "face_surface.hpp"

namespace papilla::cad {

/// What every triangle of a face has to keep.
struct RefineLimits {
  double chord = 0.1;       ///< Distance from the surface along its normal [mm].
  double angle = 0.35;      ///< Turn of the surface's normal along an edge [rad].
  double min_edge = 0;      ///< The angle is not asked of shorter edges [mm].
  double max_edge = 1e300;  ///< [mm].
  std::size_t max_triangles = 0;
};

/// How far an edge between two nodes of the patch exceeds the limits: 1 when it just keeps them. `middle` is the
/// surface at FacePatch::middle_uv. Gaps between the nodes and the surface do not count.
double edge_excess(const FacePatch& patch, Index a, Index b, const SurfaceSample& middle, const RefineLimits& limits);

/// Deviation of a face's triangles from its surface, on samples that the refinement did not use.
struct PatchDeviation {
  double distance = 0;  ///< Largest distance of a triangle's point from the surface [mm].
  double angle = 0;  ///< Largest turn of the surface's normal along an edge longer than RefineLimits::min_edge [rad].
};

/// Largest distance of a node from its surface, along the normal.
double largest_gap(const FacePatch& patch);

PatchDeviation measure_patch(const FacePatch& patch, const FaceSurface& surface, const RefineLimits& limits);

/// Splits edges inside of the face, and turns them towards Delaunay's, until the limits hold on dense samples. Boundary
/// edges stay as they are.
/// @return the number of nodes added.
std::size_t refine_patch(FacePatch& patch, const FaceSurface& surface, const RefineLimits& limits);

/// A node on the surface.
PatchNode surface_node(const FaceSurface& surface, Vec2 uv);

}  // namespace papilla::cad
