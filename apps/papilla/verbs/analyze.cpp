// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <set>
#include <span>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/analysis_pictures.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/frieze_group.hpp"
#include "papilla/texture/fshot_dimension.hpp"
#include "papilla/texture/probability_dimension.hpp"
#include "papilla/texture/texture_class.hpp"
#include "papilla/texture/wallpaper_group.hpp"
#include "pictures/texture_charts.hpp"
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

/// Methods whose time grows with the square of the side see this much of the middle of a picture.
constexpr int k_most_side = 4096;

GreyImage middle_of(const GreyImage& image) {
  const int width = std::min(image.width, k_most_side), height = std::min(image.height, k_most_side);
  if (width == image.width && height == image.height) return image;
  GreyImage part{width, height, {}, image.pitch_mm, image.bits};
  const int left = (image.width - width) / 2, top = (image.height - height) / 2;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) part.pixels.push_back(image.at(left + x, top + y));
  return part;
}

/// The estimate by one method, or nothing when the picture is too small for it.
using Estimator = FractalEstimate (*)(const GreyImage&);
struct Method {
  const char* name;
  int least_side;
  Estimator estimate;
};
constexpr Method k_methods[] = {
    {"box", 32, box_dimension},
    {"information", 32, information_dimension},
    {"correlation", 32, correlation_dimension},
    {"probability", 66, [](const GreyImage& image) { return probability_dimension(image); }},
    {"fshot", 32, [](const GreyImage& image) { return fshot_dimension(image).estimate; }},
    {"best", 32, [](const GreyImage& image) { return best_dimension(image).estimate; }}};

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

/// What the charts show.
struct FractalResult {
  std::vector<LogLogSeries> series;
  FshotSignature signature;
};

Json fractal(const GreyImage& image, const VerbContext& context, FractalResult& result) {
  const Console& console = context.console;
  Json json = Json::object(), details = Json::object();
  double done = 0;
  for (const Method& method : k_methods) {
    if (context.progress) context.progress("fractal dimension", done++ / (std::size(k_methods) + 1));
    if (std::min(image.width, image.height) < method.least_side) {
      json[method.name] = nullptr;
      console.print(fmt::format("fractal    {:<12} needs {} pixels a side\n", method.name, method.least_side));
      continue;
    }
    FractalEstimate e;
    if (std::string_view(method.name) == "fshot") {
      result.signature = fshot_dimension(image);
      e = result.signature.estimate;
      json[method.name] = fshot_json(result.signature);
    } else {
      e = method.estimate(image);
      json[method.name] = e.dimension;
    }
    result.series.push_back({method.name, e});
    details[method.name] = curve_json(e);
    if (std::string_view(method.name) == "best") {
      const BestDimension best = best_dimension(image);
      json[method.name] = {{"dimension", e.dimension}, {"hurst", e.hurst}, {"low", e.low}, {"high", e.high}};
      json[method.name]["directional_hurst"] = {{"0", best.directional_hurst[0]},
                                                {"90", best.directional_hurst[1]},
                                                {"45", best.directional_hurst[2]},
                                                {"-45", best.directional_hurst[3]}};
      json[method.name]["quantization_step"] = best.quantization_step;
    }
    console.print(
        fmt::format("fractal    {:<12} D = {:.3f}  [{:.3f}, {:.3f}]\n", method.name, e.dimension, e.low, e.high));
  }
  json["details"] = std::move(details);
  return json;
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

void add_class(Json& json, const GreyImage& image, const SymmetryAnalysis& analysis, bool monochrome,
               const Console& console) {
  const TextureClass c = classify(image, analysis.explained_variance(), analysis.lattice.stripes);
  const OrientationField field = orientation_field(image);
  const Suitability s = measure_suitability(image, analysis.lattice);
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
                         {"monochrome", monochrome}};
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

void write_pictures(const Arguments& arguments, const SymmetryAnalysis& analysis, const FractalResult& result,
                    const Console& console, Json& json) {
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
  write_color_image(path("symmetry.png"), symmetry_strip(analysis));
  written("symmetry", path("symmetry.png"));
  if (result.series.empty()) return;
  write_atomically(path("log-log.svg"), log_log_chart(result.series));
  written("log-log", path("log-log.svg"));
  write_atomically(path("hurst.svg"), hurst_chart(result.signature));
  written("hurst", path("hurst.svg"));
}

Json run(const Arguments& arguments, VerbContext& context) {
  const std::set<std::string> wanted(arguments.only.begin(), arguments.only.end());
  const GreyImage whole = read_grey_image(arguments.image), image = middle_of(whole);
  const double pitch = arguments.pitch_mm > 0 ? arguments.pitch_mm : image.pitch_mm;
  const Console& console = context.console;
  console.print(
      fmt::format("{}: {} x {} pixels, {} bit, pitch {}\n", arguments.image, whole.width, whole.height, image.bits,
                  pitch > 0 ? fmt::format("{:.4f} mm", pitch) : "unknown (no resolution in the file, no --pitch)"));
  if (image.pixels.size() < whole.pixels.size())
    console.print(fmt::format("analysed   the middle {} x {} pixels\n", image.width, image.height));
  Json json{{"image", arguments.image}, {"size", {whole.width, whole.height}}, {"bits", image.bits}};
  json["analysed_px"] = {image.width, image.height};
  json["pitch_mm"] = pitch > 0 ? Json(pitch) : Json(nullptr);
  const bool needs_symmetry = wanted.contains("symmetry") || wanted.contains("class") || !arguments.pictures.empty();
  SymmetryAnalysis analysis;
  if (needs_symmetry)
    analysis = analyze_symmetry(image, lattice_options(arguments),
                                arguments.feature == "absolute" ? FeatureKind::absolute : FeatureKind::squared);
  FractalResult result;
  if (wanted.contains("fractal")) json["fractal"] = fractal(image, context, result);
  if (wanted.contains("symmetry")) {
    json["symmetry"] = symmetry(analysis, pitch, console);
    if (arguments.pattern == "strip") json["strip"] = strip_symmetry(image, console);
    if (arguments.pattern == "rosette") json["rosette"] = rosette_symmetry(image, console);
  }
  if (wanted.contains("class"))
    add_class(json, image, analysis, is_monochrome(read_color_image(arguments.image)), console);
  if (!arguments.pictures.empty()) write_pictures(arguments, analysis, result, console, json);
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
