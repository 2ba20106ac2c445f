// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "papilla/core/trace.hpp"
#include "papilla/meshing/chart_set.hpp"
#include "papilla/meshing/triangle_mesh.hpp"

namespace papilla {

/// A chart for which the method that was asked for has no usable answer, and what was done instead.
struct ChartNote {
  std::uint32_t chart = 0;  ///< Number in the chart set the method was given.
  std::string reason;       ///< One line: what was wrong, where, and what the chart got instead.
};

/// What every flattening method returns: a map of the surface into the plane, chart by chart.
///
/// Guarantees of every producer: one uv per triangle corner, all finite, in millimetres; corners share a uv
/// value exactly when they are the same point of the same chart; charts keep their orientation
/// (a triangle that is counter-clockwise seen from outside is counter-clockwise in uv); triangles and
/// vertices keep their order. Charts lie where the method left them and may overlap one another:
/// align_phase() and pack_atlas() place them.
struct Flattening {
  CornerAttribute<Vec2> uv;  ///< Millimetres.
  ChartSet charts;           ///< Charts of `uv`; may be more than the method was given (see `notes`).
  StopReason stop = StopReason::direct;
  Trace trace;                   ///< The method says what its error is.
  std::vector<ChartNote> notes;  ///< Empty when every chart was mapped by the method that was asked for.
};

}  // namespace papilla
