// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>

#include "evaluate/evaluation.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/cad_reader.hpp"

namespace papilla::app {
namespace {

constexpr std::array<double, 7> k_chords_mm = {2, 1, 0.5, 0.2, 0.1, 0.05, 0.02};

}  // namespace

std::vector<EvaluationRun> evaluate_tessellation(const EvaluationInput& input) {
  if (!is_cad_extension(input.file))
    throw InvalidInput(input.file + ": is no CAD file (.step .stp .p21 .iges .igs .brep .brp)");
  const ReadOptions read = input.read.read_options();
  EvaluationRun deviation{"tessellation",
                          fmt::format("chord, {:g} degrees", read.angle_deg),
                          input.file,
                          "deviation from the surface [mm]",
                          {},
                          "direct",
                          ""};
  for (const double chord : k_chords_mm) {
    CadReadOptions options;
    options.chord_mm = chord;
    options.angle_deg = read.angle_deg;
    options.brep_mm_per_unit = read.millimetres_per_unit;
    CadReport report;
    read_cad(input.file, options, &report, input.progress);
    deviation.trace.push_back({report.seconds_tessellate, report.max_deviation_mm});
    deviation.notes += fmt::format("chord {:g} mm: {} triangles, deviation {:.3g} mm, {} faces failed; ", chord,
                                   report.triangles, report.max_deviation_mm, report.failed_faces.size());
  }
  return {std::move(deviation)};
}

}  // namespace papilla::app
