// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_budget.hpp"

namespace papilla::app {

std::size_t drawn_triangles(const Scene& scene) {
  std::size_t triangles = 0;
  for (const Instance& use : instances(scene)) triangles += scene.parts[use.part].mesh.triangles.size();
  return triangles;
}

BudgetResult fit_scene_to_budget(const Scene& scene, std::size_t max_triangles, const SimplifyOptions& options) {
  std::vector<BudgetPart> parts;
  for (const Part& part : scene.parts) parts.push_back({&part.mesh, 1, 0});
  for (const Instance& use : instances(scene)) ++parts[use.part].instances;
  return simplify_to_budget(parts, max_triangles, options);
}

Json budget_json(const Scene& scene, std::size_t wanted, const BudgetResult& budget) {
  Json trace = Json::array(), parts = Json::array();
  for (const TraceSample& s : budget.trace) trace.push_back({{"seconds", s.seconds}, {"error", s.error}});
  for (std::size_t i = 0; i < budget.parts.size(); ++i)
    parts.push_back({{"name", scene.parts[i].name},
                     {"triangles_before", budget.parts[i].triangles_before},
                     {"triangles_after", budget.parts[i].mesh.triangles.size()},
                     {"max_deviation_mm", budget.parts[i].deviation.bound()},
                     {"max_deviation_met_mm", budget.parts[i].deviation.value()}});
  return {{"wanted", wanted},
          {"triangles", budget.triangles},
          {"reached", budget.reached},
          {"tolerance_mm", budget.tolerance_mm},
          {"trace", trace},
          {"parts", parts}};
}

}  // namespace papilla::app
