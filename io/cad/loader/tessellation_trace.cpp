// SPDX-License-Identifier: MIT
#include "papilla/io/tessellation_trace.hpp"

#include <cmath>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla {

std::vector<double> chord_ladder(double coarsest_mm, double finest_mm, std::size_t steps) {
  if (!(finest_mm > 0 && coarsest_mm > finest_mm && std::isfinite(coarsest_mm)))
    throw InvalidInput("chord_ladder: chords must be finite and coarsest > finest > 0, got " +
                       std::to_string(coarsest_mm) + " and " + std::to_string(finest_mm));
  if (steps < 2) throw InvalidInput("chord_ladder: steps must be at least 2, got " + std::to_string(steps));
  std::vector<double> chords;
  for (std::size_t i = 0; i < steps; ++i)
    chords.push_back(coarsest_mm *
                     std::pow(finest_mm / coarsest_mm, static_cast<double>(i) / static_cast<double>(steps - 1)));
  chords.back() = finest_mm;
  return chords;
}

std::vector<TessellationSample> trace_tessellation(const std::filesystem::path& path,
                                                   const std::vector<double>& chords_mm, CadReadOptions options,
                                                   const ProgressCallback& progress) {
  std::vector<TessellationSample> samples;
  for (const double chord : chords_mm) {
    report_progress(progress, "tessellate",
                    static_cast<double>(samples.size()) / static_cast<double>(chords_mm.size()));
    options.chord_mm = chord;
    CadReport report;
    read_cad(path, options, &report);
    samples.push_back({chord, report.seconds_tessellate, report.max_deviation_mm, report.max_angle_deg,
                       report.triangles, report.failed_faces.size(), report.off_faces.size()});
  }
  report_progress(progress, "tessellate", 1);
  return samples;
}

}  // namespace papilla
