// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/surface_uv.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "papilla/core/trace.hpp"
#include "papilla/param/pack.hpp"
#include "unwrap/unwrap.hpp"

namespace papilla::app {
namespace {

double bounding_diagonal(const TriangleMesh& mesh) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity}, high = -low;
  for (const Vec3& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return mesh.positions.empty() ? 0 : norm(high - low);
}

void choose_method(const TriangleMesh& mesh, const std::string& wanted, Vec2 tile_mm, SurfaceUv& result) {
  if (wanted != "auto") {
    result.method = wanted;
    result.reason = "as the material says";
    return;
  }
  const double tile = std::max(tile_mm.x, tile_mm.y), extent = bounding_diagonal(mesh);
  result.method = extent < tile ? "triplanar" : "lscm";
  result.reason = fmt::format("its extent of {:.3g} mm is {} than one repeat of the grain", extent,
                              extent < tile ? "less" : "more");
}

}  // namespace

SurfaceUv make_surface_uv(const TriangleMesh& mesh, const std::string& wanted, Vec2 tile_mm, UpAxis up) {
  SurfaceUv result;
  choose_method(mesh, wanted, tile_mm, result);
  MethodOptions options;
  options.method = result.method == "triplanar" ? UnwrapMethod::triplanar : UnwrapMethod::lscm;
  const Stopwatch clock;
  result.flattening =
      flatten_part(mesh, up == UpAxis::z ? GrainUp::z : GrainUp::y, tile_mm, options, result.segment_seconds);
  AlignedPhase aligned = align_phase(mesh, result.flattening, {.tile_mm = tile_mm});
  result.flattening.uv = std::move(aligned.uv);
  result.grain_continued_mm = aligned.continued_mm;
  result.flatten_seconds = clock.seconds() - result.segment_seconds;
  return result;
}

}  // namespace papilla::app
