// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "options/perception_option.hpp"
#include "options/scene_option.hpp"
#include "options/side_option.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "text/scene_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string file, picture;
  bool nodes = false;
  PerceptionOption perception;
  SideOption sides;
  SceneOptions read;
};

Json run(const Options& options, VerbContext& context) {
  const PerceptionOptions wanted = options.perception.options();
  SceneSideOptions look = options.sides.options();
  look.cache = context.cache;
  const Scene scene = read_scene(options.file, options.read.read_options(context.cache), context.progress);
  const std::vector<MeshStatistics> statistics = part_statistics(scene, context.progress);
  std::optional<ScenePerception> perception;
  if (wanted.asked()) perception = measure_perception(scene, wanted, context.progress);
  const SceneSides sides = find_sides(scene, look, wanted.view);
  context.console.print(inspect_text(scene, statistics, perception, sides));
  const std::vector<SurfacePlace> places = options.nodes ? surface_places(scene) : std::vector<SurfacePlace>();
  if (options.nodes) context.console.print(nodes_text(places));
  print_notes(scene, context.console);
  Json json{{"file", options.file}};
  json.update(inspect_json(scene, statistics, perception, sides_json(sides, look)));
  if (options.nodes) json["nodes"] = nodes_json(places);
  if (!options.picture.empty()) {
    write_color_image(options.picture, render_scene(scene, {.mode = RenderMode::triangles}));
    json["picture"] = options.picture;
    context.console.print(shown_format("written {}\n", options.picture));
  }
  return json;
}

}  // namespace

void add_inspect(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"inspect", "Show what a file holds: parts, materials, and what is wrong with the meshes.",
                "papilla inspect seat.obj --json -", VerbInfo::AtDeadline::is_cancelled, VerbInfo::Remembers::yes},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("file", options->file, "STL, OBJ, PLY, OFF, GLB, glTF, FBX, 3MF, DAE, AC, X3D or BLEND file"))
      ->type_name("FILE")
      ->required();
  writes(verb->add_option("--picture", options->picture,
                          "Picture of the scene with its triangles; red: edges of one triangle"))
      ->type_name("PNG");
  verb->add_flag("--nodes", options->nodes,
                 "List all that rules can select by: the path of every use of a part, its layers and materials");
  options->perception.add_to(*verb, false);
  options->sides.add_to(*verb, false);
  options->read.add_to(*verb);
}

}  // namespace papilla::app
