// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "papilla/io/scene.hpp"
#include "papilla/meshing/triangle_budget.hpp"
#include "verb.hpp"

namespace papilla::app {

/// simplify_to_budget() of a scene's parts, each counted as often as it is drawn. Does not change the scene.
/// @throws InvalidInput naming the part.
BudgetResult fit_scene_to_budget(const Scene& scene, std::size_t max_triangles, const SimplifyOptions& options = {});

/// Triangles that a scene draws: of every part as many times as nodes show it.
std::size_t drawn_triangles(const Scene& scene);

/// {wanted, triangles, reached, tolerance_mm, trace[], parts[] {name, triangles_before, triangles_after,
/// max_deviation_mm, max_deviation_met_mm}}.
Json budget_json(const Scene& scene, std::size_t wanted, const BudgetResult& budget);

}  // namespace papilla::app
