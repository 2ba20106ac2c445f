// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>

#include "papilla/pipeline/measure_scene.hpp"
#include "exit_code.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/pipeline/pictures/uv_layout.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "unwrap/held_option.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"
#include "vector_option.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string input, output, trace, picture;
  std::string solver, direction, eye;  // empty: the method's own
  std::string grain = "up";
  int texture_px = 0;  // 0: no second set of uv
  double gutter_px = 4;
  std::vector<std::string> density, pins, iso_lines;
  std::vector<double> tile{0, 0};
  SceneOptions scene;
  UnwrapOptions unwrap;
};

std::string trace_csv(const Trace& trace) {
  std::string csv = "seconds,error\n";
  for (const TraceSample& s : trace) csv += fmt::format("{:.9g},{:.9g}\n", s.seconds, s.error);
  return csv;
}

Json choices_json(const std::vector<ChartChoice>& choices) {
  Json json = Json::array();
  for (const ChartChoice& c : choices) json.push_back({{"chart", c.chart}, {"method", c.method}, {"reason", c.reason}});
  return json;
}

Json seams_json(const SeamVisibility& s) {
  return {{"seam_mm", s.seam_mm},         {"visible_mm", s.visible_mm},       {"mean_jump_mm", s.mean_jump_mm},
          {"max_jump_mm", s.max_jump_mm}, {"mean_turn_deg", s.mean_turn_deg}, {"per_size", s.per_size}};
}

Json unique_json(const UnwrapReport& report) {
  if (!report.unique) return {};
  return {{"fill_rate", report.unique->fill_rate},
          {"texels_per_mm", report.unique->texels_per_mm},
          {"gutter_px", report.unique->gutter_px}};
}

Json parts_json(const Scene& scene, const UnwrapReport& report) {
  Json parts = Json::array();
  for (std::size_t p = 0; p < scene.parts.size(); ++p) {
    const UnwrappedPart& part = report.parts[p];
    Json notes = Json::array();
    for (const ChartNote& note : part.flattening.notes) notes.push_back(note.reason);
    parts.push_back({{"name", scene.parts[p].name},
                     {"triangles", scene.parts[p].mesh.triangles.size()},
                     {"method", part.method},
                     {"reason", part.reason.empty() ? Json() : Json(part.reason)},
                     {"charts", part.flattening.charts.count},
                     {"choices", choices_json(part.choices)},
                     {"seam_length_mm", part.flattening.charts.seam_length_mm},
                     {"grain_continued_mm", part.grain_continued_mm},
                     {"seam_visibility", seams_json(part.seams)},
                     {"opposed_edges", part.opposed_edges},
                     {"notes", std::move(notes)},
                     {"failure", part.failure.empty() ? Json() : Json(part.failure)}});
  }
  return parts;
}

/// What was not done as asked, a line each.
std::string remarks(const Scene& scene, const UnwrapReport& report) {
  std::string text;
  for (std::size_t p = 0; p < scene.parts.size(); ++p) {
    const UnwrappedPart& part = report.parts[p];
    if (part.opposed_edges > 0)
      text += fmt::format(
          "part '{}': charts end at {} edges of triangles that are wound against each other; papilla repair turns "
          "them\n",
          scene.parts[p].name, part.opposed_edges);
    if (!part.reason.empty() && part.failure.empty()) text += part.method + ": " + part.reason + "\n";
    if (!part.failure.empty()) text += "not unwrapped: " + part.failure + "\n";
    if (!part.flattening.notes.empty())
      text += fmt::format("{} charts did not take the method, the first: {}\n", part.flattening.notes.size(),
                          part.flattening.notes.front().reason);
  }
  return text;
}

/// The solvers of the methods that have several.
void choose_solver(const std::string& name, MethodOptions& method) {
  if (name.empty()) return;
  const auto pick = [&]<class Value>(const std::map<std::string, Value>& choices, Value& value) {
    const auto found = choices.find(name);
    if (found != choices.end()) value = found->second;
    return found != choices.end();
  };
  using Lscm = LscmSolver;
  using Maillot = MaillotSolver;
  using Levy = LevySolver;
  bool known = false;
  if (method.method == UnwrapMethod::lscm)
    known = pick(std::map<std::string, Lscm>{{"cgal", Lscm::cgal}, {"hermitian", Lscm::hermitian}}, method.lscm.solver);
  if (method.method == UnwrapMethod::maillot)
    known = pick(std::map<std::string, Maillot>{{"gradient-descent", Maillot::gradient_descent},
                                                {"gauss-newton", Maillot::gauss_newton}},
                 method.maillot.solver);
  if (method.method == UnwrapMethod::levy)
    known = pick(std::map<std::string, Levy>{{"gauss-seidel", Levy::gauss_seidel}, {"direct", Levy::direct}},
                 method.levy.solver);
  if (!known) throw UsageError("--solver " + name + ": " + unwrap_method_name(method.method) + " has no such solver");
}

/// What is left to do when the command line is read.
MethodOptions method_options(const Options& options) {
  MethodOptions method = options.unwrap.method;
  if (!takes_charts(method.method) && method.charts == ChartSource::keep)
    throw UsageError("--charts keep: " + unwrap_method_name(method.method) + " makes its own charts");
  choose_solver(options.solver, method);
  if (method.method != UnwrapMethod::levy) {
    if (!options.pins.empty()) throw UsageError("--pin needs --method levy");
    if (!options.iso_lines.empty()) throw UsageError("--iso-line needs --method levy");
  }
  for (const std::string& text : options.pins) method.pins.push_back(parse_pin(text));
  for (const std::string& text : options.iso_lines) method.iso_lines.push_back(parse_iso_line(text));
  if (options.grain == "longest") {
    method.grain = GrainSource::longest;
  } else if (options.grain != "up") {
    method.grain = GrainSource::direction;
    method.grain_direction = parse_vector("--grain", options.grain);
    if (!(norm(method.grain_direction) > 0)) throw UsageError("--grain " + options.grain + ": it has no length");
  }
  if (!options.direction.empty()) method.planar.direction = parse_vector("--direction", options.direction);
  if (!options.eye.empty()) method.intermediate.eye = method.environment.eye = parse_vector("--eye", options.eye);
  return method;
}

/// PATTERN=FACTOR.
std::pair<std::string, double> parse_density(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  double factor = 0;
  const char* end = text.data() + text.size();
  if (equals != std::string::npos) {
    const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, factor);
    if (error == std::errc() && rest == end && factor >= 1e-3 && factor <= 1e3) return {text.substr(0, equals), factor};
  }
  throw UsageError("--density '" + text + "': expected PART=FACTOR with a number from 0.001 to 1000");
}

UnwrapOptions unwrap_options(const Options& options) {
  UnwrapOptions unwrap = options.unwrap;
  unwrap.method = method_options(options);
  unwrap.tile_mm = {options.tile[0], options.tile[1]};
  if (options.texture_px > 0) unwrap.unique = UniqueUv{options.texture_px, options.gutter_px};
  if (!options.density.empty() && !unwrap.unique) throw UsageError("--density needs --texture-px");
  for (const std::string& text : options.density) unwrap.density.push_back(parse_density(text));
  return unwrap;
}

void check_usage(const Options& options) {
  const std::filesystem::path output(options.output);
  if (output.extension() == ".stl" || output.extension() == ".STL")
    throw UsageError("-o " + options.output + ": STL has no place for texture coordinates");
}

/// unwrap_scene() with the file's name in front of what it throws.
UnwrapReport unwrap_named(const std::string& file, Scene& scene, const UnwrapOptions& options,
                          const ProgressCallback& progress) {
  try {
    return unwrap_scene(scene, options, progress);
  } catch (const InvalidInput& error) {
    throw InvalidInput(file + ": " + error.what());
  } catch (const SolverFailure& error) {
    throw SolverFailure(file + ": " + error.what());
  }
}

/// What is held in one part must say in which.
void check_part(const std::string& option, const std::string& pattern, const std::string& file, const Scene& scene) {
  if (pattern.empty() && scene.parts.size() != 1)
    throw UsageError(fmt::format("{}: {} has {} parts, say which by @PART", option, file, scene.parts.size()));
  if (std::none_of(scene.parts.begin(), scene.parts.end(), [&](const Part& p) { return is_for_part(pattern, p.name); }))
    throw UsageError(option + ": " + file + " has no part named '" + pattern + "'");
}

Json run(const Options& options, VerbContext& context) {
  check_usage(options);
  const UnwrapOptions unwrap = unwrap_options(options);
  Scene scene = read_scene(options.input, options.scene.read_options(), context.progress);
  for (const PlacedPin& pin : unwrap.method.pins) check_part("--pin", pin.part, options.input, scene);
  for (const PlacedIsoLine& line : unwrap.method.iso_lines) check_part("--iso-line", line.part, options.input, scene);
  const UnwrapReport report = unwrap_named(options.input, scene, unwrap, context.progress);
  const SceneDistortion distortion =
      measure_scene(scene, {}, [&](std::size_t p) { return report.parts[p].failure.empty(); });
  write_output(scene, options.output, context.console);
  if (!options.trace.empty()) write_atomically(options.trace, trace_csv(report.trace));
  if (!options.picture.empty())
    write_color_image(options.picture, draw_uv_layout(distortion.mesh.uv, distortion.report));

  const std::string method = unwrap_method_name(unwrap.method.method);
  const Json worst_chart = worst_chart_json(scene, distortion);
  context.console.print(fmt::format("{}: {} charts in {:.3f} s\n", method, report.charts, report.seconds.total) +
                        distortion_text(distortion.report, worst_chart) + remarks(scene, report));
  return {{"method", method},
          {"charts", report.charts},
          {"stop", to_string(report.stop)},
          {"seconds",
           {{"segment", report.seconds.segment},
            {"solve", report.seconds.solve},
            {"pack", report.seconds.pack},
            {"total", report.seconds.total}}},
          {"fill_rate", report.fill_rate},
          {"grain_mm", report.grain_mm},
          {"unique", unique_json(report)},
          {"distortion", distortion_json(distortion.report)},
          {"worst_chart", worst_chart},
          {"parts", parts_json(scene, report)},
          {"losses", scene.losses},
          {"warnings", scene.warnings}};
}

template <class Value>
CLI::Option* add_choice(CLI::App* verb, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& help) {
  std::string names;
  for (const auto& choice : choices) names += (names.empty() ? "" : "|") + choice.first;
  return verb->add_option(name, value, help)
      ->transform(CLI::CheckedTransformer(choices, CLI::ignore_case).description(""))
      ->type_name(names);
}

/// What only some methods know; the help names them.
void add_method_options(CLI::App& verb, Options& options) {
  MethodOptions& m = options.unwrap.method;
  verb.add_option("--iterations", m.iterations, "Of best, maillot, levy (rounds), arap: at most so many")
      ->check(CLI::NonNegativeNumber);
  verb.add_option("--tolerance", m.tolerance, "Of the same: stop when the error falls by less than this fraction")
      ->check(CLI::Range(1e-15, 0.999));
  verb.add_option("--time-limit", m.time_limit_s, "Of best, maillot, levy: stop iterating a chart after so long")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  verb.add_option("--phi", m.maillot.length_weight, "Of maillot: weight of lengths against areas")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  verb.add_flag("--allow-flips", m.maillot.allow_flips, "Of maillot: let triangles turn over, as the source does");
  add_choice<MaillotStart>(&verb, "--start", m.maillot.start,
                           {{"coarse-to-fine", MaillotStart::coarse_to_fine}, {"conformal", MaillotStart::conformal}},
                           "Of maillot: the map to start from; coarse-to-fine (default) is valid on every disk");
  add_choice<LevyWeights>(&verb, "--weights", m.levy.weights,
                          {{"uniform", LevyWeights::uniform},
                           {"cotangent", LevyWeights::cotangent},
                           {"mean-value", LevyWeights::mean_value}},
                          "Of levy's smoothness; default: mean-value");
  add_choice<LevyBorder>(&verb, "--border", m.levy.border, {{"convex", LevyBorder::convex}, {"free", LevyBorder::free}},
                         "Of levy; default: free");
  add_choice<LevyCoupling>(&verb, "--coupling", m.levy.coupling,
                           {{"conformal", LevyCoupling::conformal}, {"orthogonal", LevyCoupling::orthogonal}},
                           "Of levy: conformal (default) is linear, orthogonal alternates between u and v");
  const auto weight = [&](const char* name, double& value, const char* help) {
    verb.add_option(name, value, help)->check(CLI::NonNegativeNumber)->capture_default_str();
  };
  weight("--smoothness", m.levy.smoothness, "Of levy: weight of smooth interpolation");
  weight("--orthogonality", m.levy.orthogonality, "Of levy: weight of right angles");
  weight("--length", m.levy.length, "Of levy: weight of even lengths");
  verb.add_option("--pin", options.pins, "Of levy: the vertex nearest to a place gets these uv; two or more")
      ->type_name("X,Y,Z=U,V[@PART]");
  verb.add_option("--iso-line", options.iso_lines,
                  "Of levy: the vertices on the shortest path of edges through these places share their u, or v")
      ->type_name("u|v[=MM]:X,Y,Z;X,Y,Z...[@PART]");
  add_choice<IntermediateShape>(&verb, "--shape", m.intermediate.shape,
                                {{"sphere", IntermediateShape::sphere},
                                 {"cylinder", IntermediateShape::cylinder},
                                 {"cone", IntermediateShape::cone},
                                 {"box", IntermediateShape::box}},
                                "Of intermediate; default: box");
  add_choice<IntermediateRule>(&verb, "--rule", m.intermediate.rule,
                               {{"reflected-ray", IntermediateRule::reflected_ray},
                                {"object-normal", IntermediateRule::object_normal},
                                {"object-centroid", IntermediateRule::object_centroid},
                                {"intermediate-normal", IntermediateRule::intermediate_normal}},
                               "Of intermediate: how points find the shape; default: intermediate-normal");
  verb.add_option("--direction", options.direction, "Of planar: outward direction; default: the dominant normal")
      ->type_name("X,Y,Z");
  verb.add_option("--eye", options.eye, "Of environment and of reflected-ray; default: in front of each part")
      ->type_name("X,Y,Z");
}

}  // namespace

void add_unwrap(CLI::App& program) {
  auto options = std::make_shared<Options>();
  options->unwrap.method.method = UnwrapMethod::automatic;
  UnwrapOptions& unwrap = options->unwrap;
  CLI::App* verb = add_verb(program,
                            {"unwrap", "Make charts and texture coordinates in millimetres.",
                             "papilla unwrap part.stl -o part.glb --picture part.png"},
                            [options](VerbContext& context) { return run(*options, context); });
  verb->add_option("IN", options->input, "Mesh, CAD or glTF file")->required();
  verb->add_option("-o,--output", options->output, "File with texture coordinates: .glb, .obj")->required();
  add_choice<UnwrapMethod>(
      verb, "--method", unwrap.method.method, unwrap_methods(),
      "auto (default): chart by chart, the cheapest that does it well; best: lowest distortion, no flips, no "
      "overlap; lscm, levy: conformal; maillot, arap: lengths and areas; tutte, mvc: border on a circle; natural: the "
      "CAD surface's parameters; "
      "triplanar, planar, intermediate: projections; environment: sphere map, for previews")
      ->type_name("NAME");
  add_choice<ChartSource>(verb, "--charts", unwrap.method.charts,
                          {{"auto", ChartSource::automatic}, {"keep", ChartSource::keep}},
                          "auto (default): segment the surface; keep: each component is one chart");
  verb->add_option("--solver", options->solver,
                   "lscm: cgal, hermitian; maillot: gauss-newton, gradient-descent; levy: direct, gauss-seidel")
      ->type_name("NAME");
  add_method_options(*verb, *options);
  verb->add_option("--feature-angle", unwrap.method.segmentation.feature_angle_deg,
                   "Edges bent by more degrees part charts")
      ->check(CLI::Range(1.0, 180.0))
      ->type_name("DEG")
      ->capture_default_str();
  unwrap.method.choose_seam_cost = true;
  verb->add_option_function<double>(
          "--seam-cost",
          [&method = unwrap.method](double cost) {
            method.segmentation.seam_cost = cost;
            method.choose_seam_cost = false;
          },
          "What seams cost against distortion: 0.01 cuts generously, 0.5 hardly ever; default: 0.03, and on parts of "
          "up to 50,000 triangles 0.01 or 0.1 where that is the better bargain")
      ->check(CLI::Range(0.0, 1e6));
  add_choice<UvLayout>(verb, "--layout", unwrap.layout, {{"atlas", UvLayout::atlas}, {"tile", UvLayout::tile}},
                       "atlas (default): no two charts overlap; tile: the grain goes on over seams");
  verb->add_option("--tile", options->tile, "Size of the grain's repeat: charts keep its phase")
      ->expected(2)
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("MM");
  verb->add_option("--grain", options->grain,
                   "Direction of the grain: up (default), longest: along each part, or a vector")
      ->type_name("up|longest|X,Y,Z");
  verb->add_option("--grain-size", unwrap.grain_mm,
                   "Size of one grain, by which seams are judged; default: an eighth of the tile")
      ->check(CLI::Range(1e-6, 1e6))
      ->type_name("MM");
  verb->add_option("--texture-px", options->texture_px,
                   "Add a second set of uv for one texture of so many texels a side in which nothing overlaps")
      ->check(CLI::Range(16, 65536))
      ->type_name("PX");
  verb->add_option("--gutter-px", options->gutter_px, "Texels between charts there")
      ->check(CLI::Range(0.0, 16384.0))
      ->type_name("PX")
      ->capture_default_str();
  verb->add_option("--density", options->density, "Texel density there of parts by name (* and ? match), relative to 1")
      ->type_name("PART=FACTOR");
  verb->add_option("--gutter", unwrap.gutter_mm, "Least distance of charts in the atlas; default: 0.5 % of its side")
      ->check(CLI::Range(0.0, 1e6))
      ->type_name("MM");
  verb->add_option("--trace", options->trace, "Write error over run time as CSV: seconds,error")->type_name("FILE");
  verb->add_option("--picture", options->picture, "Draw the layout, coloured by distortion")->type_name("PNG");
  options->scene.add_to(*verb);
}

}  // namespace papilla::app
