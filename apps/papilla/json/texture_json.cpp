// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/texture_json.hpp"

#include <algorithm>
#include <numbers>

#include "json/scene_json.hpp"
#include "json/touch_json.hpp"
#include "papilla/texture/wang_tiles.hpp"

namespace papilla::app {
namespace {

Json positive_or_null(double value) { return value > 0 ? Json(value) : Json(nullptr); }

/// A number that is a dimension of a surface; null for any other.
Json dimension_json(double dimension) { return dimension >= 2 && dimension <= 3 ? Json(dimension) : Json(nullptr); }

/// Interval and curve; `slope`, what the method computes of the curve, where that is no dimension of a surface.
Json details_json(const FractalReading& reading) {
  Json json{{"low", nullptr}, {"high", nullptr}, {"curve", Json::array()}};
  if (reading.has_dimension()) {
    json["low"] = reading.estimate->low;
    json["high"] = reading.estimate->high;
  } else if (reading.estimate) {
    json["slope"] = reading.estimate->dimension;
  }
  for (const ScalePoint& point : *reading.curve)
    json["curve"].push_back({{"scale", point.scale}, {"measure", point.measure}});
  return json;
}

Json signature_json(const FshotSignature& s) {
  return {{"sta", s.sta},
          {"str", s.str},
          {"fs_h", dimension_json(s.fs_h)},
          {"fs_v", dimension_json(s.fs_v)},
          {"angle_deg", s.angle_deg}};
}

Json fshot_json(const FshotSignature& signature) {
  Json json = signature_json(signature);
  json["directions"] = Json::array();
  for (const DirectionalHurst& d : signature.directions)
    json["directions"].push_back({{"angle_deg", d.angle_deg}, {"hurst", d.hurst}, {"low", d.low}, {"high", d.high}});
  return json;
}

Json best_json(const BestDimension& best, double pitch_mm) {
  const auto& e = best.estimate;
  Json json{{"power_law", best.power_law()}, {"reason", best.reason}};
  json["dimension"] = e ? Json(e->dimension) : Json(nullptr);
  json["hurst"] = e ? Json(e->hurst) : Json(nullptr);
  json["low"] = e ? Json(e->low) : Json(nullptr);
  json["high"] = e ? Json(e->high) : Json(nullptr);
  const double unit = pitch_mm > 0 ? pitch_mm : 1;
  json[pitch_mm > 0 ? "scales_mm" : "scales_px"] =
      e ? Json{best.least_scale_px * unit, best.most_scale_px * unit} : Json(nullptr);
  json["psf_sigma_px"] = best.psf_sigma_px;
  json["noise_rms"] = best.noise_rms;
  json["fit"] = {{"chi2_per_dof", best.chi2_per_dof}};
  json["directional_hurst"] = nullptr;
  if (const auto& hurst = best.directional_hurst)
    json["directional_hurst"] = {{"0", (*hurst)[0]}, {"90", (*hurst)[1]}, {"45", (*hurst)[2]}, {"-45", (*hurst)[3]}};
  json["quantization_step"] = best.quantization_step;
  return json;
}

/// Null for methods that need a larger picture, and where what a method finds is no dimension of a surface.
Json fractal_json(const FractalReadings& readings, double pitch_mm) {
  Json json = Json::object(), details = Json::object();
  for (const FractalReading& reading : named_readings(readings)) {
    const std::string key(reading.name);
    json[key] = reading.has_dimension() ? Json(reading.estimate->dimension) : Json(nullptr);
    if (reading.curve) details[key] = details_json(reading);
  }
  if (readings.fshot) json["fshot"] = fshot_json(*readings.fshot);
  if (readings.best) json["best"] = best_json(*readings.best, pitch_mm);
  json["details"] = std::move(details);
  return json;
}

/// Of a picture whose class needs no dimension.
Json no_fractal_json(const std::string& reason, double pitch_mm) {
  Json json = Json::object();
  for (const FractalReading& reading : named_readings({})) json[std::string(reading.name)] = nullptr;
  BestDimension none;
  none.reason = reason;
  json["best"] = best_json(none, pitch_mm);
  return json;
}

template <class Points>
Json points_json(const Points& points) {
  Json json = Json::array();
  for (const Vec2 p : points) json.push_back({p.x, p.y});
  return json;
}

/// Zero for an exact lattice, null without one.
Json deformation_json(const SymmetryAnalysis& analysis) {
  if (!analysis.lattice.found) return nullptr;
  const auto& bent = analysis.deformation;
  return {{"rms_percent_of_cell", bent ? bent->rms_percent_of_cell : 0.0},
          {"max_percent_of_cell", bent ? bent->max_percent_of_cell : 0.0}};
}

Json symmetry_json(const TextureSurvey& survey) {
  const SymmetryAnalysis& analysis = *survey.symmetry;
  Json json{{"lattice", analysis.lattice.found}, {"vectors_px", nullptr}, {"vectors_mm", nullptr}, {"group", nullptr}};
  json["explained_variance"] = analysis.explained_variance();
  json["significance"] = analysis.lattice.significance;
  json["false_alarm_probability"] = analysis.false_alarm_probability;
  json["deformation"] = deformation_json(analysis);
  json["reason"] = analysis.lattice.reason;
  if (!survey.groups->plane) return json;
  const WallpaperSymmetry& group = *survey.groups->plane;
  const auto& [a, b] = analysis.lattice.vectors_px;
  json["vectors_px"] = {{a.x, a.y}, {b.x, b.y}};
  if (const double pitch = survey.pitch_mm; pitch > 0)
    json["vectors_mm"] = {{a.x * pitch, a.y * pitch}, {b.x * pitch, b.y * pitch}};
  json["cells"] = analysis.part->cells;
  json["group"] = to_string(group.group);
  json["group_order"] = group.order;
  json["group_kept"] = group.kept;
  json["origin_px"] = {group.origin_px.x, group.origin_px.y};
  json["region_px"] = points_json(group.region_px);
  json["groups_tried"] = Json::array();
  for (const WallpaperCandidate& candidate : group.candidates)
    json["groups_tried"].push_back(
        {{"group", to_string(candidate.group)}, {"kept", candidate.kept}, {"criterion", candidate.criterion}});
  return json;
}

Json strip_json(const FriezeSymmetry& frieze) {
  Json json{{"repeats", frieze.found}, {"reason", frieze.reason}, {"group", nullptr}};
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

Json rosette_json(const RosetteSymmetry& rosette) {
  return {{"group", rosette.name()},
          {"rotations", rosette.rotations},
          {"mirrors", rosette.mirrors},
          {"group_kept", rosette.kept},
          {"centre_px", {rosette.centre_px.x, rosette.centre_px.y}},
          {"mirror_deg", rosette.mirrors ? Json(rosette.mirror_deg) : Json(nullptr)},
          {"sector_deg", rosette.sector_deg}};
}

void add_order(Json& json, const OrderSurvey& order) {
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
  json["plan"] = steps_json(order.plan);
}

Json pieces_json(const TextureSurvey& survey) {
  if (!survey.pieces) return nullptr;
  const auto& [columns, rows, lattice] = *survey.pieces;
  return {{"columns", columns},
          {"rows", rows},
          {"symmetry_px", {survey.middle.width, survey.middle.height}},
          {"lattice", {{"same", lattice.same}, {"other", lattice.other}, {"none", lattice.none}}}};
}

/// The direction to the light; null for heights without one.
Json light_json(const HeightResult& result, Vec3 light) {
  return result.method != HeightMethod::intensity ? Json{light.x, light.y, light.z} : Json(nullptr);
}

/// Of a pixel: the expected correlation, 0 in shadows and highlights; low below a half.
Json confidence_json(const HeightResult& result) {
  if (!result.expected_correlation) return nullptr;
  constexpr double k_low = 0.5;
  const double masked = result.shadows_fraction + result.highlights_fraction;
  return {{"mean", *result.expected_correlation * (1 - masked)},
          {"low_fraction", *result.expected_correlation < k_low ? 1.0 : masked}};
}

Json alternative_json(const HeightFiles& files) {
  if (files.opposite.empty()) return nullptr;
  const Vec3 light = files.result.light;
  return {{"file", files.opposite},
          {"light", light_json(files.result, {-light.x, -light.y, light.z})},
          {"reason", files.result.method != HeightMethod::intensity
                         ? "light from the opposite azimuth on the inverted relief gives the same picture"
                         : "nothing in the picture says whether bright is high"}};
}

Json numbers_json(const PictureNumbers& n) {
  return {{"size", {n.width, n.height}},
          {"mean", n.mean},
          {"contrast", n.contrast},
          {"gradient", n.gradient},
          {"contrast_ratio", n.contrast_ratio},
          {"knots", n.knots},
          {"seam_x", n.tiling.seam_x},
          {"seam_y", n.tiling.seam_y},
          {"tiles", n.tiling.tiles}};
}

}  // namespace

Json steps_json(const AnalysisPlan& steps) {
  Json json = Json::array();
  for (const PlanStep& step : steps) json.push_back({{"step", step.step}, {"run", step.run}, {"reason", step.reason}});
  return json;
}

Json roughness_model_json(const std::optional<RoughnessModel>& roughness) {
  if (!roughness) return nullptr;
  constexpr double k_degrees = 180 / std::numbers::pi;
  return {{"hurst", roughness->hurst},
          {"rms_mm", roughness->rms_mm},
          {"rms_slope", roughness->rms_slope},
          {"wavelength_range_mm", {roughness->shortest_mm, roughness->longest_mm}},
          {"anisotropy", {{"ratio", roughness->anisotropy}, {"direction_deg", k_degrees * roughness->direction_rad}}}};
}

Json survey_json(const std::string& image, const TextureSurvey& survey) {
  Json json{{"image", image}, {"size", {survey.width, survey.height}}, {"bits", survey.bits}};
  json["pieces"] = pieces_json(survey);
  json["pitch_mm"] = positive_or_null(survey.pitch_mm);
  if (survey.fractal) json["fractal"] = fractal_json(*survey.fractal, survey.pitch_mm);
  if (!survey.no_fractal.empty()) json["fractal"] = no_fractal_json(survey.no_fractal, survey.pitch_mm);
  if (survey.groups) {
    json["symmetry"] = symmetry_json(survey);
    if (survey.groups->strip) json["strip"] = strip_json(*survey.groups->strip);
    if (survey.groups->rosette) json["rosette"] = rosette_json(*survey.groups->rosette);
  }
  if (survey.order) add_order(json, *survey.order);
  if (survey.touch) json["touch"] = touch_survey_json(*survey.touch);
  for (const SurveyPicture& picture : survey.pictures)
    if (picture.drawn) json["pictures"].push_back({{"name", picture.name}, {"file", picture.file}});
  return json;
}

Json height_json(const HeightFiles& files) {
  const HeightResult& result = files.result;
  Json json{{"method", to_string(result.method)}, {"reason", result.reason}};
  json["light"] = light_json(result, result.light);
  json["light_estimated"] = result.light_estimated;
  json["light_coherence"] = result.light_estimated ? Json(result.light_coherence) : Json(nullptr);
  json["lights"] = Json::array();
  if (result.method != HeightMethod::intensity) json["lights"].push_back(light_json(result, result.light));
  json["light_uncertainty_deg"] =
      result.method != HeightMethod::intensity ? Json(result.light_uncertainty_deg) : Json(nullptr);
  json["expected_correlation"] = result.expected_correlation ? Json(*result.expected_correlation) : Json(nullptr);
  json["confidence"] = confidence_json(result);
  json["ambiguity"] = result.ambiguous ? "convex-concave" : "none";
  json["shadows_fraction"] = result.shadows_fraction;
  json["highlights_fraction"] = result.highlights_fraction;
  json["decoded"] = to_string(result.decoded);
  json["unevenness"] = result.unevenness;
  json["size"] = {result.map.width, result.map.height};
  json["pitch_mm"] = positive_or_null(result.map.pitch_mm_x);
  json["depth_mm"] = result.depth_mm;
  json["rms_mm"] = result.rms_mm;
  json["periodic"] = result.map.periodic;
  json["roughness"] = {{"source", to_string(result.roughness)}, {"rms_mm", result.roughness_rms_mm}};
  json["shortest_wavelength_mm"] = positive_or_null(result.shortest_wavelength_mm);
  json["guessed_share"] = result.guessed_share;
  json["pieces"] = {{"columns", result.pieces[0]}, {"rows", result.pieces[1]}};
  json["tile"] = nullptr;
  if (result.tile)
    json["tile"] = {{"size", {result.tile->width, result.tile->height}},
                    {"lattice_vectors", result.tile->combination},
                    {"strain", result.tile->strain}};
  json["measured"] = result.measured;
  json["assumed"] = result.assumed;
  json["stop"] = to_string(result.stop);
  json["trace"] = trace_json(result.trace);
  if (!files.plan.empty()) {
    json["plan"] = steps_json(files.plan);
    json["overlay"] = roughness_model_json(files.roughness);
  }
  json["alternative"] = alternative_json(files);
  for (const auto& [factor, file] : files.deeper) json["variants"].push_back({{"factor", factor}, {"file", file}});
  for (const ReliefPicture& picture : files.pictures) {
    if (!picture.drawn) continue;
    Json entry{{"name", picture.name}, {"file", picture.file}};
    if (picture.exaggeration) {
      entry["exaggeration"] = *picture.exaggeration;
      entry["scale_bar_mm"] = positive_or_null(picture.scale_bar_mm);
    }
    json["pictures"].push_back(std::move(entry));
  }
  return json;
}

Json prepared_json(const std::string& image, const PreparedPicture& prepared) {
  return {{"image", image},
          {"before", numbers_json(prepared.before)},
          {"after", numbers_json(prepared.after)},
          {"pitch_mm", positive_or_null(prepared.image.pitch_mm)},
          {"steps", steps_json(prepared.steps)},
          {"warnings", prepared.warnings}};
}

Json synthesis_json(const std::string& what, const Synthesis& synthesis, const SynthesisOptions& options) {
  const HeightMap& relief = synthesis.relief;
  const auto [low, high] = std::minmax_element(relief.mm.begin(), relief.mm.end());
  Json json{{"what", what}, {"method", synthesis.method}, {"size", {relief.width, relief.height}}};
  json["pitch_mm"] = relief.pitch_mm_x;
  json["range"] = {*low, *high};
  json["periodic"] = relief.periodic;
  json["seed"] = options.seed;
  if (synthesis.hurst) json["hurst"] = *synthesis.hurst;
  if (synthesis.like)
    json["like"] = {{"image", options.like.string()},
                    {"target", signature_json(synthesis.like->target)},
                    {"achieved", signature_json(synthesis.like->achieved)},
                    {"hurst", synthesis.like->hurst},
                    {"hurst_across", synthesis.like->hurst_across}};
  return json;
}

Json photograph_json(const std::string& relief, const PhotographFile& made, const PhotographFileOptions& options) {
  const PhotographOptions& photo = options.photograph;
  return {{"what", "photo"},
          {"light", {photo.light.x, photo.light.y, photo.light.z}},
          {"pitch_mm", made.pitch_mm},
          {"range_mm", made.range_mm},
          {"blur_px", photo.blur_px},
          {"noise", photo.noise},
          {"truth", relief},
          {"size", {made.photograph.picture.width, made.photograph.picture.height}},
          {"ambient", photo.ambient},
          {"shadows_fraction", made.photograph.shadows_fraction},
          {"clipped_fraction", made.photograph.clipped_fraction},
          {"seed", photo.seed},
          {"surface_seed", photo.surface_seed}};
}

static Json channels_json(const std::vector<ChannelFile>& channels) {
  Json json = Json::array();
  for (const ChannelFile& channel : channels) {
    Json entry{{"name", to_string(channel.channel)},
               {"file", channel.file},
               {"min", channel.low},
               {"max", channel.high},
               {"mean", channel.mean}};
    if (channel.time) entry["time"] = *channel.time;
    json.push_back(std::move(entry));
  }
  return json;
}

Json wang_json(const WangFiles& files) {
  Json tiles = Json::array();
  for (int index = 0; index < k_wang_tiles; ++index) {
    const WangTile tile = wang_tile(index);
    tiles.push_back({{"north", tile.north}, {"west", tile.west}, {"south", tile.south}, {"east", tile.east}});
  }
  return {{"side", files.side},
          {"tiles", std::move(tiles)},
          {"channels", channels_json(files.channels)},
          {"plane", files.plane},
          {"seam_cost", files.seam_cost}};
}

Json texture_json(const TextureFiles& files) {
  const ProceduralTexture& texture = *files.texture;
  Json json{
      {"recipe", files.recipe}, {"size", {files.width, files.height}}, {"channels", channels_json(files.channels)}};
  if (!files.normal_maps.empty()) json["normal_maps"] = files.normal_maps;
  if (!files.previews.empty()) json["previews"] = files.previews;
  json["uses"] = texture.recipes_used();
  json["depends_on"] = {{"time", texture.depends_on_time()},         {"normal", texture.depends_on_normal()},
                        {"position", texture.depends_on_position()}, {"sky", texture.depends_on_sky()},
                        {"flow", texture.depends_on_flow()},         {"neighbours", texture.depends_on_neighbours()}};
  json["seconds"] = files.seconds;
  if (!files.video.empty()) json["video"] = files.video;
  return json;
}

Json sheet_json(const ContactSheet& sheet) {
  Json json{{"sheet", "sheet.png"}, {"page", "sheet.html"}, {"columns", sheet.columns}, {"entries", Json::array()}};
  for (const SheetEntry& e : sheet.entries)
    json["entries"].push_back({{"name", e.name},
                               {"recipe", e.recipe},
                               {"uses", e.uses},
                               {"min", e.low},
                               {"max", e.high},
                               {"mean", e.mean},
                               {"seam", e.seam},
                               {"exposure", e.exposure},
                               {"error", e.error}});
  return json;
}

}  // namespace papilla::app
