// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "options/output_option.hpp"
#include "options/scene_option.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "scene_output.hpp"
#include "text/scene_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string in, out;
  bool relative = false, keep_copies = false;
  SceneOptions read;
  OutputOptions stored;
};

Json run(const Options& options, VerbContext& context) {
  const Stopwatch clock;
  const ReadOptions read = options.read.read_options(nullptr);
  const WriteOptions write = options.stored.write_options(options.out);
  if (!is_cad_extension(options.in))
    throw InvalidInput(options.in + ": is no CAD file (.step .stp .p21 .iges .igs .brep .brp)");
  CadReadOptions cad;
  cad.chord_mm = read.chord_mm;
  cad.angle_deg = read.angle_deg;
  cad.relative = options.relative;
  cad.max_edge_mm = read.max_edge_mm;
  cad.millimetres_per_unit = read.millimetres_per_unit;
  CadReport report;
  Scene scene = read_cad(options.in, cad, &report, context.progress);
  scene.up = read.up.value_or(scene.up);
  std::vector<SharedPart> shared;
  if (!options.keep_copies) shared = share_identical_parts(scene);
  const Json stored = write_output(scene, options.out, write, context.console);
  context.console.print(tessellation_text(scene, report));
  Json json = tessellation_json(scene, report);
  json["chord_mm"] = read.chord_mm;
  json["angle_deg"] = read.angle_deg;
  json["max_edge_mm"] = read.max_edge_mm;
  json["identical_parts"] = shared_parts_json(shared, scene);
  json["seconds"] = clock.seconds();
  json["output"] = options.out;
  json["stored"] = stored;
  return json;
}

}  // namespace

void add_tessellate(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"tessellate", "Turn the surfaces of a CAD file into triangles, with part names, colours and CAD (u,v).",
                "papilla tessellate data/cockpit.step -o cockpit.glb --chord 0.2"},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("in", options->in, "STEP, IGES or BREP file"))->type_name("IN")->required();
  writes(verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write"))
      ->type_name("OUT")
      ->required();
  verb->add_flag("--relative", options->relative, "The chord is a fraction of each part's diagonal");
  verb->add_flag("--keep-copies", options->keep_copies, "Do not make identical parts instances of one");
  options->read.add_to(*verb);
  options->stored.add_to(*verb);
}

}  // namespace papilla::app
