// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/materials_file.hpp"
#include "bake/plan.hpp"
#include "leave_out.hpp"
#include "papilla/io/scene.hpp"
#include "shared_parts.hpp"

namespace papilla::app {

/// The triangles of one part that share one material: what a rule is assigned to and a plan is made for.
struct Surface {
  std::uint32_t part = 0;
  std::uint32_t slot = 0;                ///< Of Part::materials.
  std::vector<std::uint32_t> triangles;  ///< Of the part's mesh, ascending.
  const MaterialRule* rule = nullptr;    ///< nullptr: nothing is assigned.
  double uv_mm_per_unit = 0;             ///< Millimetres of surface per unit of its own uv; 0 without uv.
  std::string uv_note;                   ///< What was found about its own uv.
  bool is_left_out = false;              ///< With its whole part.
  SurfacePlan plan;
  std::string label;  ///< "part", or "part/material" when the part has several materials.
};

/// The rule of a part's material slot, or nullptr. What `rules` assigns by the names of part and material and by
/// colour.
const MaterialRule* assigned_rule(const Scene& scene, const Part& part, std::size_t slot, const MaterialsFile& rules);

/// Finds the surfaces of a scene, assigns the rules and plans every surface.
/// `rules` must outlive the result. @param perception Of the scene's parts; empty when nothing was asked.
std::vector<Surface> plan_surfaces(const Scene& scene, const MaterialsFile& rules,
                                   const std::vector<PartPerception>& perception = {});

/// Makes identical parts that are assigned the same rules one part, so that each class is baked once.
std::vector<SharedPart> share_identical_parts(Scene& scene, const MaterialsFile& rules);

/// {part, material, stage, run, reason} a line.
nlohmann::ordered_json plan_json(const std::vector<Surface>& surfaces);

/// A table for people: one row a surface, the stages that run, and why the others do not.
std::string plan_table(const std::vector<Surface>& surfaces);

/// "#rrggbb" in sRGB of a linear colour.
std::string hex_colour(const std::array<double, 4>& linear);

/// A linear colour of "#rrggbb" in sRGB.
std::array<double, 4> linear_colour(const std::string& hex);

}  // namespace papilla::app
