// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>
#include <string>

#include "file_options.hpp"
#include "json/fit_json.hpp"
#include "option_checks.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/pipeline/pictures/fit_plots.hpp"
#include "shown_format.hpp"
#include "text/fit_text.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string stroke, output, material, picture, surface = "auto", forces = "auto";
  FitOptions fit;
};

StrokeSurface surface_of(const std::string& name) {
  if (name == "recorded") return StrokeSurface::recorded;
  return name == "plane" ? StrokeSurface::plane : StrokeSurface::automatic;
}

StrokeForces forces_of(const std::string& name) {
  if (name == "player") return StrokeForces::player;
  return name == "sensor" ? StrokeForces::sensor : StrokeForces::automatic;
}

Json run(const Options& options, VerbContext& context) {
  FitOptions wanted = options.fit;
  wanted.surface = surface_of(options.surface);
  wanted.forces = forces_of(options.forces);
  const std::vector<StrokeSample> stroke = parse_stroke_recording(read_file(options.stroke), options.stroke);
  const MaterialFit fit = fit_material(stroke, wanted, options.stroke, context.progress);
  if (!fit.stiffness && !fit.damping && !fit.dynamic_friction)
    throw InvalidInput(options.stroke +
                       ": the stroke identifies nothing of the material: " + fit.not_identified.front().reason);
  context.console.print(fit_text(fit));
  Json json = fit_json(options.stroke, fit);
  if (!options.output.empty()) {
    const std::string name =
        options.material.empty() ? std::filesystem::path(options.stroke).stem().string() : options.material;
    write_atomically(options.output, json_text(fitted_materials_json(options.stroke, name, fit)));
    context.console.print(shown_format("{}: material '{}', as MATERIALS.json\n", options.output, name));
    json["output"] = {{"file", options.output}, {"material", name}};
  }
  if (!options.picture.empty()) {
    const bool is_drawn = write_plot(options.picture, fit_plots(fit));
    context.console.print(
        shown_format("{}: {}\n", options.picture, is_drawn ? "forces and friction" : "not drawn, gnuplot is missing"));
    json["picture"] = is_drawn ? Json(options.picture) : Json(nullptr);
  }
  return json;
}

}  // namespace

void add_fit(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"fit", "Finds the material of a surface from a recorded stroke: position and force.",
                             "papilla-player cockpit.glb --record stroke.csv && papilla fit stroke.csv -o felt.json"},
                            [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("STROKE", options->stroke,
                         "Recording as CSV: t, probe_x … probe_z, force_x … force_z; as papilla-player --record"))
      ->type_name("FILE")
      ->required();
  writes(verb->add_option("-o,--output", options->output, "MATERIALS.json with the material, for every part"))
      ->type_name("OUT");
  verb->add_option("--material", options->material, "Name of the material there; default: of the recording's file")
      ->type_name("NAME");
  writes(verb->add_option("--picture", options->picture, "Measured and fitted force, and the friction curve, as SVG"))
      ->type_name("FILE");
  verb->add_option("--surface", options->surface,
                   "Where the surface is: recorded (columns proxy_x …), an unknown plane, or what the file has")
      ->transform(one_of({"auto", "recorded", "plane"}))
      ->capture_default_str();
  verb->add_option("--forces", options->forces,
                   "Who made the forces: the player, whose safety fades them in, a sensor, or auto: the player where "
                   "there are proxies")
      ->transform(one_of({"auto", "player", "sensor"}))
      ->capture_default_str();
  verb->add_option("--max-force", options->fit.max_force_n, "Of the player's device, which cuts forces off there")
      ->type_name("N")
      ->check(positive());
}

}  // namespace papilla::app
