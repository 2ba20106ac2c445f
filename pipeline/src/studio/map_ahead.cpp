// SPDX-License-Identifier: MIT
#include "studio/map_ahead.hpp"

#include <algorithm>
#include <utility>

#include "papilla/core/error.hpp"
#include "surface_bake.hpp"
#include "unwrap_ahead.hpp"

namespace papilla {

void map_ahead(Scene piece, const Materials& rules, const MaterialRule& rule, const BakeOptions& options,
               const WholeScene& whole) {
  if (options.unwrap.method.cache == nullptr || !(rule.size_mm[0] > 0 && rule.size_mm[1] > 0)) return;
  Grain grain;
  std::copy_n(rule.size_mm, 2, grain.size_mm);
  try {
    BakePlan plan = plan_bake(std::move(piece), rules, options.plan, {});
    for (PartSurface& surface : plan.surfaces) {
      if (!decision(surface.plan, Stage::unwrap).run) continue;
      if (whole.keeps_triangles) surface.plan[static_cast<std::size_t>(Stage::repair)].run = false;
      SurfaceInput input =
          surface_input(surface, rule, surface_mesh(plan.scene, surface), grain, whole.context, options.unwrap);
      unwrap_ahead(std::move(input.mesh), input.context, input.options);
    }
  } catch (const Error&) {  // The bake says it.
  }
}

}  // namespace papilla
