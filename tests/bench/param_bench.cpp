// SPDX-License-Identifier: MIT
#include "bench/bench_json.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/triplanar.hpp"
#include "support/formula_meshes.hpp"

namespace {

using namespace papilla;

/// A mesh that outlives the measurement.
struct Input {
  std::string name;
  TriangleMesh mesh;
  bool solve = true;  ///< Small enough for the linear solvers.
};

std::vector<Input> inputs(bool quick) {
  std::vector<Input> all;
  all.push_back({"dashboard 118 x 42", test::dashboard_mesh(118, 42)});
  if (quick) return all;
  all.push_back({"handle 32 x 160", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"dashboard 374 x 134", test::dashboard_mesh(374, 134)});
  all.push_back({"handle 100 x 500", test::grid_mesh(100, 500, test::grab_handle, 0.15)});
  all.push_back({"dashboard 1183 x 423", test::dashboard_mesh(1183, 423), false});
  return all;
}

/// What the referee says, outside of the time.
void record_distortion(const TriangleMesh& mesh, const Flattening& flattening, bench::Recorder& recorder) {
  const DistortionReport report = measure_distortion(mesh, flattening.uv);
  recorder.record("charts", flattening.charts.count);
  recorder.record("symmetric_dirichlet_mean", report.symmetric_dirichlet.mean);
  recorder.record("maillot_length", report.maillot_length);
  recorder.record("flipped", static_cast<double>(report.flipped));
  recorder.record("overlap_within_charts", report.overlap_within_charts);
  recorder.trace(flattening.trace);
  recorder.stop(flattening.stop);
}

void add_triplanar(const Input& input, bench::BenchReport& report) {
  report.add({.method = "triplanar", .input = input.name, .error_name = "lone triangles"},
             [&](bench::Recorder& recorder) {
               TriplanarResult result;
               recorder.time([&] { result = flatten_triplanar(input.mesh); });
               const double millions = 1e-6 * static_cast<double>(input.mesh.triangles.size());
               recorder.record("mtri_per_second", millions / result.seconds.total);
               recorder.record("project_mtri_per_second", millions / result.seconds.project);
               recorder.record("border_jump_mean_mm", result.border_jump.mean_mm);
               record_distortion(input.mesh, result.flattening, recorder);
             });
}

void add_lscm(const Input& input, LscmSolver solver, const char* name, bench::BenchReport& report) {
  report.add({.method = "lscm", .solver = name, .input = input.name, .error_name = "mean of (sigma1 - sigma2)^2"},
             [&input, solver](bench::Recorder& recorder) {
               LscmOptions options;
               options.solver = solver;
               const ChartSet charts = test::one_chart(input.mesh);
               Flattening result;
               recorder.time([&] { result = flatten_lscm(input.mesh, charts, options); });
               record_distortion(input.mesh, result, recorder);
             });
}

}  // namespace

int main(int argc, char** argv) {
  return bench::run_benchmark("param", "Flattening: speed and distortion", argc, argv, [](bench::BenchReport& report) {
    const std::vector<Input> all = inputs(report.options().quick);
    for (const Input& input : all) {
      add_triplanar(input, report);
      if (!input.solve) continue;
      add_lscm(input, LscmSolver::cgal, "cgal", report);
      add_lscm(input, LscmSolver::hermitian, "hermitian", report);
    }
    report.compare("lscm/hermitian", "lscm/cgal", "cpu_seconds");
    report.measure();
  });
}
