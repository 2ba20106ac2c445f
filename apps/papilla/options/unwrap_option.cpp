// SPDX-License-Identifier: GPL-3.0-or-later
#include "options/unwrap_option.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "exit_code.hpp"
#include "option_checks.hpp"
#include "options/vector_option.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/param/levy_coupling.hpp"

namespace papilla::app {
namespace {

/// Cuts "@PART" off the end.
std::string take_part(std::string& text) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos) return {};
  std::string part = text.substr(at + 1);
  text.erase(at);
  return part;
}

bool read_number(const std::string& text, double& value) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && rest == end && std::isfinite(value);
}

/// The name on the command line of an option in MATERIALS.json.
std::string flag_of(std::string option) {
  std::replace(option.begin(), option.end(), '_', '-');
  return "--" + option;
}

MethodOptions method_options(const UnwrapOption& options) {
  MethodOptions method = options.unwrap.method;
  if (!takes_charts(method.method) && method.charts != ChartSource::automatic)
    throw UsageError("--charts " + chart_source_name(method.charts) + ": " + unwrap_method_name(method.method) +
                     " makes its own charts");
  if (!options.solver.empty() && !choose_solver(options.solver, method))
    throw UsageError("--solver " + options.solver + ": " + unwrap_method_name(method.method) + " has no such solver");
  for (const auto& [name, option] : options.of_methods)
    if (const std::string reason = foreign_option(name, method.method); option->count() > 0 && !reason.empty())
      throw UsageError(flag_of(name) + ": it " + reason);
  for (const std::string& text : options.pins) method.pins.push_back(parse_pin(text));
  for (const std::string& text : options.iso_lines) method.iso_lines.push_back(parse_iso_line(text));
  for (const std::string& text : options.grains) method.grains.push_back(parse_grain(text));
  const MaillotOptions& maillot = method.maillot;
  if (maillot.distortion_limit > 0 && maillot.distortion_limit < 1)
    throw UsageError(
        fmt::format("--distortion-limit {:g}: it must be 0, no limit, or at least 1", maillot.distortion_limit));
  const LevyOptions& levy = method.levy;
  if (levy.coupling == LevyCoupling::conformal)
    if (const std::string obstacle = conformal_obstacle(levy, !method.iso_lines.empty()); !obstacle.empty())
      throw UsageError("--coupling conformal: " + obstacle);
  if (!options.direction.empty()) method.planar.direction = parse_vector("--direction", options.direction);
  if (!options.eye.empty())
    method.intermediate.eye = method.environment.eye = method.segmentation.eye = parse_vector("--eye", options.eye);
  if (!options.max_distortion.empty()) {
    method.max_distortion = distortion_bound(options.max_distortion);
    if (!method.max_distortion)
      throw UsageError("--max-distortion '" + options.max_distortion + "': expected D or pNN=D with D at least 4");
    if (!method.choose_seam_cost) throw UsageError("--seam-cost: --max-distortion finds it, give one of the two");
    if (method.charts != ChartSource::automatic)
      throw UsageError("--charts " + chart_source_name(method.charts) + ": --max-distortion makes charts of its own");
  }
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

/// What is held in one part must say in which.
void check_part(const std::string& option, const std::string& pattern, const std::string& file, const Scene& scene) {
  if (pattern.empty() && scene.parts.size() != 1)
    throw UsageError(fmt::format("{}: {} has {} parts, say which by @PART", option, file, scene.parts.size()));
  if (std::any_of(scene.parts.begin(), scene.parts.end(),
                  [&](const Part& p) { return is_for_part(pattern, shown_name(p)); }))
    return;
  std::vector<std::string_view> known;
  for (const Part& part : scene.parts) known.emplace_back(shown_name(part));
  throw UsageError(option + ": " + file + " has no part named '" + pattern + "'" + did_you_mean(pattern, known));
}

/// What only some methods know; the help names them.
void add_method_options(CLI::App& verb, UnwrapOption& options) {
  MethodOptions& m = options.unwrap.method;
  const auto add = [&](const char* option, auto& value, const char* help) {
    CLI::Option* added = verb.add_option(flag_of(option), value, help);
    options.of_methods.emplace_back(option, added);
    return added;
  };
  const auto choose = [&](const char* option, auto& value, const auto& names, const char* help) {
    options.of_methods.emplace_back(option, add_choice(verb, flag_of(option), value, names, help));
  };
  add("iterations", m.iterations, "Of best, maillot, levy (rounds), arap: at most so many")->check(not_negative());
  add("tolerance", m.tolerance, "Of the same: stop when the error falls by less than this fraction")
      ->check(in_range(1e-15, 0.999));
  add("phi", m.maillot.length_weight, "Of maillot: weight of lengths against areas")
      ->check(in_range(0.0, 1.0))
      ->capture_default_str();
  options.of_methods.emplace_back(
      "allow_flips",
      verb.add_flag("--allow-flips", m.maillot.allow_flips, "Of maillot: let triangles turn over, as the source does"));
  choose("start", m.maillot.start, maillot_starts(),
         "Of maillot: the map to start from; coarse-to-fine (default) is valid on every disk, and taken where another "
         "one is none");
  add("distortion_limit", m.maillot.distortion_limit,
      "Of maillot: end where the mean symmetric Dirichlet energy would rise above this multiple of the start's; 0: no "
      "limit")
      ->check(not_negative())
      ->capture_default_str();
  choose("weights", m.levy.weights, levy_weights(), "Of levy's smoothness; default: mean-value");
  choose("border", m.levy.border, levy_borders(),
         "Of levy: free (default), convex: on a circle, released: on a circle until the map is smooth, then free");
  choose("coupling", m.levy.coupling, levy_couplings(),
         "Of levy: conformal is linear, orthogonal alternates between u and v; auto (default): conformal where the "
         "border is free, the solver direct and no iso line held");
  const auto weight = [&](const char* name, double& value, const char* help) {
    add(name, value, help)->check(not_negative())->capture_default_str();
  };
  weight("smoothness", m.levy.smoothness, "Of levy: weight of smooth interpolation");
  weight("orthogonality", m.levy.orthogonality, "Of levy: weight of right angles");
  weight("length", m.levy.length, "Of levy: weight of even lengths");
  add("pin", options.pins, "Of levy: the vertex nearest to a place gets these uv; two or more")
      ->type_name("X,Y,Z=U,V[@PART]");
  add("iso_line", options.iso_lines,
      "Of levy: the vertices on the shortest path of edges through these places share their u, or v")
      ->type_name("u|v[=MM]:X,Y,Z;X,Y,Z...[@PART]");
  choose("shape", m.intermediate.shape, intermediate_shapes(), "Of intermediate; default: box");
  choose("rule", m.intermediate.rule, intermediate_rules(),
         "Of intermediate: how points find the shape; default: intermediate-normal");
  add("direction", options.direction, "Of planar: outward direction; default: the dominant normal")->type_name("X,Y,Z");
  choose("environment_map", m.environment.map, environment_maps(),
         "Of environment: sphere (default): a mirroring ball; equal-area: a cylindrical panorama of the surroundings");
  add("eye", options.eye,
      "Of environment and of reflected-ray; default: in front of each part. Of auto and best: seams that can't be seen "
      "from there count as hidden")
      ->type_name("X,Y,Z");
  add("max_distortion", options.max_distortion,
      "Of auto and best: the shortest seams with which the mean symmetric Dirichlet energy of a part, 4 without "
      "distortion, is at most D; pNN: with which so many per cent of the area have at most D")
      ->type_name("D|pNN=D");
}

}  // namespace

PlacedPin parse_pin(const std::string& text) {
  PlacedPin pin;
  std::string rest = text;
  pin.part = take_part(rest);
  const std::size_t equals = rest.find('='), comma = rest.find(',', equals);
  if (equals == std::string::npos || comma == std::string::npos ||
      !read_number(rest.substr(equals + 1, comma - equals - 1), pin.uv.x) ||
      !read_number(rest.substr(comma + 1), pin.uv.y))
    throw UsageError("--pin '" + text + "': expected X,Y,Z=U,V or X,Y,Z=U,V@PART");
  pin.position = parse_vector("--pin", rest.substr(0, equals));
  return pin;
}

PlacedGrain parse_grain(const std::string& text) {
  constexpr std::string_view k_edge = "edge:";
  PlacedGrain grain;
  std::string rest = text;
  grain.part = take_part(rest);
  if (rest == "up") return grain;
  if (rest == "longest") {
    grain.source = GrainSource::longest;
    return grain;
  }
  const bool is_edge = rest.starts_with(k_edge);
  grain.source = is_edge ? GrainSource::edge_loop : GrainSource::direction;
  grain.vector = parse_vector("--grain", is_edge ? rest.substr(k_edge.size()) : rest);
  if (!is_edge && !(norm(grain.vector) > 0)) throw UsageError("--grain " + text + ": it has no length");
  return grain;
}

PlacedIsoLine parse_iso_line(const std::string& text) {
  const auto refuse = [&]() -> PlacedIsoLine {
    throw UsageError("--iso-line '" + text +
                     "': expected u:X,Y,Z;X,Y,Z or v=VALUE:X,Y,Z;X,Y,Z, with two points or more, and @PART behind it");
  };
  PlacedIsoLine line;
  std::string rest = text;
  line.part = take_part(rest);
  const std::size_t colon = rest.find(':');
  if (colon == std::string::npos || (rest[0] != 'u' && rest[0] != 'v')) return refuse();
  line.is_u = rest[0] == 'u';
  if (colon > 1) {
    double value = 0;
    if (rest[1] != '=' || !read_number(rest.substr(2, colon - 2), value)) return refuse();
    line.value = value;
  }
  for (std::size_t begin = colon + 1; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find(';', begin), rest.size());
    line.points.push_back(parse_vector("--iso-line", rest.substr(begin, end - begin)));
    begin = end + 1;
  }
  return line.points.size() < 2 ? refuse() : line;
}

void add_effort(CLI::App& verb, UnwrapEffort& effort) {
  add_choice<UnwrapEffort>(verb, "--effort", effort, unwrap_efforts(),
                           "Of charts, auto and best: fast: a little more distortion and more charts, soonest; normal "
                           "(default); best: all that the methods have, several times the time");
}

void UnwrapOption::add_to(CLI::App& verb) {
  add_choice<UnwrapMethod>(
      verb, "--method", unwrap.method.method, unwrap_methods(),
      "auto (default): chart by chart, the cheapest that does it well; best: lowest distortion, no flips, no "
      "overlap; lscm, levy: conformal; maillot, arap: lengths and areas; tutte, mvc: border on a circle; natural: the "
      "CAD surface's parameters; "
      "triplanar, planar, intermediate: projections; environment: what mirrors the surroundings, for previews");
  add_effort(verb, unwrap.method.effort);
  add_choice<ChartSource>(verb, "--charts", unwrap.method.charts, chart_sources(),
                          "auto (default): segment the surface; keep: each component is one chart; uv: the file's own "
                          "texture coordinates, cut at their seams");
  verb.add_option(
          "--solver", solver,
          "lscm: hermitian (default), cgal; maillot: gauss-newton, gradient-descent; levy: direct, gauss-seidel")
      ->transform(one_of({"hermitian", "cgal", "gauss-newton", "gradient-descent", "direct", "gauss-seidel"}))
      ->type_name("NAME");
  add_method_options(verb, *this);
  verb.add_option("--feature-angle", unwrap.method.segmentation.feature_angle_deg,
                  "Edges bent by more degrees part charts")
      ->check(in_range(1.0, 180.0))
      ->type_name("DEG")
      ->capture_default_str();
  verb.add_option_function<double>(
          "--seam-cost",
          [&method = unwrap.method](double cost) {
            method.segmentation.seam_cost = cost;
            method.choose_seam_cost = false;
          },
          "What seams cost against distortion: 0.01 cuts generously, 0.5 hardly ever; default: 0.03, and on parts of "
          "up to 50,000 triangles 0.01 or 0.1 where that is the better bargain")
      ->check(in_range(0.0, 1e6));
  verb.add_flag_callback(
      "--plain-seams", [&method = unwrap.method] { method.segmentation.weigh_seams = false; },
      "Seams count by their length alone, however visible they are");
  add_choice<UvLayout>(verb, "--layout", unwrap.layout, {{"atlas", UvLayout::atlas}, {"tile", UvLayout::tile}},
                       "atlas (default): no two charts overlap; tile: the grain goes on over seams");
  verb.add_option("--tile", tile, "Size of the grain's repeat: charts keep its phase")
      ->expected(2)
      ->check(in_range(0.0, 1e6))
      ->type_name("MM");
  verb.add_option(
          "--grain", grains,
          "Direction of the grain: up (default), longest: along each part, a vector, or edge: along the line of "
          "border or bent edges nearest to a place; @PART: on these parts only")
      ->type_name("X,Y,Z|edge:X,Y,Z|{up,longest}[@PART]");
  verb.add_option("--grain-size", unwrap.grain_mm,
                  "Size of one grain, by which seams are judged; default: an eighth of the tile")
      ->check(in_range(1e-6, 1e6))
      ->type_name("MM");
  verb.add_option("--texture-px", texture_px,
                  "Add a second set of uv for one texture of so many texels a side in which nothing overlaps")
      ->check(in_range(16, 65536))
      ->type_name("PX");
  verb.add_option("--gutter-px", gutter_px, "Texels between charts there")
      ->check(in_range(0.0, 16384.0))
      ->type_name("PX")
      ->capture_default_str();
  verb.add_option("--density", density, "Texel density there of parts by name (* and ? match), relative to 1")
      ->type_name("PART=FACTOR");
  verb.add_option("--gutter", unwrap.gutter_mm, "Least distance of charts in the atlas; default: 0.5 % of its side")
      ->check(in_range(0.0, 1e6))
      ->type_name("MM");
}

UnwrapOptions UnwrapOption::options() const {
  UnwrapOptions result = unwrap;
  result.method = method_options(*this);
  result.tile_mm = {tile[0], tile[1]};
  if (texture_px > 0) result.unique = UniqueUv{texture_px, gutter_px};
  if (!density.empty() && !result.unique) throw UsageError("--density needs --texture-px");
  for (const std::string& text : density) result.density.push_back(parse_density(text));
  return result;
}

void check_held_parts(const MethodOptions& method, const std::string& file, const Scene& scene) {
  for (const PlacedPin& pin : method.pins) check_part("--pin", pin.part, file, scene);
  for (const PlacedIsoLine& line : method.iso_lines) check_part("--iso-line", line.part, file, scene);
  for (const PlacedGrain& grain : method.grains)
    if (!grain.part.empty()) check_part("--grain", grain.part, file, scene);
}

}  // namespace papilla::app
