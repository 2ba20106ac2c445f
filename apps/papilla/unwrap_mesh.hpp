// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "papilla/core/vec.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/param/flattening.hpp"

namespace papilla::app {

struct UnwrapRequest {
  std::string method = "auto";      ///< auto, triplanar, lscm.
  bool keep_charts = false;         ///< Take each component as one chart instead of segmenting.
  double feature_angle_deg = 40;    ///< Edges sharper than this are seams.
  Vec2 tile_mm{0, 0};               ///< Repeat of the grain; its phase continues over seams where possible. 0: unknown.
  UpAxis up = UpAxis::z;
};

struct UnwrapSeconds {
  double segment = 0, solve = 0, pack = 0;
  double total() const { return segment + solve + pack; }
};

struct UnwrapOutcome {
  Flattening flattening;  ///< uv in millimetres, grain upright, charts placed for tiling.
  std::string method;     ///< The method that was used.
  std::string reason;     ///< Why, when the request left it open.
  UnwrapSeconds seconds;
};

/// Charts, flattens and places one mesh: the composition that `unwrap` and `bake` share.
/// @param mesh repaired: welded, oriented, manifold.
/// @throws InvalidInput when the mesh does not fit the method; SolverFailure when it has no answer.
UnwrapOutcome unwrap_mesh(const TriangleMesh& mesh, const UnwrapRequest& request);

}  // namespace papilla::app
