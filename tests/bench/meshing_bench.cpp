// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <memory>

#include "bench/bench_json.hpp"
#include "bench/charts_comparison.hpp"
#include "bench/model_files.hpp"
#include "bench/simplify_comparison.hpp"
#include "bench/whole_process.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/temporary_folder.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/boundary_cycles.hpp"
#include "papilla/meshing/deviation.hpp"
#include "papilla/meshing/duplicate.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/meshing/weld.hpp"

namespace {

using namespace papilla;
namespace fs = std::filesystem;
using bench::Recorder;

// --- speed and memory -----------------------------------------------------------------------------------------------

struct Soup {
  std::string name, file;
  std::size_t triangles = 0;
};

/// The sample cockpit as one binary STL: every triangle on its own, parts that touch.
Soup cockpit_soup(const TemporaryFolder& folder, double chord_mm, double angle_deg) {
  ReadOptions options;
  options.chord_mm = chord_mm;
  options.angle_deg = angle_deg;
  const std::string file = (folder / fmt::format("cockpit-{}.stl", chord_mm)).string();
  write_scene(read_scene(PAPILLA_COCKPIT, options), file);
  const std::size_t triangles = (fs::file_size(file) - 84) / 50;
  return {fmt::format("cockpit soup, {} k", triangles / 1000), file, triangles};
}

void repair_scene(Scene& scene) {
  for (Part& part : scene.parts) part.mesh = repair(std::move(part.mesh)).mesh;
}

/// Processor time of repair within the process on soups of all sizes. They take turns, so that a machine that is slower
/// for a while is so for all of them; of the turns the least counts, as the first run of a process also waits for its
/// memory.
std::vector<double> repair_seconds(const std::vector<Soup>& soups, const std::string& out) {
  constexpr int k_turns = 8;
  std::vector<double> least(soups.size(), std::numeric_limits<double>::infinity());
  for (int turn = 0; turn < k_turns; ++turn)
    for (std::size_t i = 0; i < soups.size(); ++i)
      least[i] = std::min(least[i], bench::cpu_of(1, [&] {
                            Scene scene = read_scene(soups[i].file);
                            repair_scene(scene);
                            write_scene(scene, out);
                          }));
  return least;
}

void add_scale(bench::BenchReport& report, const std::vector<Soup>& soups, const TemporaryFolder& folder) {
  auto seconds = std::make_shared<std::vector<double>>();
  for (std::size_t i = 0; i < soups.size(); ++i)
    report.add({.method = "repair", .input = soups[i].name, .notes = "binary STL in, GLB out, within the process"},
               [&soups, i, seconds, out = (folder / "in-process.glb").string()](Recorder& recorder) {
                 if (i == 0) *seconds = repair_seconds(soups, out);
                 recorder.record("cpu_ns_per_triangle", 1e9 * (*seconds)[i] / static_cast<double>(soups[i].triangles));
               });
}

void add_processes(bench::BenchReport& report, const Soup& soup, const TemporaryFolder& folder) {
  const auto add_process = [&](const std::string& method, const std::vector<std::string>& command) {
    report.add({.method = method, .input = soup.name, .notes = "whole process"}, [&soup, command](Recorder& recorder) {
      const bench::ProcessCost cost = bench::run_process(command);
      recorder.record("process_cpu_seconds", cost.cpu_seconds);
      recorder.record("process_seconds", cost.seconds);
      recorder.record("peak_bytes_per_triangle",
                      static_cast<double>(cost.peak_bytes) / static_cast<double>(soup.triangles));
    });
  };
  add_process("papilla repair", {PAPILLA_PROGRAM, "repair", soup.file, "-o", (folder / "papilla.glb").string()});
  if (bench::has_program("assimp"))
    add_process("assimp export", {"assimp", "export", soup.file, (folder / "assimp.glb").string(), "-f", "glb2"});
}

void report_speed(bench::BenchReport& report, const std::vector<Soup>& soups) {
  const auto of = [&](const char* method, const Soup& soup, const char* quantity) {
    return report.median_of(method, soup.name, quantity);
  };
  bench::EvidenceTable table{
      "Repair of a soup",
      "Binary STL in, clean GLB out. Processor time within the process (read, repair, write; the least of eight turns "
      "of all sizes), of the whole program "
      "`papilla repair`, and of `assimp export` to GLB, which reads and writes the same file and repairs nothing.",
      {"input", "ns per triangle", "program [cpu s]", "assimp [cpu s]", "ratio", "program peak [bytes/triangle]"},
      {}};
  const bool with_assimp = bench::has_program("assimp");
  double least = 1e300, most = 0, ratio = 0;
  for (const Soup& soup : soups) {
    const double ns = of("repair", soup, "cpu_ns_per_triangle");
    const double own = of("papilla repair", soup, "process_cpu_seconds");
    least = std::min(least, ns);
    most = std::max(most, ns);
    const double other = with_assimp ? of("assimp export", soup, "process_cpu_seconds") : 0;
    ratio = with_assimp ? own / other : 0;  // The largest comes last.
    table.rows.push_back({soup.name, fmt::format("{:.0f}", ns), fmt::format("{:.2f}", own),
                          with_assimp ? fmt::format("{:.2f}", other) : "-",
                          with_assimp ? fmt::format("{:.2f}", own / other) : "-",
                          fmt::format("{:.0f}", of("papilla repair", soup, "peak_bytes_per_triangle"))});
  }
  report.table(std::move(table));
  const Soup& largest = soups.back();
  const auto holds = [&](bool value) { return report.options().quick ? std::nullopt : std::optional(value); };
  report.target({"soup of two million triangles to clean GLB in at most 3 times assimp's plain read and write",
                 with_assimp ? fmt::format("{:.2f} times on {}", ratio, largest.name) : "no assimp here",
                 with_assimp ? holds(ratio <= 3) : std::nullopt});
  const double bytes = of("papilla repair", largest, "peak_bytes_per_triangle");
  report.target({"peak memory of the whole program at most 250 bytes per input triangle",
                 fmt::format("{:.0f} bytes on {}", bytes, largest.name), holds(bytes <= 250)});
  report.target({"time per triangle constant within 1.3 from 20 k to two million",
                 fmt::format("{:.0f} to {:.0f} ns, a factor of {:.2f}", least, most, most / least),
                 holds(most <= 1.3 * least)});
}

// --- every file -----------------------------------------------------------------------------------------------------

/// What repair makes of all parts of a file.
struct Outcome {
  std::size_t triangles_in = 0, triangles_out = 0;
  std::size_t loops_in = 0, loops_out = 0, cycles_in = 0, cycles_out = 0, parted = 0;
  std::size_t defects_in = 0, defects_out = 0;
  double stated_mm = 0, measured_mm = 0, relative = 0;
  std::size_t open_edges = 0;
  bool settled = true, again_same = true;
};

/// Distances below this fraction of the diagonal are rounding: single precision resolves six times that.
constexpr double k_rounding = 1e-8;

std::size_t defects(const MeshStatistics& s) {
  return s.nonmanifold_edges + s.degenerate_triangles + s.duplicate_triangles + s.flipped_edges + s.t_junctions;
}

void add_part(const TriangleMesh& mesh, Outcome& sum) {
  const MeshStatistics before = mesh_statistics(mesh);
  const RepairResult result = repair(mesh);
  const MeshStatistics after = mesh_statistics(result.mesh);
  const RepairResult again = repair(result.mesh);
  sum.triangles_in += before.triangles;
  sum.triangles_out += after.triangles;
  sum.loops_in += before.boundary_loops;
  sum.cycles_in += boundary_cycles(remove_duplicates(weld_equal(mesh).mesh).mesh);
  sum.loops_out += after.boundary_loops;
  sum.cycles_out += boundary_cycles(result.mesh);
  sum.parted += result.counts.parted_edges;
  sum.defects_in += defects(before);
  sum.defects_out += defects(after);
  sum.open_edges += after.boundary_edges;
  sum.settled = sum.settled && result.settled;
  sum.again_same =
      sum.again_same && again.mesh.triangles == result.mesh.triangles && again.mesh.positions == result.mesh.positions;
  sum.stated_mm = std::max(sum.stated_mm, result.max_deviation_mm);
  if (mesh.triangles.empty() || result.mesh.triangles.empty()) return;
  const double measured = surface_deviation(mesh, result.mesh).value();
  sum.measured_mm = std::max(sum.measured_mm, measured);
  sum.relative = std::max(sum.relative, measured / norm(before.high - before.low));
}

Outcome outcome_of(const Scene& scene) {
  Outcome sum;
  for (const Part& part : scene.parts) add_part(part.mesh, sum);
  return sum;
}

/// Why the plain count of loops is larger than before.
std::string why_more_loops(const Outcome& o) {
  if (o.loops_out <= o.loops_in) return "";
  return fmt::format(": of {} some touched, or lay at edges of three triangles", o.cycles_in);
}

std::vector<std::string> row_of(const std::string& name, const Outcome& o) {
  return {name,
          fmt::format("{} → {}", o.triangles_in, o.triangles_out),
          fmt::format("{} → {}", o.defects_in, o.defects_out),
          fmt::format("{} → {}", o.cycles_in, o.cycles_out),
          fmt::format("{} → {}{}", o.loops_in, o.loops_out, why_more_loops(o)),
          std::to_string(o.parted),
          std::to_string(o.open_edges),
          fmt::format("{:.2g} / {:.2g}", o.stated_mm, o.measured_mm),
          fmt::format("{:.1g}", o.relative),
          o.settled && o.again_same ? "yes" : "no"};
}

void report_files(bench::BenchReport& report) {
  bench::EvidenceTable table{
      "Every file",
      "Defects: non-manifold edges, degenerate and duplicate triangles, neighbours of opposite sense, T-junctions, as "
      "`papilla inspect` counts them. Boundary cycles: independent cycles of the edges with an odd number of "
      "triangles, "
      "double sheets counted once, as `boundary_cycles()` has it; on a clean mesh its border loops. Loops of single "
      "edges: sets of edges of one triangle that hang together, as `papilla inspect` counts them; these rise where "
      "loops that touched come apart, or a sheet that ended at others shows its border. Deviation: the bound that "
      "repair states / the largest distance measured between the surfaces, both ways [mm], and that over the bounding "
      "diagonal of the part. CAD files are tessellated at 0.5 mm.",
      {"file", "triangles", "defects", "boundary cycles", "loops of single edges", "parted edges", "open edges",
       "deviation", "relative", "again the same"},
      {}};
  std::size_t clean = 0, within = 0, fewer = 0, same = 0, read = 0, solids = 0, closed = 0;
  std::vector<std::string> risen;
  for (const fs::path& file : bench::model_files(report.options().inputs)) {
    const std::string name = file.filename().string();
    fmt::print(stderr, "[repair] {}\n", name);
    Outcome o;
    try {
      o = outcome_of(read_scene(file));
    } catch (const Error& error) {
      std::string why = error.what();
      if (why.starts_with(file.string() + ": ")) why.erase(0, file.string().size() + 2);
      table.rows.push_back({name, "refused: " + why, "", "", "", "", "", "", "", ""});
      continue;
    }
    ++read;
    clean += o.defects_out == 0;
    within += o.measured_mm <= o.stated_mm * (1 + 1e-9) || o.relative <= k_rounding;
    const bool no_more = o.cycles_out <= o.cycles_in;
    fewer += no_more;
    if (!no_more)
      risen.push_back(fmt::format("{} ({} → {}, {} edges parted)", name, o.cycles_in, o.cycles_out, o.parted));
    same += o.settled && o.again_same;
    if (bench::is_cad_file(file)) {
      ++solids;
      closed += o.open_edges == 0;
    }
    table.rows.push_back(row_of(name, o));
  }
  if (read == 0) return;
  report.table(std::move(table));
  const auto all = [&](const char* promise, std::size_t count, std::size_t of, const std::string& notes = "") {
    report.target({promise, fmt::format("{} of {} files{}", count, of, notes), count == of});
  };
  std::string notes;
  for (const std::string& name : risen) notes += (notes.empty() ? "; not: " : ", ") + name;
  all("after repair no non-manifold edge, degenerate or duplicate triangle, flipped neighbour, T-junction", clean,
      read);
  all("the measured deviation is within the stated bound", within, read);
  all("the number of boundary loops, counted modulo 2, never rises", fewer, read, notes);
  if (solids > 0) all("closed CAD solids come out closed", closed, solids);
  all("repairing again changes nothing", same, read);
}

void body(bench::BenchReport& report) {
  const bool quick = report.options().quick;
  const TemporaryFolder folder("papilla-bench");
  std::vector<Soup> soups;
  soups.push_back(cockpit_soup(folder, 20, 60));
  if (!quick) {
    soups.push_back(cockpit_soup(folder, 0.5, 28));
    soups.push_back(cockpit_soup(folder, 0.012, 10));
  }
  add_scale(report, soups, folder);
  for (const Soup& soup : soups) add_processes(report, soup, folder);
  if (bench::has_program("assimp")) report.compare("papilla repair", "assimp export", "process_cpu_seconds");
  const bench::ChartsComparison charts(report);
  const bench::SimplifyComparison simplification(report);
  report.measure();
  report_speed(report, soups);
  report_files(report);
  charts.report(report);
  simplification.report(report);
}

}  // namespace

int main(int argc, char** argv) { return bench::run_benchmark("meshing", "Meshing", argc, argv, body); }
