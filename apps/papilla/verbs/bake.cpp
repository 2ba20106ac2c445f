// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/pipeline/bake_scene.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "bake/report.hpp"
#include "exit_code.hpp"
#include "page/page_report.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/glb_writer.hpp"
#include "papilla/pipeline/recipe_source.hpp"
#include "papilla/pipeline/simplify_scene.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr const char *k_mpeg = "MPEG_material_haptic", *k_khr = "KHR_physics_rigid_bodies";

struct Options {
  std::string input, materials, output, report;
  std::vector<std::string> libraries, mirrors;
  bool pictures = false;
  std::optional<std::size_t> budget;
  LeaveOutOptions leave_out;
  SceneOptions scene;

  GlbWriteOptions write_options() const {
    const auto mirrored = [&](const char* name) { return std::count(mirrors.begin(), mirrors.end(), name) > 0; };
    return {.mirror_mpeg_haptics = mirrored(k_mpeg), .mirror_khr_physics = mirrored(k_khr)};
  }
};

/// Makes the report's folder before the work, so that a wrong path is known at once.
void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) throw IoError(folder.string() + ": cannot be made a folder");
}

/// Brings what is not left out within the budget.
Json simplify_scene(Scene& scene, const LeaveOutResult& perception, std::size_t budget, const Console& console) {
  Scene drawn = scene;
  leave_out(drawn, perception);
  BudgetResult result = fit_scene_to_budget(drawn, budget);
  console.print(fmt::format("budget of {} triangles: {} within {:.3g} mm{}\n", budget, result.triangles,
                            result.tolerance_mm, result.reached ? "" : "; borders, seams and features allow no fewer"));
  Json json = budget_json(scene, budget, result);
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (perception.parts[i].left_out.empty()) scene.parts[i].mesh = std::move(result.parts[i].mesh);
  return json;
}

Json run_bake(const Options& options, VerbContext& context) {
  if (fs::path(options.output).extension() != ".glb")
    throw UsageError("--output: '" + options.output + "' must end in .glb");
  if (!options.report.empty()) prepare_folder(options.report);
  const Stopwatch total;
  const Materials rules = read_materials(options.materials);
  Scene scene = read_scene(options.input, options.scene.read_options(), context.progress);
  std::map<std::string, double> seconds = {{"read", total.seconds()}};
  const Stopwatch prepare_clock;
  const std::vector<SharedPart> shared = share_identical_parts(scene, rules);
  const Json identical = shared_parts_json(shared, scene);
  const LeaveOutResult perception = measure_perception(scene, options.leave_out, context.progress);
  const Json perceived = perception_json(scene, perception);
  context.console.print(left_out_table(scene, perception));
  seconds["leave_out"] = prepare_clock.seconds();
  const Json budget = options.budget ? simplify_scene(scene, perception, *options.budget, context.console) : Json();
  seconds["simplify"] = prepare_clock.seconds() - seconds["leave_out"];
  const std::vector<Surface> surfaces = plan_surfaces(scene, rules, perception.parts);
  leave_out(scene, perception);
  BakeResult result = bake(std::move(scene), surfaces, context.progress, load_recipes(options.libraries));
  result.seconds.merge(seconds);
  const Stopwatch write_clock;
  for (const std::string& loss : write_glb(result.scene, options.output, options.write_options()))
    result.scene.losses.push_back(loss);
  result.seconds["write"] = write_clock.seconds();

  Json json = bake_json(result, surfaces);
  json["identical_parts"] = identical;
  if (options.leave_out.asked()) json["perception"] = perceived;
  if (options.budget) json["budget"] = budget;
  const std::size_t triangles = drawn_triangles(result.scene);
  json["output"] = {{"file", options.output}, {"bytes", fs::file_size(options.output)}, {"triangles", triangles}};
  context.console.print(bake_table(result));
  print_notes(result.scene, context.console);
  context.console.print(fmt::format("{}: {} triangles, {:.1f} MB\n", options.output, triangles,
                                    static_cast<double>(fs::file_size(options.output)) / 1e6));
  if (options.pictures) {
    const Stopwatch pictures_clock;
    json["pictures"] = write_pictures(result, options.report, context.progress);
    result.seconds["pictures"] = pictures_clock.seconds();
  }
  result.seconds["total"] = total.seconds();
  json["seconds"] = result.seconds;
  if (!options.report.empty()) {
    const fs::path folder = options.report;
    const Stopwatch page_clock;
    write_report_page(options.output, json, folder / "index.html", context.progress);
    json["page"] = "index.html";
    json["seconds"]["page"] = page_clock.seconds();
    json["seconds"]["total"] = total.seconds();
    write_atomically(folder / "report.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    context.console.print((folder / "report.json").string() + ": plan, distortion, times" +
                          (options.pictures ? "; pictures beside it\n" : "\n") + (folder / "index.html").string() +
                          ": the same to look at and to touch\n");
  }
  return json;
}

}  // namespace

void add_bake(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"bake", "The main job: grain and touch onto a scene, as one GLB.",
                             "papilla bake data/cockpit.step -m demo/materials.json -o cockpit.glb --report report"},
                            [options](VerbContext& context) { return run_bake(*options, context); });
  verb->add_option("SCENE", options->input, "CAD, mesh or glTF file")->required();
  verb->add_option("-m,--materials", options->materials, "MATERIALS.json: what surfaces look and feel like")
      ->required();
  verb->add_option("-o,--output", options->output, "GLB to write")->required();
  verb->add_option("--library", options->libraries, "Files of named recipes, on top of the built-in ones")
      ->type_name("FILE");
  verb->add_option("--budget", options->budget,
                   "Triangles that the scene may draw: simplified with the smallest common tolerance that meets it")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  verb->add_option(
          "--mirror", options->mirrors,
          "Repeat what the haptic tags say in drafts of others' extensions, as far as they have a place for it")
      ->type_name("NAME")
      ->check(CLI::IsMember({k_mpeg, k_khr}));
  auto* const report =
      verb->add_option("--report", options->report, "Folder for a page to look at (index.html) and report.json")
          ->type_name("DIR");
  verb->add_flag("--pictures", options->pictures,
                 "Pictures into the report's folder, too: the scene, a checker, close-ups, uv layouts, reliefs")
      ->needs(report);
  options->leave_out.add_to(*verb);
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
