// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "papilla/pipeline/texture_survey.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/analysis_pictures.hpp"
#include "papilla/texture/frieze_group.hpp"
#include "papilla/texture/wallpaper_group.hpp"
#include "papilla/pipeline/pictures/pixel_text.hpp"
#include "papilla/pipeline/pictures/texture_plots.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string image, pictures;
  double pitch_mm = 0;
  std::vector<std::string> only = {"fractal", "symmetry", "class"};
  std::string lattice = "best", feature = "squared", pattern = "plane";
  bool force_lattice = false;
};

Json curve_json(const FractalEstimate& estimate) {
  Json json{{"low", estimate.low}, {"high", estimate.high}, {"curve", Json::array()}};
  for (const ScalePoint& point : estimate.curve)
    json["curve"].push_back({{"scale", point.scale}, {"measure", point.measure}});
  return json;
}

Json fshot_json(const FshotSignature& signature) {
  Json json{{"sta", signature.sta},
            {"str", signature.str},
            {"fs_h", signature.fs_h},
            {"fs_v", signature.fs_v},
            {"angle_deg", signature.angle_deg},
            {"directions", Json::array()}};
  for (const DirectionalHurst& d : signature.directions)
    json["directions"].push_back({{"angle_deg", d.angle_deg}, {"hurst", d.hurst}, {"low", d.low}, {"high", d.high}});
  return json;
}

/// One line of the report; null when the picture is too small for the method.
Json reading_json(const char* name, const FractalEstimate* estimate, int least_side, Json json, Json& details,
                  const Console& console) {
  if (!estimate) {
    console.print(fmt::format("fractal    {:<12} needs {} pixels a side\n", name, least_side));
    return nullptr;
  }
  details[name] = curve_json(*estimate);
  console.print(fmt::format("fractal    {:<12} D = {:.3f}  [{:.3f}, {:.3f}]\n", name, estimate->dimension,
                            estimate->low, estimate->high));
  return json.is_null() ? Json(estimate->dimension) : json;
}

Json best_json(const BestDimension& best) {
  const FractalEstimate& e = best.estimate;
  Json json{{"dimension", e.dimension}, {"hurst", e.hurst}, {"low", e.low}, {"high", e.high}};
  json["directional_hurst"] = {{"0", best.directional_hurst[0]},
                               {"90", best.directional_hurst[1]},
                               {"45", best.directional_hurst[2]},
                               {"-45", best.directional_hurst[3]}};
  json["quantization_step"] = best.quantization_step;
  return json;
}

Json fractal(const FractalReadings& readings, const Console& console) {
  Json json = Json::object(), details = Json::object();
  const auto add = [&](const char* name, const FractalEstimate* estimate, int least_side, Json value) {
    json[name] = reading_json(name, estimate, least_side, std::move(value), details, console);
  };
  const auto estimate_of = [](const auto& reading) { return reading ? &*reading : nullptr; };
  add("box", estimate_of(readings.box), k_least_fractal_side, nullptr);
  add("information", estimate_of(readings.information), k_least_fractal_side, nullptr);
  add("correlation", estimate_of(readings.correlation), k_least_fractal_side, nullptr);
  add("probability", estimate_of(readings.probability), k_least_probability_side, nullptr);
  add("fshot", readings.fshot ? &readings.fshot->estimate : nullptr, k_least_fractal_side,
      readings.fshot ? fshot_json(*readings.fshot) : Json(nullptr));
  add("best", readings.best ? &readings.best->estimate : nullptr, k_least_fractal_side,
      readings.best ? best_json(*readings.best) : Json(nullptr));
  json["details"] = std::move(details);
  return json;
}

/// The curves of the log-log plot.
std::vector<LogLogSeries> series_of(const FractalReadings& readings) {
  std::vector<LogLogSeries> series;
  const auto add = [&](const char* name, const std::optional<FractalEstimate>& estimate) {
    if (estimate) series.push_back({name, *estimate});
  };
  add("box", readings.box);
  add("information", readings.information);
  add("correlation", readings.correlation);
  add("probability", readings.probability);
  if (readings.fshot) series.push_back({"fshot", readings.fshot->estimate});
  if (readings.best) series.push_back({"best", readings.best->estimate});
  return series;
}

Json points_json(std::span<const Vec2> points) {
  Json json = Json::array();
  for (const Vec2 p : points) json.push_back({p.x, p.y});
  return json;
}

Json strip_symmetry(const GreyImage& image, const Console& console) {
  const FriezeSymmetry frieze = find_frieze_group(image);
  Json json{{"repeats", frieze.found}, {"reason", frieze.reason}, {"group", nullptr}};
  console.print(fmt::format("strip      {}: {}\n", frieze.found ? to_string(frieze.group) : "no group", frieze.reason));
  if (!frieze.found) return json;
  json["group"] = to_string(frieze.group);
  json["group_order"] = frieze.order;
  json["period_px"] = frieze.period_px;
  json["group_kept"] = frieze.kept;
  json["origin_x"] = frieze.origin_x;
  json["axis_y"] = frieze.axis_y;
  json["region_px"] = points_json(frieze.region_px);
  return json;
}

Json rosette_symmetry(const GreyImage& image, const Console& console) {
  const RosetteSymmetry rosette = find_rosette_group(image, {(image.width - 1) / 2.0, (image.height - 1) / 2.0});
  console.print(fmt::format("rosette    {} about ({:.1f}, {:.1f}), keeps {:.1f} %\n", rosette.name(),
                            rosette.centre_px.x, rosette.centre_px.y, 100 * rosette.kept));
  return {{"group", rosette.name()},
          {"rotations", rosette.rotations},
          {"mirrors", rosette.mirrors},
          {"group_kept", rosette.kept},
          {"centre_px", {rosette.centre_px.x, rosette.centre_px.y}},
          {"mirror_deg", rosette.mirrors ? Json(rosette.mirror_deg) : Json(nullptr)},
          {"sector_deg", rosette.sector_deg}};
}

Json symmetry(const SymmetryAnalysis& analysis, double pitch_mm, const Console& console) {
  const Lattice& lattice = analysis.lattice;
  Json json{{"lattice", lattice.found}, {"vectors_px", nullptr}, {"vectors_mm", nullptr}, {"group", nullptr}};
  json["explained_variance"] = analysis.explained_variance();
  json["significance"] = lattice.significance;
  json["reason"] = lattice.reason;
  const auto& [a, b] = lattice.vectors_px;
  if (lattice.found) {
    json["vectors_px"] = {{a.x, a.y}, {b.x, b.y}};
    if (pitch_mm > 0) json["vectors_mm"] = {{a.x * pitch_mm, a.y * pitch_mm}, {b.x * pitch_mm, b.y * pitch_mm}};
    json["cells"] = analysis.part->cells;
    const WallpaperSymmetry group = find_wallpaper_group(*analysis.part, lattice.vectors_px);
    json["group"] = to_string(group.group);
    json["group_order"] = group.order;
    json["group_kept"] = group.kept;
    json["origin_px"] = {group.origin_px.x, group.origin_px.y};
    json["region_px"] = points_json(group.region_px);
    json["groups_tried"] = Json::array();
    for (const WallpaperCandidate& candidate : group.candidates)
      json["groups_tried"].push_back(
          {{"group", to_string(candidate.group)}, {"kept", candidate.kept}, {"criterion", candidate.criterion}});
    console.print(fmt::format("symmetry   group {}: averaging over its {} operations keeps {:.1f} % of the cell\n",
                              to_string(group.group), group.order, 100 * group.kept));
    console.print(fmt::format(
        "symmetry   lattice ({:.2f}, {:.2f}), ({:.2f}, {:.2f}) pixels, significance {:.2f}, explains {:.0f} %\n", a.x,
        a.y, b.x, b.y, lattice.significance, 100 * analysis.explained_variance()));
  } else {
    console.print(
        fmt::format("symmetry   no lattice: {} (significance {:.2f})\n", lattice.reason, lattice.significance));
  }
  return json;
}

void add_class(Json& json, const OrderSurvey& order, const Console& console) {
  const TextureClass& c = order.kind;
  const OrientationField& field = order.orientation;
  const Suitability& s = order.suitability;
  json["class"] = {{"name", to_string(c.kind)},
                   {"disordered", c.disordered},
                   {"weakly_ordered", c.weakly_ordered},
                   {"strongly_ordered", c.strongly_ordered}};
  json["orientation"] = {{"columns", field.columns},
                         {"rows", field.rows},
                         {"angle_deg", field.angle_deg},
                         {"coherence", field.coherence},
                         {"mean_coherence", field.mean_coherence},
                         {"spread", field.spread}};
  json["suitability"] = {{"homogeneous", s.homogeneous},
                         {"directional", s.directional},
                         {"symmetric", s.symmetric},
                         {"monochrome", order.monochrome}};
  json["plan"] = Json::array();
  console.print(fmt::format("class      {}: disordered {:.2f}, weakly ordered {:.2f}, strongly ordered {:.2f}\n",
                            to_string(c.kind), c.disordered, c.weakly_ordered, c.strongly_ordered));
  for (const PlanStep& step : plan_analysis(c, s)) {
    json["plan"].push_back({{"step", step.step}, {"run", step.run}, {"reason", step.reason}});
    console.print(fmt::format("plan       {:<4} {:<20} {}\n", step.run ? "run" : "skip", step.step, step.reason));
  }
}

LatticeOptions lattice_options(const Arguments& arguments) {
  LatticeOptions options;
  if (arguments.lattice == "projection") options.method = LatticeMethod::projection;
  if (arguments.force_lattice) options.least_significance = 1e-9;  // The best lattice, whatever it explains.
  return options;
}

void write_pictures(const Arguments& arguments, const TextureSurvey& survey, const Console& console, Json& json) {
  namespace fs = std::filesystem;
  std::error_code failure;
  fs::create_directories(arguments.pictures, failure);
  if (failure) throw IoError(arguments.pictures + ": " + failure.message());
  const auto path = [&](const char* file) { return (fs::path(arguments.pictures) / file).string(); };
  const auto written = [&](const char* name, const std::string& file) {
    json["pictures"].push_back({{"name", name}, {"file", file}});
    console.print(fmt::format("written    {}\n", file));
  };
  json["pictures"] = Json::array();
  std::vector<std::string> captions = {"picture", "feature matrix", "no lattice", "", ""};
  if (survey.symmetry->part) captions = {"lattice", "feature matrix", "primitive", "synthesis", "rest"};
  write_color_image(path("symmetry.png"), with_captions(symmetry_strip(*survey.symmetry), captions));
  written("symmetry", path("symmetry.png"));
  console.print(
      "           from the left: picture with lattice, feature matrix with minima, primitive, synthesis, rest\n");
  if (!survey.fractal || !survey.fractal->best) return;
  for (const auto& [name, plot] : {std::pair{"log-log", log_log_plot(series_of(*survey.fractal))},
                                   {"hurst", hurst_plot(*survey.fractal->fshot)}}) {
    const std::string file = path((std::string(name) + ".svg").c_str());
    if (write_plot(file, plot))
      written(name, file);
    else
      console.print(fmt::format("not drawn  {}: gnuplot is not installed\n", file));
  }
}

Json pieces_json(const TextureSurvey& survey, const Console& console) {
  if (!survey.pieces) return nullptr;
  const PieceSurvey& pieces = *survey.pieces;
  const LatticeAgreement& lattice = pieces.lattice;
  console.print(fmt::format("pieces     {} x {}; symmetry from the middle {} x {} pixels\n", pieces.columns,
                            pieces.rows, survey.middle.width, survey.middle.height));
  if (survey.symmetry)
    console.print(fmt::format("pieces     lattice as in the middle {}, another {}, none {}\n", lattice.same,
                              lattice.other, lattice.none));
  return {{"columns", pieces.columns},
          {"rows", pieces.rows},
          {"symmetry_px", {survey.middle.width, survey.middle.height}},
          {"lattice", {{"same", lattice.same}, {"other", lattice.other}, {"none", lattice.none}}}};
}

Json run(const Arguments& arguments, VerbContext& context) {
  const std::set<std::string> wanted(arguments.only.begin(), arguments.only.end());
  SurveyOptions options;
  options.fractal = wanted.contains("fractal");
  options.symmetry = wanted.contains("symmetry") || !arguments.pictures.empty();
  options.order = wanted.contains("class");
  options.lattice = lattice_options(arguments);
  options.feature = arguments.feature == "absolute" ? FeatureKind::absolute : FeatureKind::squared;
  const TextureSurvey survey = survey_picture(arguments.image, options, context.progress);
  const double pitch = arguments.pitch_mm > 0 ? arguments.pitch_mm : survey.pitch_mm;
  const Console& console = context.console;
  console.print(
      fmt::format("{}: {} x {} pixels, {} bit, pitch {}\n", arguments.image, survey.width, survey.height, survey.bits,
                  pitch > 0 ? fmt::format("{:.4f} mm", pitch) : "unknown (no resolution in the file, no --pitch)"));
  Json json{{"image", arguments.image}, {"size", {survey.width, survey.height}}, {"bits", survey.bits}};
  json["pieces"] = pieces_json(survey, console);
  json["pitch_mm"] = pitch > 0 ? Json(pitch) : Json(nullptr);
  if (survey.fractal) json["fractal"] = fractal(*survey.fractal, console);
  if (wanted.contains("symmetry")) {
    json["symmetry"] = symmetry(*survey.symmetry, pitch, console);
    if (arguments.pattern == "strip") json["strip"] = strip_symmetry(survey.middle, console);
    if (arguments.pattern == "rosette") json["rosette"] = rosette_symmetry(survey.middle, console);
  }
  if (survey.order) add_class(json, *survey.order, console);
  if (!arguments.pictures.empty()) write_pictures(arguments, survey, console, json);
  return json;
}

}  // namespace

void add_analyze(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb =
      add_verb(program,
               {"analyze", "Measures the roughness, symmetry and class of a texture",
                "papilla synthesize grain --kind quads6 -o quads.png && papilla analyze quads.png --pictures pictures"},
               [arguments](VerbContext& context) { return run(*arguments, context); });
  verb->add_option("image", arguments->image, "Picture")->required()->type_name("IMAGE");
  verb->add_option("--pitch", arguments->pitch_mm, "Millimetres per pixel; default from the file's resolution")
      ->type_name("MM")
      ->check(CLI::PositiveNumber);
  verb->add_option("--only", arguments->only, "Parts to analyse")
      ->delimiter(',')
      ->check(CLI::IsMember({"fractal", "symmetry", "class"}))
      ->capture_default_str();
  verb->add_option("--pictures", arguments->pictures,
                   "Write the strip of the symmetry, the log-log plot and the polar Hurst plot into DIR")
      ->type_name("DIR");
  verb->add_option("--lattice", arguments->lattice, "How minima become a lattice")
      ->check(CLI::IsMember({"best", "projection"}))
      ->capture_default_str();
  verb->add_option("--feature", arguments->feature, "Distortion of the feature matrix; absolute is slow")
      ->check(CLI::IsMember({"squared", "absolute"}))
      ->capture_default_str();
  verb->add_flag("--force-lattice", arguments->force_lattice, "Take the best lattice even if it is not significant");
  verb->add_option("--pattern", arguments->pattern,
                   "strip adds the frieze group of a strip along x, rosette the group about the middle of the picture")
      ->check(CLI::IsMember({"plane", "strip", "rosette"}))
      ->capture_default_str();
}

}  // namespace papilla::app
