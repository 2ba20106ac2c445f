// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "bake/surfaces.hpp"
#include "scene_options.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {

void add_plan(CLI::App& program) {
  struct Options {
    std::string input, materials;
    SceneOptions scene;
  };
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(
      program,
      {"plan", "Show what bake would do, surface by surface, and why; writes nothing.",
       "papilla plan data/cockpit.step -m data/cockpit.materials.json"},
      [options](VerbContext& context) {
        const MaterialsFile rules = read_materials_file(options->materials);
        const Scene scene = read_scene(options->input, options->scene.read_options(), context.progress);
        const std::vector<Surface> surfaces = plan_surfaces(scene, rules);
        context.console.print(plan_table(surfaces));
        return Json{{"scene", options->input}, {"materials", options->materials}, {"stages", plan_json(surfaces)}};
      });
  verb->add_option("SCENE", options->input, "CAD, mesh or glTF file")->required();
  verb->add_option("-m,--materials", options->materials, "MATERIALS.json")->required();
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
