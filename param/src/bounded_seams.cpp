// SPDX-License-Identifier: MIT
#include "papilla/param/bounded_seams.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "bound_keeper.hpp"
#include "papilla/core/error.hpp"

namespace papilla {
namespace {

using namespace param_detail;

/// Maps that a search usually makes of the mesh that it begins with, and of each finer one.
constexpr double k_usual_maps = 100, k_usual_maps_when_brief = 60, k_usual_maps_of_finer = 6;

/// Of all of them.
double usual_triangles(const TriangleMesh& mesh, const SeamTools& tools) {
  const auto triangles = static_cast<double>(mesh.triangles.size());
  const CoarseSurface* coarse = tools.coarse ? tools.coarse(0) : nullptr;
  if (!coarse) return (tools.brief ? k_usual_maps_when_brief : k_usual_maps) * triangles;
  return k_usual_maps_of_finer * triangles + usual_triangles(coarse->mesh, coarse->tools);
}

void check(const DistortionBound& bound) {
  const auto refuse = [](const std::string& what) { throw InvalidInput("keep_bound: " + what); };
  if (!(bound.most >= 4 && std::isfinite(bound.most)))
    refuse("the bound is " + std::to_string(bound.most) + ", it must be at least 4");
  if (bound.percentile && !(*bound.percentile > 0 && *bound.percentile <= 100))
    refuse("percentile " + std::to_string(*bound.percentile) + " does not lie in (0, 100]");
}

}  // namespace

BoundedSeams keep_bound(const TriangleMesh& mesh, const DistortionBound& bound, const SeamTools& tools,
                        Deadline deadline, const ProgressCallback& progress) {
  check(bound);
  const Stopwatch clock;
  SeamTrace trace(clock, usual_triangles(mesh, tools), progress);
  BoundKeeper keeper(mesh, bound, tools, deadline, trace);
  SeamState best = keeper.search();
  BoundedSeams result;
  result.kept = keeper.keeps(best);
  result.distortion = best.distortion;
  result.seam_mm = best.seam_mm;
  result.seam_cost_mm = best.cost_mm;
  result.trace = trace.take();
  if (deadline.passed()) result.stop = StopReason::time_limit;
  result.charted = std::move(best.charted);
  return result;
}

}  // namespace papilla
