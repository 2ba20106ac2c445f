// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/pipeline/evaluate/budget.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/read_options.hpp"
#include "papilla/io/scene.hpp"

namespace papilla {

/// What every kind of evaluation gets.
struct EvaluationInput {
  std::string file;
  std::string name;  ///< What reports call the file.
  ReadOptions read;
  ProgressCallback progress;
  Budget budget = {};
};

/// How the surface's area spreads over a kind of error: share i lies in [edges[i], edges[i + 1]).
struct ErrorShares {
  std::string error_name;
  std::vector<double> edges, shares;
};

/// One curve of error over run time.
struct EvaluationRun {
  std::string method;               ///< The name on the command line.
  std::string solver;               ///< The variant.
  std::string input;                ///< File, and the part of it.
  std::string error_name;           ///< With its unit.
  Trace trace;                      ///< Of several repeats: their median times.
  std::string stop;                 ///< to_string(StopReason), or why there is no trace.
  std::string notes = {};           ///< What the trace does not say, for people.
  bool valid = true;                ///< A result that can't be used is drawn, and is on no front.
  ErrorShares shares = {};          ///< Of the last sample; may be empty.
  std::vector<Trace> repeats = {};  ///< Every repeat as it was, the first one included.

  std::string name() const { return solver.empty() ? method : method + " (" + solver + ")"; }
};

/// A kind of evaluation: its name on the command line and what it does. One file each, below evaluate/.
struct EvaluationKind {
  std::string_view name;
  std::string_view summary;
  std::vector<EvaluationRun> (*run)(const EvaluationInput&);
};

/// weld(): boundary edges and deviation for a ladder of tolerances.
std::vector<EvaluationRun> evaluate_weld(const EvaluationInput& input);
/// simplify(): triangles and deviation for a ladder of tolerances.
std::vector<EvaluationRun> evaluate_simplification(const EvaluationInput& input);
/// read_cad(): deviation for a ladder of chords, and the angle error of the surfaces' own u and v. Takes CAD files
/// only.
std::vector<EvaluationRun> evaluate_tessellation(const EvaluationInput& input);

/// segment_charts(): distortion and seams for a ladder of seam costs.
std::vector<EvaluationRun> evaluate_charts(const EvaluationInput& input);

/// All ways to map one chart: error for a ladder of iterations, and the methods' own traces.
std::vector<EvaluationRun> evaluate_param(const EvaluationInput& input);
/// All estimators of the fractal dimension on growing middle parts of a picture: the interval's half width.
std::vector<EvaluationRun> evaluate_fractal(const EvaluationInput& input);
/// Both ways to a lattice and both feature matrices on growing middle parts of a picture: what stays unexplained.
std::vector<EvaluationRun> evaluate_symmetry(const EvaluationInput& input);
/// All ways from a picture to heights: the depth error over growing numbers of steps, or over growing middle parts for
/// methods without steps, for a relief in millimetres (a float picture, .exr or .tif, lit from three sides); the
/// residual of each step of shape from shading for any other picture.
std::vector<EvaluationRun> evaluate_height(const EvaluationInput& input);
/// The contact on a glTF file with haptic tags: a stroke felt at growing rates, against the same stroke at the
/// highest one; the time is that of all ticks of a second. Then a wall of its largest material on each simulated
/// device: where it begins to shake, and what passivity control does there.
std::vector<EvaluationRun> evaluate_contact(const EvaluationInput& input);

/// What a method on a picture of twice the side is expected to take more.
inline constexpr double k_growth_by_side = 4.5;

/// 64, 128, … and the side itself, at most 4096.
std::vector<int> rising_sides(int shorter_side);

/// All kinds, in the order of the help.
std::span<const EvaluationKind> evaluation_kinds();

/// The largest parts of a scene, most triangles first: what is evaluated when a file has many.
std::vector<std::uint32_t> largest_parts(const Scene& scene, std::size_t most);

/// What reports call a part: "file: part", or the file alone when the part is named like it.
std::string input_name(const EvaluationInput& input, const std::string& part);

/// Runs a kind once, then again as long as the budget has time for it, at most `repeats` times.
std::vector<EvaluationRun> run_repeatedly(const EvaluationKind& kind, const EvaluationInput& input, int repeats);

/// Adds a further repeat of the same runs: samples with equal errors get the median of their times.
void merge_repeat(std::vector<EvaluationRun>& runs, const std::vector<EvaluationRun>& repeat);

}  // namespace papilla
