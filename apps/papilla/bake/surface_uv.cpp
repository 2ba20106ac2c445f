// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/surface_uv.hpp"

#include <fmt/core.h>

#include <map>

#include "papilla/core/trace.hpp"
#include "papilla/param/pack.hpp"
#include "unwrap/unwrap.hpp"

namespace papilla::app {
namespace {

/// How many charts each method got.
std::string by_chart(const std::vector<ChartChoice>& choices) {
  std::map<std::string, std::size_t> count;
  for (const ChartChoice& choice : choices) ++count[choice.method];
  std::string text;
  for (const auto& [method, charts] : count)
    text += fmt::format("{}{} {}", text.empty() ? "charts: " : ", ", charts, method);
  return text;
}

}  // namespace

SurfaceUv make_surface_uv(const TriangleMesh& mesh, const std::string& wanted, Vec2 tile_mm, UpAxis up) {
  MethodOptions options;
  options.method = unwrap_methods().at(wanted);
  PartContext context;
  context.up = up;
  context.tile_mm = tile_mm;
  const Stopwatch clock;
  FlattenedPart part = flatten_part(mesh, context, options);
  SurfaceUv result;
  result.segment_seconds = part.segment_seconds;
  result.flattening = std::move(part.flattening);
  result.method = part.method;
  result.reason = wanted != "auto"      ? "as the material says"
                  : part.reason.empty() ? by_chart(part.choices)
                                        : part.reason;
  AlignedPhase aligned = align_phase(mesh, result.flattening, {.tile_mm = tile_mm});
  result.flattening.uv = std::move(aligned.uv);
  result.grain_continued_mm = aligned.continued_mm;
  result.flatten_seconds = clock.seconds() - result.segment_seconds;
  return result;
}

}  // namespace papilla::app
