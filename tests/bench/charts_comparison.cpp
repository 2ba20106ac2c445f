// SPDX-License-Identifier: MIT
#include "bench/charts_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "bench/cgal_segmentation.hpp"
#include "bench/model_files.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/submesh.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/measure.hpp"
#include "support/formula_meshes.hpp"
#include "support/solid_meshes.hpp"

namespace papilla::bench {
namespace {

/// Far more than a chart needs: a chart that is not down at the distortion asked for is not compared with.
constexpr int k_max_halvings = 1000;
/// The peers start from several levels of diameter; the best result counts.
constexpr std::size_t k_clusters[] = {2, 5};

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

/// A flattened piece.
struct Mapped {
  std::uint32_t charts = 1;
  double mean = 4, area = 0;
};

Mapped measured(const TriangleMesh& mesh, const Flattening& flattening) {
  const DistortionReport report = measure_distortion(mesh, flattening.uv);
  return {flattening.charts.count, report.measured_triangles > 0 ? report.symmetric_dirichlet.mean : 4,
          report.area_mm2};
}

/// Of the map with the lowest energy; nothing when that is far above `most` or no map is valid.
std::optional<Mapped> map_of(const TriangleMesh& mesh, const ChartSet& one, double most) {
  BestOptions options;
  options.energy_limit = 4 + 2 * (most - 4);
  options.fall_back = false;
  try {
    return measured(mesh, flatten_best(mesh, one, options));
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Flattens chart by chart; halves those that have no valid map or a mean distortion above `worst`.
Quality flatten(const TriangleMesh& mesh, const ChartSet& charts, double worst) {
  Quality quality;
  double seam = charts.seam_length_mm, area = 0, integral = 0;
  std::vector<Piece> pending = pieces_of(mesh, charts, 0);
  while (!pending.empty()) {
    const Piece piece = std::move(pending.back());
    pending.pop_back();
    const ChartSet one = test::one_chart(piece.mesh);
    const bool last = piece.mesh.triangles.size() == 1 || piece.halvings == k_max_halvings;
    const double most = last ? std::numeric_limits<double>::infinity() : worst * (1 + 1e-9);
    const std::optional<Mapped> mapped =
        last ? measured(piece.mesh, flatten_best(piece.mesh, one)) : map_of(piece.mesh, one, most);
    if (!mapped || mapped->mean > most) {
      const ChartSet halves = ChartHalver(piece.mesh).halve(one, std::vector<std::uint32_t>{0});
      seam += halves.seam_length_mm;
      ++quality.halvings;
      for (Piece& half : pieces_of(piece.mesh, halves, piece.halvings + 1)) pending.push_back(std::move(half));
      continue;
    }
    quality.charts += mapped->charts;
    quality.worst_chart = std::max(quality.worst_chart, mapped->mean);
    area += mapped->area;
    integral += mapped->area * mapped->mean;
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

void record(const Quality& quality, Recorder& recorder) {
  recorder.record("charts", quality.charts);
  recorder.record("seam_over_root_area", quality.seam_over_root_area);
  recorder.record("symmetric_dirichlet_mean", quality.mean);
  recorder.record("worst_chart_mean", quality.worst_chart);
  recorder.record("halvings", quality.halvings);
}

/// What one input came to; the quality is the same in every repeat and found once.
struct Comparison {
  Input input;
  std::vector<std::vector<std::uint32_t>> segments = cgal_segments(input.mesh, k_clusters);
  std::optional<Quality> ours = {}, cgal = {}, feature = {};
  double worst() { return own().worst_chart; }
  const Quality& own() {
    const SegmentationOptions options = our_options();
    if (!ours) ours = flatten(input.mesh, segment_charts(input.mesh, options).charts, 4 + worth_halving(options));
    return *ours;
  }
};

/// The segments with the fewest charts at our distortion.
Quality best_of_cgal(Comparison& comparison) {
  std::optional<Quality> best;
  for (const auto& labels : comparison.segments) {
    const ChartSet charts = open_charts(comparison.input.mesh, as_charts(labels), false);
    const Quality quality = flatten(comparison.input.mesh, charts, comparison.worst());
    if (!best || quality.charts < best->charts) best = quality;
  }
  return *best;
}

void add_comparison(Comparison& c, BenchReport& report) {
  const std::string error = "mean symmetric Dirichlet of the worst chart";
  report.add({.method = "segment_charts", .input = c.input.name, .error_name = error}, [&](Recorder& recorder) {
    recorder.time([&] { keep(segment_charts(c.input.mesh, our_options()).charts.count); });
    record(c.own(), recorder);
  });
  report.add({.method = "feature_45", .input = c.input.name, .error_name = error}, [&](Recorder& recorder) {
    recorder.time([&] { keep(feature_split(c.input.mesh).count); });
    if (!c.feature) c.feature = flatten(c.input.mesh, feature_split(c.input.mesh), c.worst());
    record(*c.feature, recorder);
  });
  if (c.segments.empty()) return;  // CGAL can't hold it
  report.add({.method = "cgal_sdf", .input = c.input.name, .error_name = error}, [&](Recorder& recorder) {
    recorder.time([&] { keep(cgal_segments(c.input.mesh, std::span(k_clusters).last(1)).size()); });
    if (!c.cgal) c.cgal = best_of_cgal(c);
    record(*c.cgal, recorder);
  });
}

/// Time per triangle and count of charts over the tessellation of one shape.
void add_scaling(const std::string& shape, const TriangleMesh& mesh, BenchReport& report) {
  report.add({.method = "scaling", .input = shape}, [&mesh](Recorder& recorder) {
    SegmentationResult result;
    const double before = process_cpu_seconds();
    recorder.time([&] { result = segment_charts(mesh, our_options()); });
    recorder.record("cpu_us_per_triangle",
                    1e6 * (process_cpu_seconds() - before) / static_cast<double>(mesh.triangles.size()));
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

/// Meshes that charts are worth comparing on, and that CGAL's segmentation gets through.
bool is_input(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::uintmax_t k_least = 50'000, k_most = 4'000'000;
  const std::uintmax_t size = std::filesystem::file_size(file);
  return (extension == ".stl" || extension == ".obj" || extension == ".off") && size >= k_least && size <= k_most;
}

std::vector<Input> inputs(const BenchOptions& options) {
  std::vector<Input> all;
  all.push_back({"capped cylinder 64", test::capped_cylinder_mesh(64)});
  if (options.quick) return all;
  all.push_back({"panel 118 x 42", test::panel_mesh(118, 42)});
  all.push_back({"torus 200 x 50", test::torus_mesh(200, 50)});
  all.push_back({"handle 32 x 160", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"hemisphere 50 x 101", test::hemisphere_mesh(50, 101)});
  for (const std::filesystem::path& file : model_files(options.inputs))
    if (is_input(file)) all.push_back(read(file));
  return all;
}

std::vector<Input> sizes(const BenchOptions& options) {
  std::vector<Input> all;
  all.push_back({"panel 118 x 42", test::panel_mesh(118, 42)});
  if (options.quick) return all;
  all.push_back({"panel 374 x 134", test::panel_mesh(374, 134)});
  all.push_back({"panel 1183 x 423", test::panel_mesh(1183, 423)});
  all.push_back({"handle 32 x 160", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"handle 100 x 500", test::grid_mesh(100, 500, test::grab_handle, 0.15)});
  return all;
}

}  // namespace

struct ChartsComparison::State {
  std::vector<std::unique_ptr<Comparison>> comparisons;
  std::vector<Input> scaling;
};

ChartsComparison::ChartsComparison(BenchReport& report) : state_(std::make_unique<State>()) {
  for (Input& input : inputs(report.options())) {
    state_->comparisons.push_back(std::make_unique<Comparison>(Comparison{std::move(input)}));
    add_comparison(*state_->comparisons.back(), report);
  }
  state_->scaling = sizes(report.options());
  for (const Input& input : state_->scaling) add_scaling(input.name, input.mesh, report);
  for (const char* peer : {"feature_45", "cgal_sdf"})
    for (const char* quantity : {"charts", "seam_over_root_area"}) report.compare("segment_charts", peer, quantity);
}

ChartsComparison::~ChartsComparison() = default;

void ChartsComparison::report(BenchReport& report) const {
  EvidenceTable table{
      "Charts",
      "At equal maximal distortion: the peers' charts are halved until none has a larger mean symmetric "
      "Dirichlet energy than the worst of segment_charts(). Number of charts, and seam length over the "
      "root of the area. A dash: CGAL can't hold the mesh.",
      {"input", "triangles", "worst chart", "ours", "45° split", "CGAL segmentation"},
      {}};
  std::size_t against_split = 0, against_cgal = 0, held_by_cgal = 0;
  const auto better = [](const Quality& own, const Quality& peer) {
    constexpr double k_rounding = 1 + 1e-9;
    return own.charts <= peer.charts && own.seam_over_root_area <= peer.seam_over_root_area * k_rounding;
  };
  const auto text = [](const std::optional<Quality>& q) {
    return q ? fmt::format("{:.0f}, {:.2f}", q->charts, q->seam_over_root_area) : std::string("-");
  };
  for (const auto& c : state_->comparisons) {
    against_split += better(*c->ours, *c->feature) ? 1u : 0u;
    held_by_cgal += c->cgal ? 1u : 0u;
    against_cgal += c->cgal && better(*c->ours, *c->cgal) ? 1u : 0u;
    table.rows.push_back({c->input.name, std::to_string(c->input.mesh.triangles.size()),
                          fmt::format("{:.4f}", c->ours->worst_chart), text(c->ours), text(c->feature), text(c->cgal)});
  }
  report.table(std::move(table));
  const auto target = [&](const char* peer, std::size_t count, std::size_t of) {
    report.target({fmt::format("charts: no more of them and no longer seams than {} at equal maximal distortion", peer),
                   fmt::format("{} of {} inputs", count, of),
                   report.options().quick ? std::nullopt : std::optional(count == of)});
  };
  target("a split at 45°", against_split, state_->comparisons.size());
  target("CGAL's segmentation", against_cgal, held_by_cgal);
}

}  // namespace papilla::bench
