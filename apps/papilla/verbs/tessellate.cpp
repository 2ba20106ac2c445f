// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/cad_reader.hpp"
#include "papilla/io/scene_file.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "papilla/pipeline/shared_parts.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct TessellateVerbOptions {
  std::string in, out;
  bool relative = false, keep_copies = false;
  SceneOptions read;
};

CadReadOptions cad_options(const TessellateVerbOptions& options) {
  const ReadOptions read = options.read.read_options();
  CadReadOptions cad;
  cad.chord_mm = read.chord_mm;
  cad.angle_deg = read.angle_deg;
  cad.relative = options.relative;
  cad.max_edge_mm = read.max_edge_mm;
  cad.millimetres_per_unit = read.millimetres_per_unit;
  return cad;
}

std::vector<std::size_t> uses_of(const Scene& scene) {
  std::vector<std::size_t> uses(scene.parts.size());
  for (const Instance& instance : instances(scene)) ++uses[instance.part];
  return uses;
}

Json parts_json(const Scene& scene, const std::vector<std::size_t>& uses, const CadReport& report) {
  std::map<std::string, const CadPartReport*> measured;
  for (const CadPartReport& part : report.parts) measured.emplace(part.part, &part);
  Json parts = Json::array();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    Json materials = Json::array();
    for (const std::uint32_t m : part.materials) materials.push_back(scene.materials[m].name);
    parts.push_back({{"name", part.name},
                     {"id", part.id},
                     {"triangles", part.mesh.triangles.size()},
                     {"vertices", part.mesh.positions.size()},
                     {"instances", uses[i]},
                     {"materials", std::move(materials)}});
    if (const auto found = measured.find(part.id); found != measured.end()) {
      parts.back()["max_deviation_mm"] = found->second->max_deviation_mm;
      parts.back()["max_angle_deg"] = found->second->max_angle_deg;
      parts.back()["added_nodes"] = found->second->added_nodes;
    }
  }
  return parts;
}

Json faces_json(const std::vector<CadFaceNote>& notes) {
  Json faces = Json::array();
  for (const CadFaceNote& note : notes)
    faces.push_back({{"part", note.part}, {"face", note.face}, {"reason", note.reason}, {"tried", note.tried}});
  return faces;
}

void print_summary(const Console& console, const Scene& scene, const std::vector<std::size_t>& uses,
                   const CadReport& report) {
  console.print(fmt::format("{:>10} {:>9}  part\n", "triangles", "instances"));
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    console.print(
        fmt::format("{:>10} {:>9}  {}\n", scene.parts[i].mesh.triangles.size(), uses[i], scene.parts[i].name));
  console.print(fmt::format("{} triangles in {} parts, {} of {} CAD faces failed, largest deviation {:.3g} mm\n",
                            report.triangles, scene.parts.size(), report.failed_faces.size(), report.faces,
                            report.max_deviation_mm));
  for (const CadFaceNote& note : report.off_faces)
    console.print(fmt::format("face {} of '{}' {}\n", note.face, note.part, note.reason));
}

Json tessellate_file(VerbContext& context, const TessellateVerbOptions& options) {
  const Stopwatch clock;
  const ReadOptions read = options.read.read_options();
  if (!is_cad_extension(options.in))
    throw InvalidInput(options.in + ": is no CAD file (.step .stp .p21 .iges .igs .brep .brp)");
  CadReport report;
  Scene scene = read_cad(options.in, cad_options(options), &report, context.progress);
  scene.up = read.up.value_or(scene.up);
  std::vector<SharedPart> shared;
  if (!options.keep_copies) shared = share_identical_parts(scene);
  write_output(scene, options.out, context.console);

  const std::vector<std::size_t> uses = uses_of(scene);
  print_summary(context.console, scene, uses, report);
  return {
      {"format", scene.format},
      {"unit", scene.unit},
      {"chord_mm", read.chord_mm},
      {"angle_deg", read.angle_deg},
      {"max_edge_mm", read.max_edge_mm},
      {"parts", parts_json(scene, uses, report)},
      {"identical_parts", shared_parts_json(shared, scene)},
      {"triangles", report.triangles},
      {"solids", report.solids},
      {"faces", report.faces},
      {"failed_faces", faces_json(report.failed_faces)},
      {"repaired_faces", faces_json(report.repaired_faces)},
      {"off_faces", faces_json(report.off_faces)},
      {"dropped_triangles", report.dropped_triangles},
      {"max_deviation_mm", report.max_deviation_mm},
      {"max_angle_deg", report.max_angle_deg},
      {"added_nodes", report.added_nodes},
      {"seconds", clock.seconds()},
      {"stages",
       {{"read", report.seconds_read}, {"tessellate", report.seconds_tessellate}, {"convert", report.seconds_convert}}},
      {"losses", scene.losses},
      {"warnings", scene.warnings},
      {"output", options.out}};
}

}  // namespace

void add_tessellate(CLI::App& program) {
  auto options = std::make_shared<TessellateVerbOptions>();
  CLI::App* verb =
      add_verb(program,
               {"tessellate", "Turn the surfaces of a CAD file into triangles, with part names, colours and CAD (u,v).",
                "papilla tessellate data/cockpit.step -o cockpit.glb --chord 0.2"},
               [options](VerbContext& context) { return tessellate_file(context, *options); });
  verb->add_option("in", options->in, "STEP, IGES or BREP file")->type_name("IN")->required();
  verb->add_option("-o,--output", options->out, "GLB, OBJ, PLY, OFF or STL file to write")
      ->type_name("OUT")
      ->required();
  verb->add_flag("--relative", options->relative, "The chord is a fraction of each part's diagonal");
  verb->add_flag("--keep-copies", options->keep_copies, "Do not make identical parts instances of one");
  options->read.add_to(*verb);
}

}  // namespace papilla::app
