// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <set>

#include "papilla/core/error.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/texture/analysis_pictures.hpp"
#include "papilla/texture/best_dimension.hpp"
#include "papilla/texture/box_dimension.hpp"
#include "papilla/texture/probability_dimension.hpp"
#include "papilla/texture/texture_class.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string image, pictures;
  double pitch_mm = 0;
  std::vector<std::string> only = {"fractal", "symmetry", "class"};
};

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
    {"best", 32, [](const GreyImage& image) { return best_dimension(image).estimate; }}};

Json curve_json(const FractalEstimate& estimate) {
  Json json{{"low", estimate.low}, {"high", estimate.high}, {"curve", Json::array()}};
  for (const ScalePoint& point : estimate.curve)
    json["curve"].push_back({{"scale", point.scale}, {"measure", point.measure}});
  return json;
}

Json fractal(const GreyImage& image, const Console& console) {
  Json json = Json::object(), details = Json::object();
  for (const Method& method : k_methods) {
    if (std::min(image.width, image.height) < method.least_side) {
      json[method.name] = nullptr;
      console.print(fmt::format("fractal    {:<12} needs {} pixels a side\n", method.name, method.least_side));
      continue;
    }
    const FractalEstimate e = method.estimate(image);
    json[method.name] = e.dimension;
    details[method.name] = curve_json(e);
    if (std::string_view(method.name) == "best")
      json[method.name] = {{"dimension", e.dimension}, {"hurst", e.hurst}, {"low", e.low}, {"high", e.high}};
    console.print(
        fmt::format("fractal    {:<12} D = {:.3f}  [{:.3f}, {:.3f}]\n", method.name, e.dimension, e.low, e.high));
  }
  json["details"] = std::move(details);
  return json;
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
  const TextureClass c = classify(image, analysis.explained_variance());
  const Suitability s = measure_suitability(image, analysis.lattice);
  json["class"] = {{"name", to_string(c.kind)},
                   {"disordered", c.disordered},
                   {"weakly_ordered", c.weakly_ordered},
                   {"strongly_ordered", c.strongly_ordered}};
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

Json run(const Arguments& arguments, VerbContext& context) {
  const std::set<std::string> wanted(arguments.only.begin(), arguments.only.end());
  const GreyImage image = read_grey_image(arguments.image);
  const double pitch = arguments.pitch_mm > 0 ? arguments.pitch_mm : image.pitch_mm;
  const Console& console = context.console;
  console.print(
      fmt::format("{}: {} x {} pixels, {} bit, pitch {}\n", arguments.image, image.width, image.height, image.bits,
                  pitch > 0 ? fmt::format("{:.4f} mm", pitch) : "unknown (no resolution in the file, no --pitch)"));
  Json json{{"image", arguments.image}, {"size", {image.width, image.height}}, {"bits", image.bits}};
  json["pitch_mm"] = pitch > 0 ? Json(pitch) : Json(nullptr);
  const bool needs_symmetry = wanted.contains("symmetry") || wanted.contains("class") || !arguments.pictures.empty();
  const SymmetryAnalysis analysis = needs_symmetry ? analyze_symmetry(image) : SymmetryAnalysis{};
  if (wanted.contains("fractal")) json["fractal"] = fractal(image, console);
  if (wanted.contains("symmetry")) json["symmetry"] = symmetry(analysis, pitch, console);
  if (wanted.contains("class"))
    add_class(json, image, analysis, is_monochrome(read_color_image(arguments.image)), console);
  if (!arguments.pictures.empty()) {
    std::error_code failure;
    std::filesystem::create_directories(arguments.pictures, failure);
    if (failure) throw IoError(arguments.pictures + ": " + failure.message());
    const std::string file = (std::filesystem::path(arguments.pictures) / "symmetry.png").string();
    write_color_image(file, symmetry_strip(analysis));
    json["pictures"] = {{{"name", "symmetry"}, {"file", file}}};
    console.print(fmt::format("written    {}\n", file));
  }
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
  verb->add_option("--pictures", arguments->pictures, "Write pictures of the analysis into DIR")->type_name("DIR");
}

}  // namespace papilla::app
