// SPDX-License-Identifier: MIT
// Maps of charts: speed, distortion, validity. Peers: CGAL's maps in the same program, and, when PAPILLA_PARAM_PEER
// names a program for them, libigl's and xatlas's (see param_peer.hpp). Files on the command line are unwrapped, too.
#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>

#include "bench/param_targets.hpp"
#include "papilla/param/projections.hpp"
#include "papilla/param/triplanar.hpp"
#include "support/formula_meshes.hpp"

namespace {

using namespace papilla;
using namespace papilla::bench;

std::vector<Disk> disks(bool quick) {
  std::vector<Disk> all;
  if (quick) {
    all.push_back({"dash 10k", test::dashboard_mesh(20, 8)});
    return all;
  }
  all.push_back({"dash 10k", test::dashboard_mesh(118, 42)});
  all.push_back({"hemi 10k", test::hemisphere_mesh(50, 101)});
  all.push_back({"cyl 10k", test::grid_mesh(100, 50, test::open_cylinder, 0.15)});
  all.push_back({"needle 20k", needle_panel(1)});
  all.push_back({"handle 10k", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"dash 100k", test::dashboard_mesh(374, 134), Disk::large});
  all.push_back({"handle 100k", test::grid_mesh(100, 500, test::grab_handle, 0.15), Disk::large});
  all.push_back({"dash 1M", test::dashboard_mesh(1183, 423), Disk::huge});
  return all;
}

/// What the referee says, outside of the time.
void record_distortion(const TriangleMesh& mesh, const Flattening& flattening, Recorder& recorder) {
  const DistortionReport report = measure_distortion(mesh, flattening.uv);
  recorder.record("charts", flattening.charts.count);
  recorder.record("symmetric_dirichlet_mean", report.symmetric_dirichlet.mean);
  recorder.record("maillot_length", report.maillot_length);
  recorder.record("flipped", static_cast<double>(report.flipped));
  recorder.record("degenerate_uv", static_cast<double>(report.degenerate_uv));
  recorder.record("overlap_within_charts", report.overlap_within_charts);
  recorder.record("fell_back", static_cast<double>(flattening.notes.size()));
  recorder.trace(flattening.trace);
  recorder.stop(flattening.stop);
}

void add_method(const Disk& disk, const std::string& method, const std::string& solver, const std::string& error,
                MapMethod map, BenchReport& report) {
  report.add({.method = method, .solver = solver, .input = disk.name, .error_name = error},
             [&disk, map = std::move(map)](Recorder& recorder) {
               Flattening result;
               if (disk.size != Disk::small) ::malloc_trim(0);  // what others freed would hide what this one takes
               reset_peak_rss();
               const double before = peak_rss_mib();
               recorder.time([&] { result = map(disk.mesh); });
               recorder.record("added_mib", peak_rss_mib() - before);
               record_distortion(disk.mesh, result, recorder);
             });
}

void add_triplanar(const Disk& disk, BenchReport& report) {
  report.add({.method = "triplanar", .input = disk.name, .error_name = "lone triangles"}, [&disk](Recorder& recorder) {
    TriplanarResult result;
    recorder.time([&] { result = flatten_triplanar(disk.mesh); });
    const double millions = 1e-6 * static_cast<double>(disk.mesh.triangles.size());
    recorder.record("mtri_per_second", millions / result.seconds.total);
    recorder.record("project_mtri_per_second", millions / result.seconds.project);
    recorder.record("border_jump_mean_mm", result.border_jump.mean_mm);
    std::vector<std::size_t> faces(result.flattening.charts.count, 0);
    for (const std::uint32_t c : result.flattening.charts.of_triangle) ++faces[c];
    recorder.record("charts_of_one_face", static_cast<double>(std::count(faces.begin(), faces.end(), 1)));
    record_distortion(disk.mesh, result.flattening, recorder);
  });
}

/// The sources' own functionals, starts and steps: rows that small disks have.
struct WrittenRow {
  const char *method, *solver, *error;
  MapMethod map;
};

const std::vector<WrittenRow>& written_rows() {
  static const auto levy_row = [](const char* solver, LevyBorder border, LevySolver by) {
    return WrittenRow{"levy", solver, "sum of Lévy's conditions [mm²]",
                      [border, by](const TriangleMesh& m) { return levy_written(m, border, by); }};
  };
  static const auto maillot_row = [](const char* solver, MaillotStart start) {
    return WrittenRow{"maillot", solver, "Maillot's energy [mm²]",
                      [start](const TriangleMesh& m) { return maillot_written(m, start); }};
  };
  static const std::vector<WrittenRow> rows{
      levy_row("direct, as written", LevyBorder::convex, LevySolver::direct),
      levy_row("gauss-seidel, as written", LevyBorder::convex, LevySolver::gauss_seidel),
      levy_row("direct, as written, border released", LevyBorder::released, LevySolver::direct),
      levy_row("gauss-seidel, as written, border released", LevyBorder::released, LevySolver::gauss_seidel),
      maillot_row("as written from conformal", MaillotStart::conformal),
      maillot_row("as written from planar", MaillotStart::planar)};
  return rows;
}

void add_speed(const std::vector<Disk>& all, BenchReport& report) {
  for (const Disk& disk : all) {
    add_triplanar(disk, report);
    add_method(disk, "lscm", "hermitian", "mean of (σ1 - σ2)²", lscm_hermitian, report);
    add_method(disk, "levy", "direct", "sum of Lévy's conditions [mm²]", levy_conformal, report);
    add_method(disk, "levy", "direct, lengths", "sum of Lévy's conditions [mm²]", levy, report);
    add_method(disk, "best", "", "mean symmetric Dirichlet energy", best, report);
    if (disk.size == Disk::huge) continue;
    add_method(disk, "maillot", "gauss-newton", "Maillot's energy [mm²]", maillot, report);
    add_method(
        disk, "lscm", "cgal", "mean of (σ1 - σ2)²",
        [](const TriangleMesh& m) { return lscm_with(m, LscmSolver::cgal); }, report);
    if (disk.size == Disk::large || disk.name.starts_with("needle")) continue;
    for (const WrittenRow& row : written_rows()) add_method(disk, row.method, row.solver, row.error, row.map, report);
    add_method(disk, "arap", "cgal", "mean symmetric Dirichlet energy", arap, report);
  }
  report.compare("lscm/hermitian", "lscm/cgal", "cpu_seconds");
  report.compare("levy/direct", "lscm/cgal", "cpu_seconds");
  report.compare("levy/direct, lengths", "lscm/cgal", "cpu_seconds");
  report.compare("best", "arap/cgal", "cpu_seconds");
  report.compare("maillot/gauss-newton", "arap/cgal", "cpu_seconds");
}

void report_methods(const std::vector<Disk>& all, const Medians& of, BenchReport& report) {
  EvidenceTable table{"Methods on one chart",
                      "Medians over the repeats; CPU of the whole process.",
                      {"disk", "method", "CPU s", "symmetric Dirichlet", "Maillot", "flipped / degenerate / fell back"},
                      {}};
  std::vector<std::string> subjects{"triplanar",
                                    "lscm/cgal",
                                    "lscm/hermitian",
                                    "levy/direct",
                                    "levy/direct, lengths",
                                    "arap/cgal",
                                    "maillot/gauss-newton",
                                    "best"};
  for (const WrittenRow& row : written_rows()) subjects.push_back(std::string(row.method) + "/" + row.solver);
  for (const Disk& disk : all)
    for (const std::string& subject : subjects) {
      if (disk.size == Disk::huge && (subject.ends_with("cgal") || subject.starts_with("maillot"))) continue;
      const bool is_slow = subject == "arap/cgal" || subject.find("as written") != std::string::npos;
      if (is_slow && (disk.size != Disk::small || disk.name.starts_with("needle"))) continue;
      table.rows.push_back({disk.name, subject, fmt::format("{:.4f}", of.cpu(subject, disk.name)),
                            fmt::format("{:.5f}", of.energy(subject, disk.name)),
                            fmt::format("{:.4g}", of(subject, disk.name, "maillot_length")),
                            fmt::format("{} / {} / {}", of(subject, disk.name, "flipped"),
                                        of(subject, disk.name, "degenerate_uv"), of(subject, disk.name, "fell_back"))});
    }
  report.table(std::move(table));
}

void body(BenchReport& report) {
  const Stopwatch clock;
  const auto step = [&](const char* name) { fmt::print(stderr, "[{:4.0f} s] {}\n", clock.seconds(), name); };
  const std::vector<Disk> all = disks(report.options().quick);
  step("methods on one chart");
  add_speed(all, report);
  add_factorizations(all, report);
  report.measure();
  step("H: bad input");
  report_bad_input(report);
  if (report.options().quick) return;
  const Medians of{report};
  Peers peers;
  step("A: linear maps");
  report_linear(all, peers, of, report);
  step("B: Maillot's energy");
  report_maillot(all, peers, of, report);
  step("C: least distortion");
  report_best(all, peers, of, report);
  step("D: curved and branched disks");
  report_curved(peers, report);
  step("E: extremes");
  report_extremes(mesh_of(all, "dash 10k"), report);
  step("F: whole parts");
  report_parts(all, report);
  step("G: triplanar");
  report_triplanar(all, of, report);
  step("H: the same bytes");
  report_same(all, report);
  report_methods(all, of, report);
  step("done");
}

}  // namespace

int main(int argc, char** argv) {
  return papilla::bench::run_benchmark("param", "Maps of charts: speed, distortion, validity", argc, argv, body);
}
