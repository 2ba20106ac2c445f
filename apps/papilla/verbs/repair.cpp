// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <memory>

#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "option_checks.hpp"
#include "options/output_option.hpp"
#include "options/scene_option.hpp"
#include "options/side_option.hpp"
#include "papilla/core/progress_until.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/pipeline/simplify_scene.hpp"
#include "scene_output.hpp"
#include "text/scene_text.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

/// Writing, reading and counting, a triangle: kept of the time that there is.
constexpr double k_finishing_s = 2e-6;

struct Options {
  std::string in, out;
  RepairSceneOptions repair;
  SideOption sides;
  SceneOptions read;
  OutputOptions stored;
  bool verify = false;
};

Json run(const Options& options, VerbContext& context) {
  const WriteOptions write = options.stored.write_options(options.out);
  RepairSceneOptions repair = options.repair;
  if (options.verify) repair.repair.sample_above = std::numeric_limits<std::size_t>::max();
  repair.sides = options.sides.options(options.out);
  repair.sides.cache = context.cache;
  Scene scene = read_scene(options.in, options.read.read_options(context.cache),
                           progress_until(context.progress, context.read_deadline));
  repair.repair.deadline = repair.sides.deadline =
      context.deadline.earlier_by(k_finishing_s * static_cast<double>(drawn_triangles(scene)));
  RepairSceneResult result =
      named_by(options.in, [&] { return repair_scene(std::move(scene), repair, context.progress); });
  const Json stored = write_output(result.scene, options.out, write, context.console);
  // What is said is what is written, in the file's precision.
  const WrittenRepair written{total_statistics(part_statistics(read_scene(options.out))),
                              single_precision_mm(result.scene, !repair.sides.add_materials)};
  context.console.print(repair_text(result, written));
  Json json = repair_json(result, written, repair);
  json["output"] = options.out;
  json["stored"] = stored;
  return json;
}

}  // namespace

void add_repair(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      add_verb(program,
               {"repair", "Make clean, oriented, manifold parts of whatever a file holds.",
                "papilla repair scan.stl -o clean.glb", VerbInfo::AtDeadline::ends, VerbInfo::Remembers::yes},
               [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("in", options->in, "STL, OBJ, PLY, OFF, GLB, glTF, FBX, 3MF, DAE, AC, X3D or BLEND file"))
      ->type_name("IN")
      ->required();
  writes(verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write"))
      ->type_name("OUT")
      ->required();
  verb->add_option("--weld", options->repair.repair.weld_mm, "Weld tolerance; default: 1e-6 of each part's diagonal")
      ->type_name("MM")
      ->check(not_negative());
  verb->add_option("--stitch", options->repair.repair.stitch_mm,
                   "Widest gap between faces to close; default: 2e-4 of each part's diagonal, 0: none")
      ->type_name("MM")
      ->check(not_negative());
  verb->add_option("--tolerance", options->repair.repair.tolerance_mm,
                   "Pieces whose surface would move further stay as they are; default: 2.5e-4 of each part's diagonal, "
                   "more with a wider --weld or --stitch")
      ->type_name("MM")
      ->check(not_negative());
  verb->add_option("--fill-holes", options->repair.repair.fill_holes_mm,
                   "Fill holes that fit into a box of this diagonal")
      ->type_name("MM")
      ->check(not_negative());
  verb->add_flag("--verify", options->verify, "Measure the deviation of large parts whole, too, not by samples");
  verb->add_flag("--keep-copies", options->repair.keep_copies, "Do not make identical parts instances of one");
  options->sides.add_to(*verb);
  options->read.add_to(*verb);
  options->stored.add_to(*verb);
}

}  // namespace papilla::app
