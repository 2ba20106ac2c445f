// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "papilla/core/vec.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/param/flattening.hpp"

namespace papilla::app {

struct SurfaceUv {
  double grain_continued_mm = 0;  ///< Length of the seam over which the grain goes on.
  Flattening flattening;  ///< uv in millimetres, grain upright, charts placed so that its phase goes on over seams.
  std::string method;     ///< A name of unwrap_methods().
  std::string reason;     ///< Why that one.
  double segment_seconds = 0, flatten_seconds = 0;
};

/// New uv for a surface with tiling grain.
/// @param mesh repaired.
/// @param wanted a name of unwrap_methods(); "auto" lets flatten_part() choose.
/// @throws InvalidInput, SolverFailure of the method.
SurfaceUv make_surface_uv(const TriangleMesh& mesh, const std::string& wanted, Vec2 tile_mm, UpAxis up);

}  // namespace papilla::app
