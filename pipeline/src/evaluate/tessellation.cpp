// SPDX-License-Identifier: MIT
#include "papilla/io/tessellation_trace.hpp"

#include <fmt/format.h>

#include "evaluate/kinds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/natural.hpp"

namespace papilla {
namespace {

/// From invisible across a room to below what a fingertip can feel.
constexpr double k_coarsest_mm = 2, k_finest_mm = 0.02;
constexpr std::size_t k_steps = 7, k_natural_steps = 5;
constexpr double k_growth = 2.2;

CadReadOptions cad_options(const ReadOptions& read) {
  CadReadOptions options;
  options.angle_deg = read.angle_deg;
  options.millimetres_per_unit = read.millimetres_per_unit;
  return options;
}

/// The map by the CAD surfaces' own parameters, of all parts at each of the coarser chords.
EvaluationRun natural_run(const EvaluationInput& input, const std::vector<double>& chords, CadReadOptions options) {
  EvaluationRun run{"natural", "", input.name, "mean angle error of the CAD surfaces' own u and v [°]", {}, "direct"};
  Ladder ladder(input.budget, k_growth);
  for (const double chord : chords) {
    if (!ladder.next()) break;
    options.chord_mm = chord;
    const Scene scene = read_cad(input.file, options);
    double seconds = 0, sum = 0, area = 0;
    std::size_t triangles = 0;
    for (const Part& part : scene.parts) {
      if (part.mesh.triangles.empty() || part.mesh.cad_uv.empty()) continue;
      const Stopwatch clock;
      const Flattening flattening = flatten_natural(part.mesh);
      seconds += clock.seconds();
      const DistortionReport report = measure_distortion(part.mesh, flattening.uv);
      sum += report.area_mm2 * report.angle_error_deg.mean;
      area += report.area_mm2;
      triangles += part.mesh.triangles.size();
    }
    if (area > 0) run.trace.push_back({seconds, sum / area});
    run.notes += fmt::format("chord {:.3g} mm: {} triangles; ", chord, triangles);
  }
  if (run.trace.empty()) run.stop = k_time_spent;
  return run;
}

}  // namespace

std::vector<EvaluationRun> evaluate_tessellation(const EvaluationInput& input) {
  if (!is_cad_extension(input.file))
    throw InvalidInput(input.file + ": is no CAD file (.step .stp .p21 .iges .igs .brep .brp)");
  const ReadOptions& read = input.read;
  EvaluationRun deviation{"tessellation",
                          fmt::format("chord, {:g} degrees", read.angle_deg),
                          input.name,
                          "deviation from the surface [mm]",
                          {},
                          "direct",
                          ""};
  std::vector<double> chords = chord_ladder(k_coarsest_mm, k_finest_mm, k_steps);
  const Budget half = input.budget.share(2);
  Ladder ladder(half, k_growth);
  for (const double chord : chords) {
    if (!ladder.next()) break;
    const TessellationSample sample =
        trace_tessellation(input.file, {chord}, cad_options(read), input.progress).front();
    deviation.trace.push_back({sample.seconds, sample.deviation_mm});
    deviation.notes +=
        fmt::format("chord {:.3g} mm: {} triangles, deviation {:.3g} mm, {} faces failed, {} off; ", sample.chord_mm,
                    sample.triangles, sample.deviation_mm, sample.failed_faces, sample.off_faces);
  }
  if (deviation.trace.empty()) deviation.stop = k_time_spent;
  chords.resize(k_natural_steps);
  return {std::move(deviation), natural_run(input, chords, cad_options(read))};
}

}  // namespace papilla
