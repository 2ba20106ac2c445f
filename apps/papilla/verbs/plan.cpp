// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "papilla/pipeline/bake_plan.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {

void add_plan(CLI::App& program) {
  struct Options {
    std::string input, materials;
    LeaveOutOptions leave_out;
    SceneOptions scene;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"plan", "Show what bake would do, surface by surface, and why; writes nothing.",
       "papilla plan data/cockpit.step -m data/cockpit.materials.json"},
      [options](VerbContext& context) {
        const Materials rules = read_materials(options->materials);
        Scene scene = read_scene(options->input, options->scene.read_options(), context.progress);
        const std::vector<SharedPart> shared = share_identical_parts(scene, rules);
        const LeaveOutResult perception = measure_perception(scene, options->leave_out, context.progress);
        const std::vector<Surface> surfaces = plan_surfaces(scene, rules, perception.parts);
        context.console.print(plan_table(surfaces) + left_out_table(scene, perception));
        print_notes(scene, context.console);
        Json json{{"scene", options->input}, {"materials", options->materials}, {"stages", plan_json(surfaces)}};
        json["identical_parts"] = shared_parts_json(shared, scene);
        json["losses"] = scene.losses;
        json["warnings"] = scene.warnings;
        if (options->leave_out.asked()) json["perception"] = perception_json(scene, perception);
        return json;
      });
  verb->add_option("SCENE", options->input, "CAD, mesh or glTF file")->required();
  verb->add_option("-m,--materials", options->materials, "MATERIALS.json")->required();
  options->leave_out.add_to(*verb);
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
