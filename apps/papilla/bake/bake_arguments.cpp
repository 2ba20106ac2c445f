// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake_arguments.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "exit_code.hpp"
#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "json/touch_json.hpp"
#include "option_checks.hpp"
#include "options/environment_option.hpp"
#include "options/material_library_option.hpp"
#include "options/unwrap_option.hpp"
#include "page/page_report.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/io/named_files.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "result_folder.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"
#include "text/touch_text.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr const char *k_mpeg = "MPEG_material_haptic", *k_khr = "KHR_physics_rigid_bodies";

/// The page, report.json, what hands feel of it, and pictures if they are wanted; what they are and took is added to
/// the JSON.
/// @param page  with the environment that lights the scene.
void write_report(const BakeOutputs& options, const Materials& rules, const BakeResult& result,
                  const PageSceneOptions& page, const VerbContext& context, const Stopwatch& total, Json& json) {
  const fs::path folder = options.report;
  if (options.pictures) {
    const Stopwatch clock;
    const auto light = page.environment ? std::make_shared<const EnvironmentLight>(*page.environment) : nullptr;
    json["pictures"] = write_bake_pictures(result, folder, light, context.progress);
    json["seconds"]["pictures"] = clock.seconds();
  }
  const Stopwatch touching;
  const TouchReport touch = report_touch(rules, result.plan.surfaces, result.grains, options.touch);
  json["touch"] = touch_json(touch);
  json["seconds"]["touch"] = touching.seconds();
  context.console.print(touch_text(touch));
  const Stopwatch clock;
  write_report_page(options.output, json, result.grains, folder / "index.html", page, context.progress);
  json["page"] = "index.html";
  json["seconds"]["page"] = clock.seconds();
  json["seconds"]["total"] = total.seconds();
  write_atomically(folder / "report.json", json_text(json));
  context.console.print(shown_format("{}: plan, distortion, times{}\n{}: the same to look at and to touch\n",
                                     (folder / "report.json").string(), options.pictures ? "; pictures beside it" : "",
                                     (folder / "index.html").string()));
}

}  // namespace

void BakeArguments::add_to(CLI::App& verb) {
  reads(verb.add_option("SCENE", input, "CAD, mesh or glTF file"))->type_name("IN");
  reads(verb.add_option("-m,--materials", materials, "MATERIALS.json: what surfaces look and feel like"))
      ->type_name("FILE");
  reads(verb.add_option("--library", libraries, "Files of named recipes, on top of the built-in ones"))
      ->type_name("FILE");
  add_material_library(verb, material_library);
  verb.add_flag("--keep-copies", bake.bake.plan.keep_copies, "Do not make identical parts instances of one");
  add_effort(verb, bake.bake.unwrap.method.effort);
  verb.add_option("--budget", bake.bake.plan.budget,
                  "Triangles that the scene may draw: simplified with the smallest common tolerance that meets it")
      ->type_name("N")
      ->check(positive());
  verb.add_option("--mirror", mirrors,
                  "Repeat what the haptic tags say in drafts of others' extensions, as far as they have a place for it")
      ->type_name("NAME")
      ->transform(one_of({k_mpeg, k_khr}));
  verb.add_flag("--strict", bake.bake.plan.strict, "Refuse rules that take no surface");
  perception.add_to(verb);
  sides.add_to(verb);
  scene.add_to(verb);
  stored.add_to(verb);
}

Materials BakeArguments::rules() const { return read_materials(materials, material_library); }

BakeFileOptions BakeArguments::options(const fs::path& output, const VerbContext& context) const {
  const auto mirrored = [&](const char* name) { return std::count(mirrors.begin(), mirrors.end(), name) > 0; };
  BakeFileOptions wanted = bake;
  wanted.bake.plan.perception = perception.options();
  wanted.bake.plan.sides = sides.options(output);
  wanted.read = scene.read_options(context.cache);
  wanted.bake.unwrap.method.deadline = wanted.bake.plan.deadline = wanted.bake.plan.sides.deadline = context.deadline;
  wanted.bake.unwrap.method.cache = context.cache;
  wanted.read_deadline = context.read_deadline;
  wanted.write = stored.write_options(output.string());
  wanted.write.mirror_mpeg_haptics = mirrored(k_mpeg);
  wanted.write.mirror_khr_physics = mirrored(k_khr);
  wanted.bake.library = load_recipes(libraries);
  return wanted;
}

void BakeOutputs::add_to(CLI::App& verb) {
  writes(verb.add_option("-o,--output", output, "GLB to write, or .gltf with files beside it"))->type_name("OUT");
  auto* const folder =
      writes_into(verb.add_option("--report", report, "Folder for a page to look at (index.html) and report.json"),
                  {"index.html", "report.json"});
  folder->type_name("DIR");
  add_environment(verb, environment)->needs(folder);
  verb.add_flag("--pictures", pictures,
                "Pictures into the report's folder, too: the scene, a checker, close-ups, uv layouts, reliefs")
      ->needs(folder);
  add_stroke_speed(verb, touch);
}

Json write_bake(const BakeArguments& arguments, const BakeOutputs& options, BakeFileOptions wanted,
                VerbContext& context) {
  if (!is_gltf_file(options.output)) throw UsageError("--output: '" + options.output + "' must end in .glb or .gltf");
  wanted.for_pictures = wanted.bake.surface_maps = options.pictures;
  std::optional<ResultFolder> report;  // Before the work: a wrong path is known at once.
  if (!options.report.empty()) report.emplace(options.report);
  const Stopwatch total;
  const Materials rules = arguments.rules();
  PageSceneOptions page;
  if (!options.environment.empty()) page.environment = read_environment(options.environment, k_scene_environment_width);
  const BakeFileResult result = bake_file(arguments.input, options.output, rules, wanted, context.progress);

  const std::size_t triangles = drawn_triangles(result.scene), bytes = size_with_named_files(options.output);
  Json json = bake_json(result, wanted.bake);
  json["way"] = way_json(result.way);
  json["changes"] = changes_json(result.changes);
  json["rules"] = rules_json(result.plan.rules);
  json["contact"] = contact_models_json(rules);
  json["output"] = {{"file", options.output}, {"bytes", bytes}, {"triangles", triangles}};
  Json stored = storage_json(wanted.write, result.sizes);
  if (result.way.in_place) stored.erase("meshes"), stored.erase("images");  // They are the file's own.
  json["output"].update(stored);
  context.console.print(way_line(result.way) + sides_text(result.plan.sides, true) +
                        left_out_table(result.scene, result.plan.perception));
  if (const auto& budget = result.plan.budget)
    context.console.print(shown_format("budget of {} triangles: {} within {:.3g} mm{}\n", *wanted.bake.plan.budget,
                                       budget->triangles, budget->tolerance_mm,
                                       budget->reached                          ? ""
                                       : budget->stop == StopReason::time_limit ? ", not reached in time"
                                                                                : "; more deviation saves hardly any"));
  context.console.print(bake_table(result) + object_textures_text(result.object_textures) +
                        contact_models_text(rules, result.plan.surfaces));
  print_notes(result.scene, context.console);
  context.console.print(changes_line(result.changes));
  context.console.print(storage_text(wanted.write, result.sizes));
  context.console.print(
      shown_format("{}: {} triangles, {:.1f} MB\n", options.output, triangles, static_cast<double>(bytes) / 1e6));
  if (!options.report.empty()) write_report(options, rules, result, page, context, total, json);
  return json;
}

}  // namespace papilla::app
