// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilla/core/trace.hpp"
#include "scene_options.hpp"
#include "verb.hpp"

namespace papilla::app {

/// What every kind of evaluation gets.
struct EvaluationInput {
  std::string file;
  SceneOptions read;
  Progress progress;
};

/// One curve of error over run time.
struct EvaluationRun {
  std::string method;      ///< The name on the command line.
  std::string solver;      ///< The variant.
  std::string input;       ///< File, and the part of it.
  std::string error_name;  ///< With its unit.
  Trace trace;
  std::string stop;   ///< to_string(StopReason).
  std::string notes;  ///< What the trace does not say, for people.
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
/// read_cad(): deviation for a ladder of chords. Takes CAD files only.
std::vector<EvaluationRun> evaluate_tessellation(const EvaluationInput& input);

/// All ways to map one chart: error for a ladder of iterations, and the methods' own traces.
std::vector<EvaluationRun> evaluate_param(const EvaluationInput& input);
/// All estimators of the fractal dimension on growing middle parts of a picture: the interval's half width.
std::vector<EvaluationRun> evaluate_fractal(const EvaluationInput& input);
/// Both ways to a lattice and both feature matrices on growing middle parts of a picture: what stays unexplained.
std::vector<EvaluationRun> evaluate_symmetry(const EvaluationInput& input);
/// All shape-from-shading methods: the depth error over growing numbers of steps for a relief in millimetres (a float
/// picture, .exr or .tif, lit from three sides), the residual of each step for any other picture.
std::vector<EvaluationRun> evaluate_height(const EvaluationInput& input);

/// 64, 128, … and the side itself, at most 4096.
std::vector<int> rising_sides(int shorter_side);

/// All kinds, in the order of the help.
std::span<const EvaluationKind> evaluation_kinds();

/// runs[] {method, solver, input, error_name, trace[] {seconds, error}, stop, notes}.
Json runs_json(const std::vector<EvaluationRun>& runs);

/// method,solver,input,error_name,seconds,error: a line a sample, fields quoted as RFC 4180 has it.
std::string runs_csv(const std::vector<EvaluationRun>& runs);

/// A picture of runs that have an input and an error in common.
struct EvaluationPicture {
  std::string title, svg;
  std::vector<std::string> front;  ///< Methods on the Pareto front of error and run time.
};

std::vector<EvaluationPicture> runs_pictures(const std::vector<EvaluationRun>& runs);

/// One page that needs no other file: all pictures and a table of the runs.
std::string runs_html(const std::string& kind, const std::vector<EvaluationPicture>& pictures,
                      const std::vector<EvaluationRun>& runs);

/// The largest parts of a scene, most triangles first: what is evaluated when a file has many.
std::vector<std::uint32_t> largest_parts(const Scene& scene, std::size_t most);

}  // namespace papilla::app
