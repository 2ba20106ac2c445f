// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "evaluate/budget.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/evaluate/evaluation.hpp"

namespace papilla {

struct EvaluationInput {
  std::string file;
  std::string name;  ///< What reports call the file.
  ReadOptions read;
  ProgressCallback progress;
  Budget budget = {};
  ParamComparison param = {};
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

/// All ways to map the same charts: error for a ladder of iterations, the methods' own traces, and EvaluatedMap.
/// @throws InvalidInput where there are no such charts.
std::vector<EvaluationRun> evaluate_param(const EvaluationInput& input);

/// environment_uv() over the resolution: the mesh and simplified ones of it, down to 1/64 of the triangles. The map is
/// computed at vertices and interpolated between them. The error is the mean over the area of the distance in uv
/// between the interpolated value in the middle of a triangle and that of the triangle's own normal; it falls with the
/// length of the edges where the surface is smooth.
EvaluationRun environment_run(const TriangleMesh& mesh, EnvironmentMap map, const std::string& map_name,
                              const std::string& input, const Budget& budget);

/// All estimators of the fractal dimension on growing middle parts of a picture: the interval's half width.
std::vector<EvaluationRun> evaluate_fractal(const EvaluationInput& input);

/// Both lattice methods and both feature matrices on growing middle parts of a picture: the unexplained variance.
std::vector<EvaluationRun> evaluate_symmetry(const EvaluationInput& input);

/// All methods from a picture to heights: the depth error over growing numbers of steps, or over growing middle parts
/// for methods without steps, for a relief in millimetres (a float picture, .exr or .tif, lit from three sides); the
/// residual of each step of shape from shading for any other picture.
std::vector<EvaluationRun> evaluate_height(const EvaluationInput& input);

/// Contact with a glTF file with haptic tags: the forces of a stroke at growing rates, against the same stroke at the
/// highest one; the time is that of all ticks of a second. Then wall_runs() of its largest material.
std::vector<EvaluationRun> evaluate_contact(const EvaluationInput& input);

/// A wall with this damping on every simulated device, at 1 kHz:
/// - `stability-limit`: bisection for the softest wall that is unstable, by pressing against it; the error is the
///   relative excess of the stiffness reached over that of the closed form, stiffness_limit().
/// - `passivity`: the energy in joules given to the hand over time by a wall of eight times that stiffness: as asked,
///   with the passivity controller, and clamped to the limit.
/// @param damping of the wall as asked for, N·s/m; devices that can't hold any wall with it are named.
std::vector<EvaluationRun> wall_runs(const EvaluationInput& input, double damping);

/// What a method is expected to take more on a picture of twice the side.
inline constexpr double k_growth_by_side = 4.5;

/// 64, 128, … and the side itself, at most 4096.
std::vector<int> rising_sides(int shorter_side);

/// The largest parts of a scene, most triangles first.
std::vector<std::uint32_t> largest_parts(const Scene& scene, std::size_t most);

/// What reports call a part: "file: part", or the file alone when the part has the same name.
std::string input_name(const EvaluationInput& input, const std::string& part);

/// Runs a kind once, then again as long as the budget has time for it, at most `repeats` times.
std::vector<EvaluationRun> run_repeatedly(const EvaluationKind& kind, const EvaluationInput& input, int repeats);

/// Writes the built-in inputs of a kind into a folder: disks of growing curvature for the kinds that take meshes,
/// fractal surfaces for `fractal`, lattices under noise for `symmetry`, reliefs for `height`, solids of known area for
/// `tessellation`, a baked dome with leather on it for `contact`.
/// @returns the files. @throws IoError when they can't be written.
std::vector<std::string> write_built_in_inputs(std::string_view kind, const std::filesystem::path& folder);

}  // namespace papilla
