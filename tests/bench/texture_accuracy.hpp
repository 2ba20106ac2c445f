// SPDX-License-Identifier: MIT
#pragma once

#include "bench/bench_json.hpp"

namespace papilla::bench {

// Errors against known answers, one promise and its table each. Nothing is timed.

/// The two published tables beside what the library reads from its own surfaces.
void report_published_tables(BenchReport& report);
/// Error of the best dimension on exact surfaces, floating-point and 8-bit, and of Gwyddion's where it is there.
void report_dimension_error(BenchReport& report);
/// Lattices and groups of 1700 generated pictures; false lattices on pictures without one.
void report_symmetry(BenchReport& report);
/// Lattices and groups of patterns whose cells are displaced.
void report_bent_lattices(BenchReport& report);
/// Depth error of shape from shading on known reliefs, and whether anything is ever not finite.
void report_height(BenchReport& report);
/// Correlation with the truth of reliefs from one photograph in three conditions, light given and unknown.
void report_one_photograph(BenchReport& report);
/// Correlation with the truth of reliefs from four photographs, lights given and unknown, still and moved.
void report_stereo(BenchReport& report);
/// Lattices of photographs given on the command line, and a relief that ships beside its photograph.
void report_photographs(BenchReport& report);

}  // namespace papilla::bench
