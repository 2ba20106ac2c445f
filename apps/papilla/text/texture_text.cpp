// SPDX-License-Identifier: GPL-3.0-or-later
#include "text/texture_text.hpp"

#include <algorithm>

#include "shown_format.hpp"
#include "text/hertz.hpp"

namespace papilla::app {
namespace {

/// A text that grows by formatted pieces.
class Lines {
 public:
  template <class... Values>
  void add(fmt::format_string<ShownValue<Values>...> format, const Values&... values) {
    text_ += shown_format(format, values...);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void add_readings(Lines& lines, const FractalReadings& readings) {
  for (const FractalReading& reading : named_readings(readings)) {
    if (reading.has_dimension())
      lines.add("fractal    {:<12} D = {:.3f}  [{:.3f}, {:.3f}]\n", reading.name, reading.estimate->dimension,
                reading.estimate->low, reading.estimate->high);
    else if (reading.estimate)
      lines.add("fractal    {:<12} no dimension: outside 2 to 3\n", reading.name);
    else if (!reading.none.empty())
      lines.add("fractal    {:<12} no dimension: {}\n", reading.name, reading.none);
    else
      lines.add("fractal    {:<12} needs {} pixels a side\n", reading.name, reading.least_side);
  }
  if (!readings.best || !readings.best->power_law()) return;
  const BestDimension& best = *readings.best;
  lines.add(
      "fractal    {} over wavelengths of {:.1f} to {:.0f} pixels; point spread {:.2f} px, noise {:.4f}, misfit "
      "{:.2f}\n",
      best.reason, best.least_scale_px, best.most_scale_px, best.psf_sigma_px, best.noise_rms, best.chi2_per_dof);
}

void add_groups(Lines& lines, const TextureSurvey& survey) {
  const SymmetryAnalysis& analysis = *survey.symmetry;
  const Lattice& lattice = analysis.lattice;
  if (const auto& group = survey.groups->plane) {
    const auto& [a, b] = lattice.vectors_px;
    lines.add("symmetry   group {}: averaging over its {} operations keeps {:.1f} % of the cell\n",
              to_string(group->group), group->order, 100 * group->kept);
    lines.add("symmetry   lattice ({:.2f}, {:.2f}), ({:.2f}, {:.2f}) pixels, significance {:.2f}, explains {:.0f} %\n",
              a.x, a.y, b.x, b.y, lattice.significance, 100 * analysis.explained_variance());
    if (const auto& bent = analysis.deformation)
      lines.add("symmetry   the lattice bends: displaced by {:.1f} % of the cell (rms), {:.1f} % at most\n",
                bent->rms_percent_of_cell, bent->max_percent_of_cell);
  } else {
    lines.add("symmetry   no lattice: {} (significance {:.2f})\n", lattice.reason, lattice.significance);
  }
  if (const auto& strip = survey.groups->strip)
    lines.add("strip      {}: {}\n", strip->found ? to_string(strip->group) : "no group", strip->reason);
  if (const auto& rosette = survey.groups->rosette)
    lines.add("rosette    {} about ({:.1f}, {:.1f}), keeps {:.1f} %\n", rosette->name(), rosette->centre_px.x,
              rosette->centre_px.y, 100 * rosette->kept);
}

void add_order(Lines& lines, const OrderSurvey& order) {
  const TextureClass& c = order.kind;
  lines.add("class      {}: disordered {:.2f}, weakly ordered {:.2f}, strongly ordered {:.2f}\n", to_string(c.kind),
            c.disordered, c.weakly_ordered, c.strongly_ordered);
  for (const PlanStep& step : order.plan)
    lines.add("plan       {:<4} {:<20} {}\n", step.run ? "run" : "skip", step.step, step.reason);
}

void add_written(Lines& lines, const std::string& file, bool drawn) {
  if (drawn)
    lines.add("written    {}\n", file);
  else
    lines.add("not drawn  {}: gnuplot is not installed\n", file);
}

void add_touch(Lines& lines, const TextureSurvey& survey) {
  const TouchSurvey& touch = *survey.touch;
  std::string shares;
  for (std::size_t i = 0; i < k_touch_receptors.size(); ++i)
    shares += shown_format("{} {:.0f} %, ", k_touch_receptors[i].name, 100 * touch.receptor_shares[i]);
  lines.add("touch      at {:g} m/s waves of {} to {} Hz; of the variance in the bands of {}faster {:.0f} %\n",
            touch.speed_m_per_s, hertz(touch.slowest_hz), hertz(touch.fastest_hz), shares, 100 * touch.unfelt_share);
  if (touch.needed_width < survey.width || touch.needed_height < survey.height)
    lines.add("           {} x {} pixels are as fine as any hand feels\n", touch.needed_width, touch.needed_height);
}

void add_numbers(Lines& lines, const char* when, const PictureNumbers& n) {
  lines.add(
      "{:<10} {} x {}, contrast {:.3f}, gradient {:.2f}, contrast ratio {:.2f}, knots {}, seams {:.2f} / {:.2f}, {}\n",
      when, n.width, n.height, n.contrast, n.gradient, n.contrast_ratio, n.knots, n.tiling.seam_x, n.tiling.seam_y,
      n.tiling.tiles ? "tiles" : "does not tile");
}

void add_channels(Lines& lines, const std::vector<ChannelFile>& channels) {
  for (const ChannelFile& channel : channels)
    lines.add("{:<24} {:.4f} to {:.4f}, mean {:.4f}\n", channel.file, static_cast<double>(channel.low),
              static_cast<double>(channel.high), channel.mean);
}

}  // namespace

std::string survey_text(const std::string& image, const TextureSurvey& survey) {
  Lines lines;
  lines.add("{}: {} x {} pixels, {} bit, pitch {}\n", image, survey.width, survey.height, survey.bits,
            survey.pitch_mm > 0 ? shown_format("{:.4f} mm", survey.pitch_mm)
                                : "unknown (no resolution in the file, no --pitch)");
  if (survey.pieces) {
    const auto& [columns, rows, lattice] = *survey.pieces;
    lines.add("pieces     {} x {}; symmetry from the middle {} x {} pixels\n", columns, rows, survey.middle.width,
              survey.middle.height);
    if (survey.symmetry)
      lines.add("pieces     lattice as in the middle {}, another {}, none {}\n", lattice.same, lattice.other,
                lattice.none);
  }
  if (survey.fractal) add_readings(lines, *survey.fractal);
  if (!survey.no_fractal.empty()) lines.add("fractal    not measured: {}; --only fractal does\n", survey.no_fractal);
  if (survey.groups) add_groups(lines, survey);
  if (survey.order) add_order(lines, *survey.order);
  if (survey.touch) add_touch(lines, survey);
  for (const SurveyPicture& picture : survey.pictures) {
    add_written(lines, picture.file, picture.drawn);
    if (picture.name == "symmetry")
      lines.add(
          "           from the left: picture with lattice, feature matrix with minima, primitive, synthesis, rest\n");
  }
  return lines.take();
}

std::string height_text(const std::string& image, const std::string& output, const HeightFiles& files) {
  const HeightResult& result = files.result;
  Lines lines;
  lines.add("{}: {} ({})\n", image, to_string(result.method), result.reason);
  if (result.light_estimated)
    lines.add(
        "light      {:.2f}, {:.2f}, {:.2f}: azimuth estimated to +-{:.0f} degrees (coherence {:.2f}), elevation "
        "assumed\n",
        result.light.x, result.light.y, result.light.z, result.light_uncertainty_deg, result.light_coherence);
  if (result.ambiguous)
    lines.add("ambiguous  convex or concave: the picture does not tell, --alternative writes both\n");
  if (result.expected_correlation)
    lines.add("expected   correlation {:.2f} with the true relief\n", *result.expected_correlation);
  if (result.shadows_fraction + result.highlights_fraction > 0)
    lines.add("masked     {:.1f} % in shadow, {:.1f} % in highlights\n", 100 * result.shadows_fraction,
              100 * result.highlights_fraction);
  lines.add("relief     {} x {} samples, depth {:.3f} mm, rms {:.4f} mm, {}\n", result.map.width, result.map.height,
            result.depth_mm, result.rms_mm, result.map.periodic ? "tiles" : "does not tile");
  if (result.map.pitch_mm_x > 0)
    lines.add("pitch      {:.4f} mm a pixel\n", result.map.pitch_mm_x);
  else
    lines.add("pitch      unknown: the file has no resolution, give --pitch\n");
  if (result.pieces[0] * result.pieces[1] > 1)
    lines.add("pieces     {} x {}, {}\n", result.pieces[0], result.pieces[1],
              result.method == HeightMethod::tsai_shah
                  ? "the same as in one"
                  : "long waves from the picture made small, mixed where they overlap");
  if (result.tile) lines.add("tile       of the lattice, strain {:.2f} %\n", 100 * result.tile->strain);
  if (!result.trace.empty())
    lines.add("shading    residual {:.4f} after {} steps, {:.2f} s, {}\n", result.trace.back().error,
              result.trace.size(), result.trace.back().seconds, to_string(result.stop));
  if (result.roughness != HeightRoughness::whole)
    lines.add("roughness  {}, rms {:.4f} mm\n", to_string(result.roughness), result.roughness_rms_mm);
  if (result.guessed_share > 0)
    lines.add("guessed    {:.0f} % of the slopes run across the light\n", 100 * result.guessed_share);
  for (const std::string& what : result.measured) lines.add("measured   {}\n", what);
  for (const std::string& what : result.assumed) lines.add("assumed    {}\n", what);
  for (const PlanStep& step : files.plan)
    lines.add("{}          {:<20}  {}\n", step.run ? '+' : '-', step.step, step.reason);
  if (files.roughness)
    lines.add("apart      roughness of H {:.2f}, rms {:.4f} mm, waves of {:.3f} to {:.3f} mm\n", files.roughness->hurst,
              files.roughness->rms_mm, files.roughness->shortest_mm, files.roughness->longest_mm);
  lines.add("written    {}\n", output);
  if (!files.opposite.empty()) lines.add("written    {}: the same picture under the opposite light\n", files.opposite);
  for (const DeeperRelief& deeper : files.deeper) lines.add("written    {}\n", deeper.file);
  for (const ReliefPicture& picture : files.pictures)
    if (picture.exaggeration)
      lines.add("written    {}, heights times {:.3g}{}\n", picture.file, *picture.exaggeration,
                picture.scale_bar_mm > 0 ? shown_format(", the bar is {:g} mm", picture.scale_bar_mm) : "");
    else
      add_written(lines, picture.file, picture.drawn);
  return lines.take();
}

std::string stereo_text(const std::string& output, const StereoFiles& files) {
  const PhotometricStereoResult& stereo = files.stereo;
  const HeightResult& result = files.files.result;
  Lines lines;
  lines.add("photometric stereo of {} photographs, lights {}\n", stereo.lights.size(),
            stereo.lights_estimated ? "found" : "given");
  for (std::size_t k = 0; k < stereo.lights.size(); ++k)
    lines.add("light {:<4} {:.3f}, {:.3f}, {:.3f}; moved by {:.2f}, {:.2f} pixels\n", k + 1, stereo.lights[k].x,
              stereo.lights[k].y, stereo.lights[k].z, files.shifts_px[k].x, files.shifts_px[k].y);
  if (stereo.lights_estimated)
    lines.add("lights     known to about {:.1f} degrees{}\n", stereo.light_uncertainty_deg,
              stereo.two_sided ? "; convex or concave is not" : "");
  lines.add("relief     {} x {} samples, depth {:.3f} mm ({}), rms {:.4f} mm\n", result.map.width, result.map.height,
            result.depth_mm, files.depth_source, result.rms_mm);
  if (result.map.pitch_mm_x > 0)
    lines.add("pitch      {:.4f} mm a pixel\n", result.map.pitch_mm_x);
  else
    lines.add("pitch      unknown: give --pitch, or a ruler in --reference\n");
  lines.add("confidence {:.2f}, low in {:.1f} % of the pixels\n", files.mean_confidence,
            100 * files.low_confidence_fraction);
  lines.add("seen       {:.1f} % shadows, {:.1f} % highlights, {:.0f} % light from everywhere\n",
            100 * stereo.shadows_fraction, 100 * stereo.highlights_fraction, 100 * stereo.ambient);
  for (const ReferenceReading& reading : files.references) {
    lines.add("reference  {}: {:.5g}", reading.name, reading.value);
    if (reading.correlation) lines.add(", correlation {:.2f}", *reading.correlation);
    lines.add("\n");
  }
  for (const std::string& what : result.measured) lines.add("measured   {}\n", what);
  for (const std::string& what : result.assumed) lines.add("assumed    {}\n", what);
  lines.add("written    {}\n", output);
  return lines.take();
}

std::string prepared_text(const std::string& output, const PreparedPicture& prepared) {
  Lines lines;
  add_numbers(lines, "before", prepared.before);
  for (const PlanStep& step : prepared.steps)
    lines.add("{:<10} {:<16} {}\n", step.run ? "run" : "skip", step.step, step.reason);
  add_numbers(lines, "after", prepared.after);
  for (const std::string& warning : prepared.warnings) lines.add("warning    {}\n", warning);
  lines.add("written    {}\n", output);
  return lines.take();
}

std::string synthesis_text(const std::string& what, const std::string& output, const std::string& relief,
                           const Synthesis& synthesis, const SynthesisOptions& options) {
  Lines lines;
  if (!options.grain && options.tile && options.method == FractalSynthesis::exact)
    lines.add("--tile takes the spectral method: exact surfaces do not tile\n");
  if (const auto& like = synthesis.like)
    lines.add("like       {}: Sta {:.3f} (wanted {:.3f}), Str {:.3f} (wanted {:.3f})\n", options.like.string(),
              like->achieved.sta, like->target.sta, like->achieved.str, like->target.str);
  const HeightMap& map = synthesis.relief;
  const auto [low, high] = std::minmax_element(map.mm.begin(), map.mm.end());
  lines.add("{} {}: {} x {} pixels of {:.4f} mm, heights {:.3f} to {:.3f} mm, {}\nwritten {}{}{}\n", what,
            synthesis.method, map.width, map.height, map.pitch_mm_x, *low, *high,
            map.periodic ? "tiles" : "does not tile", output, relief.empty() ? "" : " and ", relief);
  return lines.take();
}

std::string photograph_text(const std::string& relief, const std::string& output, const PhotographFile& made) {
  Lines lines;
  lines.add("photo of {}: {} x {} pixels of {:.4f} mm, {:.1f} % in shadow, {:.1f} % at white\nwritten {}\n", relief,
            made.photograph.picture.width, made.photograph.picture.height, made.pitch_mm,
            100 * made.photograph.shadows_fraction, 100 * made.photograph.clipped_fraction, output);
  return lines.take();
}

std::string texture_text(const TextureFiles& files) {
  Lines lines;
  add_channels(lines, files.channels);
  return lines.take();
}

std::string wang_text(const WangFiles& files) {
  Lines lines;
  add_channels(lines, files.channels);
  lines.add("{:<24} 8 x 8 tiles of {} texels; along their cuts texels differ {:.2f} times as much as neighbours\n",
            files.plane, files.side, files.seam_cost);
  return lines.take();
}

}  // namespace papilla::app
