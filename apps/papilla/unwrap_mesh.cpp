// SPDX-License-Identifier: GPL-3.0-or-later
#include "unwrap_mesh.hpp"

#include <fmt/core.h>

#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/meshing/components.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/pack.hpp"
#include "papilla/param/triplanar.hpp"

namespace papilla::app {
namespace {

GrainUp grain_up(UpAxis up) { return up == UpAxis::y ? GrainUp::y : GrainUp::z; }

double diagonal(const TriangleMesh& mesh) {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return mesh.positions.empty() ? 0 : norm(high - low);
}

/// Small parts show too little of the grain for distortion to matter, and projection makes fewer seams on them.
void choose_method(const TriangleMesh& mesh, const UnwrapRequest& request, UnwrapOutcome& outcome) {
  if (request.method != "auto") {
    outcome.method = request.method;
    outcome.reason = "as asked for";
    return;
  }
  const double tile = std::max(request.tile_mm.x, request.tile_mm.y), extent = diagonal(mesh);
  const bool small = extent < tile;
  outcome.method = small ? "triplanar" : "lscm";
  outcome.reason = fmt::format("its extent of {:.3g} mm is {} one repeat of the grain", extent, small ? "less than" : "more than");
}

}  // namespace

UnwrapOutcome unwrap_mesh(const TriangleMesh& mesh, const UnwrapRequest& request) {
  UnwrapOutcome outcome;
  choose_method(mesh, request, outcome);
  if (outcome.method == "triplanar") {
    TriplanarOptions options;
    options.up = grain_up(request.up);
    options.tile_mm = request.tile_mm;
    const Stopwatch clock;
    outcome.flattening = flatten_triplanar(mesh, options).flattening;
    outcome.seconds.solve = clock.seconds();
  } else {
    const Stopwatch segment_clock;
    SegmentationOptions segmentation;
    segmentation.feature_angle_deg = request.feature_angle_deg;
    const ChartSet charts = request.keep_charts ? component_charts(mesh) : segment_charts(mesh, segmentation).charts;
    outcome.seconds.segment = segment_clock.seconds();
    LscmOptions options;
    options.up = grain_up(request.up);
    const Stopwatch clock;
    outcome.flattening = flatten_lscm(mesh, charts, options);
    outcome.seconds.solve = clock.seconds();
  }
  const Stopwatch clock;
  PhaseOptions phase;
  phase.tile_mm = request.tile_mm;
  outcome.flattening.uv = align_phase(mesh, outcome.flattening, phase).uv;
  outcome.seconds.pack = clock.seconds();
  return outcome;
}

}  // namespace papilla::app
