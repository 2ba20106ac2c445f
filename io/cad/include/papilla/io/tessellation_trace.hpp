// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/cad_reader.hpp"

namespace papilla {

/// One step of a ladder of tolerances.
struct TessellationSample {
  double chord_mm = 0;      ///< Asked for.
  double seconds = 0;       ///< Wall time of tessellation, refinement and measurement; reading the file is not counted.
  double deviation_mm = 0;  ///< Measured: CadReport::max_deviation_mm.
  double angle_deg = 0;     ///< Measured: CadReport::max_angle_deg.
  std::size_t triangles = 0;
  std::size_t failed_faces = 0, off_faces = 0;
};

/// Chords from `coarsest` down to `finest`, both included, evenly spaced in their logarithm.
/// @param steps at least 2; coarsest > finest > 0.
/// @throws InvalidInput when they are not.
std::vector<double> chord_ladder(double coarsest_mm, double finest_mm, std::size_t steps);

/// Error over run time of tessellation: the file at each chord, the other options as given. The file is read anew each
/// time, so that no step profits from the one before.
/// @throws as read_cad().
std::vector<TessellationSample> trace_tessellation(const std::filesystem::path& path,
                                                   const std::vector<double>& chords_mm, CadReadOptions options = {},
                                                   const ProgressCallback& progress = {});

}  // namespace papilla
