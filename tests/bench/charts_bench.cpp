// SPDX-License-Identifier: MIT
// Charts of segment_charts() against CGAL's segmentation and a split at edges of 45 degrees, at equal maximal
// distortion: all are opened by the same rule, flattened by the same method, and halved where a chart has no valid map;
// the peers' charts are halved further until none is more distorted than the worst of segment_charts().
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "bench/bench_json.hpp"
#include "bench/cgal_segmentation.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/submesh.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/measure.hpp"
#include "support/formula_meshes.hpp"
#include "support/solid_meshes.hpp"

namespace {

using namespace papilla;

constexpr int k_max_halvings = 24;
/// The peers start from several levels of diameter; the best result counts.
constexpr std::size_t k_clusters[] = {2, 3, 5, 8};

struct Input {
  std::string name;
  TriangleMesh mesh;
};

/// Charts and what they cost when flattened.
struct Quality {
  double charts = 0, seam_over_root_area = 0, mean = 0, worst_chart = 4, halvings = 0;
};

/// One chart as a mesh of its own.
struct Piece {
  TriangleMesh mesh;
  int halvings = 0;
};

std::vector<Piece> pieces_of(const TriangleMesh& mesh, const ChartSet& charts, int halvings) {
  const TriangleMesh open = cut_open(mesh, charts);
  std::vector<Piece> pieces;
  for (const auto& triangles : triangles_of_charts(charts)) {
    Submesh submesh = extract(open, triangles);
    Piece& piece = pieces.emplace_back();
    piece.mesh.positions = std::move(submesh.positions);
    piece.mesh.triangles = std::move(submesh.triangles);
    piece.halvings = halvings;
  }
  return pieces;
}

/// Flattens chart by chart; halves those that have no valid map or a mean distortion above `worst`.
Quality flatten(const TriangleMesh& mesh, const ChartSet& charts, double worst) {
  Quality quality;
  double seam = charts.seam_length_mm, area = 0, integral = 0;
  std::vector<Piece> pending = pieces_of(mesh, charts, 0);
  while (!pending.empty()) {
    const Piece piece = std::move(pending.back());
    pending.pop_back();
    LscmOptions options;
    options.solver = LscmSolver::hermitian;
    const ChartSet one = test::one_chart(piece.mesh);
    const Flattening flattening = flatten_lscm(piece.mesh, one, options);
    const DistortionReport report = measure_distortion(piece.mesh, flattening.uv);
    const double mean = report.measured_triangles > 0 ? report.symmetric_dirichlet.mean : 4;
    const bool good = flattening.notes.empty() && mean <= worst * (1 + 1e-9);
    if (!good && piece.mesh.triangles.size() > 1 && piece.halvings < k_max_halvings) {
      const ChartSet halves = halve_charts(piece.mesh, one, std::vector<std::uint32_t>{0});
      seam += halves.seam_length_mm;
      ++quality.halvings;
      for (Piece& half : pieces_of(piece.mesh, halves, piece.halvings + 1)) pending.push_back(std::move(half));
      continue;
    }
    quality.charts += flattening.charts.count;
    quality.worst_chart = std::max(quality.worst_chart, mean);
    area += report.area_mm2;
    integral += report.area_mm2 * mean;
  }
  quality.mean = integral / area;
  quality.seam_over_root_area = seam / std::sqrt(area);
  return quality;
}

SegmentationOptions our_options() {
  SegmentationOptions options;
  options.disks = false;
  return options;
}

/// Pieces between edges of more than 45 degrees.
ChartSet feature_split(const TriangleMesh& mesh) {
  SegmentationOptions options;
  options.seam_cost = 1e6;  // no relief cuts
  options.unfold = false;
  options.disks = false;
  return segment_charts(mesh, options).charts;
}

ChartSet as_charts(const std::vector<std::uint32_t>& labels) {
  ChartSet charts;
  charts.of_triangle = labels;
  for (const std::uint32_t label : labels) charts.count = std::max(charts.count, label + 1);
  return charts;
}

void record(const Quality& quality, bench::Recorder& recorder) {
  recorder.record("charts", quality.charts);
  recorder.record("seam_over_root_area", quality.seam_over_root_area);
  recorder.record("symmetric_dirichlet_mean", quality.mean);
  recorder.record("worst_chart_mean", quality.worst_chart);
  recorder.record("halvings", quality.halvings);
}

/// What one input came to; the quality is the same in every repeat and found once.
struct Comparison {
  Input input;
  std::optional<Quality> ours, cgal, feature;
  double worst() { return own().worst_chart; }
  const Quality& own() {
    if (!ours) ours = flatten(input.mesh, segment_charts(input.mesh, our_options()).charts, 1e300);
    return *ours;
  }
};

/// The segments with the fewest charts at our distortion.
Quality best_of_cgal(Comparison& comparison) {
  std::optional<Quality> best;
  for (const std::size_t clusters : k_clusters) {
    const auto labels = bench::cgal_segments(comparison.input.mesh, clusters);
    const ChartSet charts = open_charts(comparison.input.mesh, as_charts(labels), false);
    const Quality quality = flatten(comparison.input.mesh, charts, comparison.worst());
    if (!best || quality.charts < best->charts) best = quality;
  }
  return *best;
}

void add_comparison(Comparison& c, bench::BenchReport& report) {
  const std::string error = "mean symmetric Dirichlet of the worst chart";
  report.add({.method = "segment_charts", .input = c.input.name, .error_name = error}, [&](bench::Recorder& recorder) {
    recorder.time([&] { bench::keep(segment_charts(c.input.mesh, our_options()).charts.count); });
    record(c.own(), recorder);
  });
  report.add({.method = "feature_45", .input = c.input.name, .error_name = error}, [&](bench::Recorder& recorder) {
    recorder.time([&] { bench::keep(feature_split(c.input.mesh).count); });
    if (!c.feature) c.feature = flatten(c.input.mesh, feature_split(c.input.mesh), c.worst());
    record(*c.feature, recorder);
  });
  if (bench::cgal_segments(c.input.mesh, k_clusters[0]).empty()) return;  // CGAL can't hold it
  report.add({.method = "cgal_sdf", .input = c.input.name, .error_name = error}, [&](bench::Recorder& recorder) {
    recorder.time([&] { bench::keep(bench::cgal_segments(c.input.mesh, k_clusters[2]).size()); });
    if (!c.cgal) c.cgal = best_of_cgal(c);
    record(*c.cgal, recorder);
  });
}

/// Time per triangle and count of charts over the tessellation of one shape.
void add_scaling(const std::string& shape, const TriangleMesh& mesh, bench::BenchReport& report) {
  report.add({.method = "scaling", .input = shape}, [&mesh](bench::Recorder& recorder) {
    SegmentationResult result;
    const double before = bench::process_cpu_seconds();
    recorder.time([&] { result = segment_charts(mesh, our_options()); });
    recorder.record("cpu_us_per_triangle",
                    1e6 * (bench::process_cpu_seconds() - before) / static_cast<double>(mesh.triangles.size()));
    recorder.record("charts", result.charts.count);
  });
}

/// The largest part of a file, repaired.
Input read(const std::filesystem::path& file) {
  Scene scene = read_scene(file.string(), {});
  const auto largest = std::max_element(scene.parts.begin(), scene.parts.end(), [](const Part& a, const Part& b) {
    return a.mesh.triangles.size() < b.mesh.triangles.size();
  });
  return {file.filename().string(), repair(std::move(largest->mesh), {}).mesh};
}

std::vector<Input> inputs(const bench::BenchOptions& options) {
  std::vector<Input> all;
  if (!options.inputs.empty()) {
    for (const std::string& file : options.inputs) all.push_back(read(file));
    return all;
  }
  all.push_back({"capped cylinder 64", test::capped_cylinder_mesh(64)});
  if (options.quick) return all;
  all.push_back({"panel 118 x 42", test::panel_mesh(118, 42)});
  all.push_back({"torus 200 x 50", test::torus_mesh(200, 50)});
  all.push_back({"handle 32 x 160", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"hemisphere 50 x 101", test::hemisphere_mesh(50, 101)});
  const char* shared = std::getenv("PAPILLA_SHARED_DATA");
  if (shared == nullptr) return all;
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"mesh/cad-stl", "param"})
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(shared) / folder))
      if (entry.is_regular_file() && entry.file_size() > 50'000) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) all.push_back(read(file));
  return all;
}

std::vector<Input> sizes(const bench::BenchOptions& options) {
  std::vector<Input> all;
  if (!options.inputs.empty()) return all;
  all.push_back({"panel 118 x 42", test::panel_mesh(118, 42)});
  if (options.quick) return all;
  all.push_back({"panel 374 x 134", test::panel_mesh(374, 134)});
  all.push_back({"panel 1183 x 423", test::panel_mesh(1183, 423)});
  all.push_back({"handle 32 x 160", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"handle 100 x 500", test::grid_mesh(100, 500, test::grab_handle, 0.15)});
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  return bench::run_benchmark("charts", "Charts: number, seams, speed", argc, argv, [](bench::BenchReport& report) {
    std::vector<std::unique_ptr<Comparison>> comparisons;
    for (Input& input : inputs(report.options()))
      add_comparison(*comparisons.emplace_back(std::make_unique<Comparison>(Comparison{std::move(input), {}, {}, {}})),
                     report);
    const std::vector<Input> scaling = sizes(report.options());
    for (const Input& input : scaling) add_scaling(input.name, input.mesh, report);
    for (const char* peer : {"feature_45", "cgal_sdf"})
      for (const char* quantity : {"charts", "seam_over_root_area", "cpu_seconds"})
        report.compare("segment_charts", peer, quantity);
    report.measure();
  });
}
