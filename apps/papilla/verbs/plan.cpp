// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <memory>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/materials_json.hpp"
#include "json/scene_json.hpp"
#include "json/touch_json.hpp"
#include "options/material_library_option.hpp"
#include "options/perception_option.hpp"
#include "options/scene_option.hpp"
#include "options/side_option.hpp"
#include "options/touch_option.hpp"
#include "papilla/core/error.hpp"
#include "papilla/pipeline/material_library.hpp"
#include "papilla/pipeline/material_suggestion.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "text/materials_text.hpp"
#include "text/scene_text.hpp"
#include "text/touch_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string input, materials, library;
  bool strict = false;
  PerceptionOption perception;
  SideOption sides;
  SceneOptions scene;
  bool keep_copies = false;
  TouchOptions touch;
};

/// What of the library may suit the surfaces that get no material; says why where the library can't be read.
Json suggest(const PlannedFile& plan, const Options& options, const Console& console) {
  const auto has_none = [](const PartSurface& surface) { return surface.material.empty(); };
  if (std::none_of(plan.surfaces.begin(), plan.surfaces.end(), has_none)) return Json::array();
  try {
    const MaterialLibrary library(options.library.empty() ? find_material_library()
                                                          : std::filesystem::path(options.library));
    const std::vector<MaterialSuggestion> suggestions =
        suggest_materials(plan.scene, plan.surfaces, library.materials());
    console.print(suggestions_text(suggestions));
    return suggestions_json(suggestions);
  } catch (const Error& error) {
    console.print(shown_format("\nno material is suggested: {}\n", error.what()));
    return nullptr;
  }
}

std::size_t count_unwrapped(const PlannedFile& plan) {
  return static_cast<std::size_t>(
      std::count_if(plan.surfaces.begin(), plan.surfaces.end(),
                    [](const PartSurface& surface) { return decision(surface.plan, Stage::unwrap).run; }));
}

/// What a bake would find in the cache.
std::string remembered_text(const PlannedFile& plan) {
  const RememberedPlan& found = plan.remembered;
  if (found.surfaces.empty()) return {};
  std::string text = shown_format("from the cache: {} of {} grains, the uv of {} of {} surfaces", found.grains.size(),
                                  grains_of(plan.surfaces).size(),
                                  std::count(found.surfaces.begin(), found.surfaces.end(), 1), count_unwrapped(plan));
  constexpr std::size_t k_most_named = 8;
  std::size_t named = 0;
  for (std::size_t i = 0; i < plan.surfaces.size(); ++i) {
    if (found.surfaces[i] != 0 || !decision(plan.surfaces[i].plan, Stage::unwrap).run) continue;
    if (named++ < k_most_named)
      text += shown_format("{}{}", named == 1 ? "; to be made: " : ", ", plan.surfaces[i].label);
  }
  if (named > k_most_named) text += shown_format(" and {} more", named - k_most_named);
  return text + "\n";
}

Json remembered_json(const PlannedFile& plan) {
  Json surfaces = Json::array(), missing = Json::array();
  for (std::size_t i = 0; i < plan.surfaces.size(); ++i)
    if (decision(plan.surfaces[i].plan, Stage::unwrap).run)
      (plan.remembered.surfaces[i] != 0 ? surfaces : missing).push_back(plan.surfaces[i].label);
  return {{"grains", plan.remembered.grains}, {"uv", surfaces}, {"uv_to_be_made", missing}};
}

Json run(const Options& options, VerbContext& context) {
  BakeFileOptions wanted;
  wanted.read = options.scene.read_options(context.cache);
  wanted.bake.plan.perception = options.perception.options();
  wanted.bake.plan.sides = options.sides.options();
  wanted.bake.unwrap.method.cache = wanted.bake.plan.sides.cache = context.cache;
  wanted.bake.plan.keep_copies = options.keep_copies;
  const Materials rules = read_materials(options.materials, options.library);
  const PlannedFile plan = plan_file(options.input, rules, wanted, context.progress);
  context.console.print(way_line(plan.way) + plan_table(plan.surfaces) + grains_text(plan.grains) +
                        contact_models_text(rules, plan.surfaces) + rules_table(plan.rules, rules) +
                        sides_text(plan.sides, true) + left_out_table(plan.scene, plan.perception) +
                        object_textures_text(plan.object_textures_made) + remembered_text(plan));
  const TouchReport touch = report_touch(rules, plan.surfaces, {}, options.touch);
  context.console.print(touch_text(touch));
  print_notes(plan.scene, context.console);
  Json json{{"scene", options.input}, {"materials", options.materials}, {"stages", plan_json(plan.surfaces)}};
  json["way"] = way_json(plan.way);
  json["grains"] = grain_plans_json(plan.grains);
  json["contact"] = contact_models_json(rules);
  json["touch"] = touch_json(touch);
  if (context.cache != nullptr) json["remembered"] = remembered_json(plan);
  json["uv"] = own_uv_json(plan.surfaces);
  json["rules"] = rules_json(plan.rules);
  json["suggestions"] = suggest(plan, options, context.console);
  json["identical_parts"] = shared_parts_json(plan.shared, plan.scene);
  json["sides"] = sides_json(plan.sides, wanted.bake.plan.sides);
  json["object_textures"] = object_textures_json(plan.object_textures_made, plan.object_textures);
  json["losses"] = plan.scene.losses;
  json["warnings"] = plan.scene.warnings;
  if (wanted.bake.plan.perception.asked()) json["perception"] = perception_json(plan.scene, plan.perception);
  const auto took_nothing = [](const RuleUse& rule) { return !rule.problem.empty(); };
  const auto some_took_nothing = [&](const std::vector<RuleUse>& rules_used) {
    return std::any_of(rules_used.begin(), rules_used.end(), took_nothing);
  };
  if (options.strict && (some_took_nothing(plan.rules) || some_took_nothing(plan.object_textures.decal_uses) ||
                         some_took_nothing(plan.object_textures.carrier_uses))) {
    context.exit_code = k_exit_input;
    json["error"] = "a rule takes no surface";
  }
  return json;
}

}  // namespace

void add_plan(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"plan",
                             "Show what bake would do, surface by surface, and why, and what the cache has of it; "
                             "writes no file.",
                             "papilla plan data/cockpit.step -m examples/materials.json",
                             VerbInfo::AtDeadline::is_cancelled, VerbInfo::Remembers::yes},
                            [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("SCENE", options->input, "CAD, mesh or glTF file"))->type_name("IN")->required();
  reads(verb->add_option("-m,--materials", options->materials, "MATERIALS.json"))->type_name("FILE")->required();
  add_material_library(*verb, options->library);
  verb->add_flag("--keep-copies", options->keep_copies, "Do not make identical parts instances of one");
  verb->add_flag("--strict", options->strict, "Exit with 3 when a rule takes no surface");
  options->perception.add_to(*verb);
  options->sides.add_to(*verb);
  add_stroke_speed(*verb, options->touch);
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
