// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/io/tessellation_trace.hpp"

#include <fmt/format.h>

#include "evaluate/evaluation.hpp"
#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

/// From a room's distance to what a fingertip feels.
constexpr double k_coarsest_mm = 2, k_finest_mm = 0.02;
constexpr std::size_t k_steps = 7;

CadReadOptions cad_options(const ReadOptions& read) {
  CadReadOptions options;
  options.angle_deg = read.angle_deg;
  options.millimetres_per_unit = read.cad_millimetres_per_unit;
  return options;
}

}  // namespace

std::vector<EvaluationRun> evaluate_tessellation(const EvaluationInput& input) {
  if (!is_cad_extension(input.file))
    throw InvalidInput(input.file + ": is no CAD file (.step .stp .p21 .iges .igs .brep .brp)");
  const ReadOptions read = input.read.read_options();
  EvaluationRun deviation{"tessellation",
                          fmt::format("chord, {:g} degrees", read.angle_deg),
                          input.name,
                          "deviation from the surface [mm]",
                          {},
                          "direct",
                          ""};
  for (const TessellationSample& sample : trace_tessellation(
           input.file, chord_ladder(k_coarsest_mm, k_finest_mm, k_steps), cad_options(read), input.progress)) {
    deviation.trace.push_back({sample.seconds, sample.deviation_mm});
    deviation.notes +=
        fmt::format("chord {:.3g} mm: {} triangles, deviation {:.3g} mm, {} faces failed, {} off; ", sample.chord_mm,
                    sample.triangles, sample.deviation_mm, sample.failed_faces, sample.off_faces);
  }
  return {std::move(deviation)};
}

}  // namespace papilla::app
