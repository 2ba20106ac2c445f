// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "evaluate/kinds.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/measure.hpp"

namespace papilla {
namespace {

constexpr std::size_t k_most_parts = 3;
constexpr double k_growth = 2;

/// From seams only where the distortion is large to seams wherever they reduce it at all.
constexpr std::array k_seam_costs = {1.0, 0.3, 0.1, 0.03, 0.01, 0.003};

double area_of(const TriangleMesh& mesh) {
  double doubled = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    doubled += norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  return doubled / 2;
}

/// Two curves over the ladder: distortion of the map by flatten_automatic(), and length of the seams.
void add_runs(const std::string& name, const TriangleMesh& mesh, const Budget& budget,
              std::vector<EvaluationRun>& runs) {
  const double root_area = std::sqrt(area_of(mesh));
  if (!(root_area > 0)) return;
  EvaluationRun distortion{"charts", "seam costs", name, "symmetric Dirichlet - 4 of the charts' map", {}, "direct"};
  EvaluationRun seams = distortion;
  seams.error_name = "length of the seams / root of the area";
  Ladder ladder(budget, k_growth);
  for (const double cost : k_seam_costs) {
    if (!ladder.next()) break;
    SegmentationOptions options;
    options.seam_cost = cost;
    const Stopwatch clock;
    const SegmentationResult result = segment_charts(mesh, options);
    const double seconds = clock.seconds();
    const DistortionReport report = measure_distortion(mesh, flatten_automatic(mesh, result.charts).flattening.uv);
    distortion.trace.push_back({seconds, report.symmetric_dirichlet.mean - 4});
    seams.trace.push_back({seconds, seam_length(mesh, result.charts) / root_area});
    distortion.notes += fmt::format("cost {:g}: {} charts; ", cost, result.charts.count);
  }
  seams.notes = distortion.notes;
  if (distortion.trace.empty()) distortion.stop = seams.stop = k_time_spent;
  runs.push_back(std::move(distortion));
  runs.push_back(std::move(seams));
}

}  // namespace

std::vector<EvaluationRun> evaluate_charts(const EvaluationInput& input) {
  const Scene scene = read_scene(input.file, input.read, input.progress);
  const std::vector<std::uint32_t> largest = largest_parts(scene, k_most_parts);
  std::vector<EvaluationRun> runs;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    report_progress(input.progress, "charts", static_cast<double>(i) / static_cast<double>(largest.size()));
    const Part& part = scene.parts[largest[i]];
    add_runs(input_name(input, part.name), weld_equal(part.mesh).mesh, input.budget.share(largest.size() - i), runs);
  }
  return runs;
}

}  // namespace papilla
