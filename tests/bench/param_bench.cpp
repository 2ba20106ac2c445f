// SPDX-License-Identifier: MIT
// Maps of charts: speed, distortion, validity. Peers: CGAL's maps in the same program, and, when PAPILLA_PARAM_PEER
// names a program for them, libigl's (see param_peer.hpp). Files on the command line are unwrapped, too.
#include <fmt/core.h>
#include <malloc.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "bench/bench_json.hpp"
#include "bench/param_meshes.hpp"
#include "bench/param_peer.hpp"
#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/levy.hpp"
#include "papilla/param/lscm.hpp"
#include "papilla/param/maillot.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/natural.hpp"
#include "papilla/param/pack_unique.hpp"
#include "papilla/param/projections.hpp"
#include "papilla/param/reference_maps.hpp"
#include "papilla/param/triplanar.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"
#include "support/solid_meshes.hpp"

namespace {

using namespace papilla;
using bench::NamedMesh;

using Method = std::function<Flattening(const TriangleMesh&)>;

Flattening lscm_with(const TriangleMesh& mesh, LscmSolver solver) {
  LscmOptions options;
  options.solver = solver;
  return flatten_lscm(mesh, test::one_chart(mesh), options);
}

Flattening reference(const TriangleMesh& mesh, ReferenceMap map) {
  ReferenceOptions options;
  options.map = map;
  return flatten_reference(mesh, test::one_chart(mesh), options);
}

/// Without lengths what is left is least squares conformality: a linear map like lscm.
Flattening levy_conformal(const TriangleMesh& mesh) {
  LevyOptions options;
  options.length = 0;
  return flatten_levy(mesh, test::one_chart(mesh), options).flattening;
}

Flattening levy(const TriangleMesh& mesh) { return flatten_levy(mesh, test::one_chart(mesh)).flattening; }
Flattening maillot(const TriangleMesh& mesh) { return flatten_maillot(mesh, test::one_chart(mesh)).flattening; }
Flattening best(const TriangleMesh& mesh) { return flatten_best(mesh, test::one_chart(mesh)); }

struct Disk {
  std::string name;
  TriangleMesh mesh;
  enum Size { small, large, huge } size = small;
};

std::vector<Disk> disks(bool quick) {
  std::vector<Disk> all;
  if (quick) {
    all.push_back({"dash 10k", test::dashboard_mesh(20, 8)});
    return all;
  }
  all.push_back({"dash 10k", test::dashboard_mesh(118, 42)});
  all.push_back({"hemi 10k", test::hemisphere_mesh(50, 101)});
  all.push_back({"cyl 10k", test::grid_mesh(100, 50, test::open_cylinder, 0.15)});
  all.push_back({"needle 20k", bench::needle_panel(1)});
  all.push_back({"handle 10k", test::grid_mesh(32, 160, test::grab_handle, 0.15)});
  all.push_back({"dash 100k", test::dashboard_mesh(374, 134), Disk::large});
  all.push_back({"handle 100k", test::grid_mesh(100, 500, test::grab_handle, 0.15), Disk::large});
  all.push_back({"dash 1M", test::dashboard_mesh(1183, 423), Disk::huge});
  return all;
}

/// What the referee says, outside of the time.
void record_distortion(const TriangleMesh& mesh, const Flattening& flattening, bench::Recorder& recorder) {
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
                Method map, bench::BenchReport& report) {
  report.add({.method = method, .solver = solver, .input = disk.name, .error_name = error},
             [&disk, map = std::move(map)](bench::Recorder& recorder) {
               Flattening result;
               ::malloc_trim(0);  // what earlier subjects freed would hide what this one takes
               bench::reset_peak_rss();
               const double before = bench::peak_rss_mib();
               recorder.time([&] { result = map(disk.mesh); });
               recorder.record("added_mib", bench::peak_rss_mib() - before);
               record_distortion(disk.mesh, result, recorder);
             });
}

void add_triplanar(const Disk& disk, bench::BenchReport& report) {
  report.add({.method = "triplanar", .input = disk.name, .error_name = "lone triangles"},
             [&disk](bench::Recorder& recorder) {
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

void add_speed(const std::vector<Disk>& all, bench::BenchReport& report) {
  for (const Disk& disk : all) {
    add_triplanar(disk, report);
    add_method(
        disk, "lscm", "hermitian", "mean of (σ1 - σ2)²",
        [](const TriangleMesh& m) { return lscm_with(m, LscmSolver::hermitian); }, report);
    add_method(disk, "levy", "direct", "sum of Lévy's conditions [mm²]", levy_conformal, report);
    add_method(disk, "levy", "direct, lengths", "sum of Lévy's conditions [mm²]", levy, report);
    add_method(disk, "best", "", "mean symmetric Dirichlet energy", best, report);
    if (disk.size == Disk::huge) continue;
    add_method(disk, "maillot", "gauss-newton", "Maillot's energy [mm²]", maillot, report);
    add_method(
        disk, "lscm", "cgal", "mean of (σ1 - σ2)²",
        [](const TriangleMesh& m) { return lscm_with(m, LscmSolver::cgal); }, report);
    if (disk.size == Disk::large || disk.name.starts_with("needle")) continue;
    add_method(
        disk, "arap", "cgal", "mean symmetric Dirichlet energy",
        [](const TriangleMesh& m) { return reference(m, ReferenceMap::arap); }, report);
  }
  report.compare("lscm/hermitian", "lscm/cgal", "cpu_seconds");
  report.compare("levy/direct", "lscm/cgal", "cpu_seconds");
  report.compare("levy/direct, lengths", "lscm/cgal", "cpu_seconds");
  report.compare("best", "arap/cgal", "cpu_seconds");
  report.compare("maillot/gauss-newton", "arap/cgal", "cpu_seconds");
}

/// A map of a peer program with what the referee says of it.
struct Peer {
  bench::PeerMap map;
  DistortionReport report;
};

class Peers {
 public:
  /// Runs the method at most once per mesh; small meshes a few times, for the least time.
  const Peer* find(const std::string& method, const std::string& name, const TriangleMesh& mesh) {
    const auto [place, is_new] = peers_.try_emplace({method, name});
    if (is_new) {
      const int repeats = mesh.triangles.size() < 50'000 ? 3 : 1;
      for (int i = 0; i < repeats; ++i)
        if (auto map = bench::peer_map(method, mesh);
            map && (!place->second || map->cpu_seconds < place->second->map.cpu_seconds))
          place->second = Peer{std::move(*map), {}};
      if (place->second) place->second->report = measure_distortion(mesh, place->second->map.uv);
    }
    return place->second ? &*place->second : nullptr;
  }

 private:
  std::map<std::pair<std::string, std::string>, std::optional<Peer>> peers_;
};

/// Reads the medians of a benchmark.
struct Medians {
  const bench::BenchReport& report;
  double operator()(const std::string& subject, const std::string& input, const std::string& quantity) const {
    return report.median_of(subject, input, quantity);
  }
  double cpu(const std::string& subject, const std::string& input) const {
    return (*this)(subject, input, "cpu_seconds");
  }
  double energy(const std::string& subject, const std::string& input) const {
    return (*this)(subject, input, "symmetric_dirichlet_mean");
  }
  bool valid(const std::string& subject, const std::string& input) const {
    return (*this)(subject, input, "flipped") == 0 && (*this)(subject, input, "degenerate_uv") == 0 &&
           (*this)(subject, input, "overlap_within_charts") == 0;
  }
};

const TriangleMesh& mesh_of(const std::vector<Disk>& all, const std::string& name) {
  return std::find_if(all.begin(), all.end(), [&](const Disk& d) { return d.name == name; })->mesh;
}

/// CPU of ours over the peer's.
void cpu_target(const std::string& promise, const Medians& of, const std::string& subject, const std::string& input,
                const Peer* peer, double limit, double peer_share, bench::BenchReport& report) {
  if (!peer) {
    report.target({promise, fmt::format("{:.4f} s; no peer program was given", of.cpu(subject, input)), {}});
    return;
  }
  const double ratio = of.cpu(subject, input) / (peer_share * peer->map.cpu_seconds);
  report.target({promise,
                 fmt::format("{:.3f} ({:.4f} s against {:.4f} s)", ratio, of.cpu(subject, input),
                             peer_share * peer->map.cpu_seconds),
                 ratio <= limit});
}

void report_linear(const std::vector<Disk>& all, Peers& peers, const Medians& of, bench::BenchReport& report) {
  const std::pair<const char*, double> limits[] = {{"dash 10k", 0.40}, {"dash 100k", 0.33}, {"dash 1M", 0.15}};
  for (const auto& [name, limit] : limits) {
    const Peer* peer = peers.find("lscm", name, mesh_of(all, name));
    cpu_target(fmt::format("A: lscm (hermitian) on {}: at most {} of the CPU of libigl's LSCM", name, limit), of,
               "lscm/hermitian", name, peer, limit, 1, report);
    cpu_target(fmt::format("A: levy (direct, conformal) on {}: at most {} of it", name, limit), of, "levy/direct", name,
               peer, limit, 1, report);
    cpu_target(fmt::format("A, stretch: levy with lengths on {}: at most as much CPU", name), of,
               "levy/direct, lengths", name, peer, 1, 1, report);
    const double mib = of("lscm/hermitian", name, "added_mib");
    if (!std::string(name).ends_with(" 10k"))
      report.target({fmt::format("A: peak memory on {} at most 0.75 of libigl's", name),
                     peer ? fmt::format("{:.2f} ({:.0f} MiB added, {:.0f} MiB)", mib / peer->map.peak_mib, mib,
                                        peer->map.peak_mib)
                          : fmt::format("{:.0f} MiB; no peer program was given", mib),
                     peer ? std::optional(mib <= 0.75 * peer->map.peak_mib) : std::nullopt});
  }
  const std::pair<const char*, double> energies[] = {{"dash 10k", 4.016}, {"hemi 10k", 4.169}, {"handle 10k", 5.39}};
  for (const auto& [name, limit] : energies)
    report.target({fmt::format("A: levy with lengths halves LSCM's distortion: at most {} on {}", limit, name),
                   fmt::format("{:.5f}, {}", of.energy("levy/direct, lengths", name),
                               of.valid("levy/direct, lengths", name) ? "valid" : "NOT VALID"),
                   of.energy("levy/direct, lengths", name) <= limit && of.valid("levy/direct, lengths", name)});
  for (const char* subject : {"lscm/hermitian", "levy/direct, lengths", "best", "maillot/gauss-newton"})
    report.target({fmt::format("A: developable charts exact to 1e-9 (Maillot's measure), {}", subject),
                   fmt::format("{:.2g}", of(subject, "cyl 10k", "maillot_length")),
                   of(subject, "cyl 10k", "maillot_length") <= 1e-9});
}

void report_maillot(const std::vector<Disk>& all, Peers& peers, const Medians& of, bench::BenchReport& report) {
  const std::string subject = "maillot/gauss-newton";
  const std::pair<const char*, double> limits[] = {
      {"dash 10k", 0.00278}, {"hemi 10k", 0.125}, {"handle 10k", 0.0350}, {"needle 20k", 1.8e-4}};
  for (const auto& [name, limit] : limits) {
    report.target({fmt::format("B: maillot, φ = 0.5, E_l/ΣD² on {} at most {}", name, limit),
                   fmt::format("{:.4g}, {}", of(subject, name, "maillot_length"),
                               of.valid(subject, name) ? "valid" : "NOT VALID"),
                   of(subject, name, "maillot_length") <= limit && of.valid(subject, name)});
    const Peer* slim = peers.find("slimconv", name, mesh_of(all, name));
    const double energy = of.energy(subject, name);
    report.target({fmt::format("B: its symmetric Dirichlet energy on {} at most 1.005 of converged SLIM's", name),
                   slim ? fmt::format("{:.4f} ({:.5f} against {:.5f})", energy / slim->report.symmetric_dirichlet.mean,
                                      energy, slim->report.symmetric_dirichlet.mean)
                        : fmt::format("{:.5f}; no peer program was given", energy),
                   slim ? std::optional(energy <= 1.005 * slim->report.symmetric_dirichlet.mean) : std::nullopt});
  }
  for (const char* name : {"dash 10k", "handle 10k", "dash 100k", "handle 100k"})
    cpu_target(fmt::format("B: maillot on {}: at most 1/20 of the CPU of 20 SLIM iterations", name), of, subject, name,
               peers.find("slim20", name, mesh_of(all, name)), 1, 0.05, report);
  for (const char* name : {"dash 10k", "handle 10k"})
    report.target({fmt::format("B: maillot on {}: at most 1/30 of the CPU of CGAL's ARAP", name),
                   fmt::format("1/{:.1f}", of.cpu("arap/cgal", name) / of.cpu(subject, name)),
                   30 * of.cpu(subject, name) <= of.cpu("arap/cgal", name)});
  bench::EvidenceTable table{"Maillot: which φ",
                             "E_l/ΣD², E_f/ΣA and the mean symmetric Dirichlet energy by φ.",
                             {"disk", "φ", "length", "area", "symmetric Dirichlet"},
                             {}};
  for (const char* name : {"dash 10k", "hemi 10k", "handle 10k"})
    for (const double phi : {0.25, 0.5, 0.75, 0.9, 1.0}) {
      MaillotOptions options;
      options.length_weight = phi;
      const TriangleMesh& mesh = mesh_of(all, name);
      const DistortionReport r =
          measure_distortion(mesh, flatten_maillot(mesh, test::one_chart(mesh), options).flattening.uv);
      table.rows.push_back({name, fmt::format("{}", phi), fmt::format("{:.4g}", r.maillot_length),
                            fmt::format("{:.4g}", r.maillot_area), fmt::format("{:.5f}", r.symmetric_dirichlet.mean)});
    }
  report.table(std::move(table));
}

void report_million(const std::vector<Disk>& all, Peers& peers, const Medians& of, bench::BenchReport& report) {
  report.target(
      {"C: symmetric Dirichlet on dash 1M at most 4.0080",
       fmt::format("{:.5f}, {}", of.energy("best", "dash 1M"), of.valid("best", "dash 1M") ? "valid" : "NOT VALID"),
       of.energy("best", "dash 1M") <= 4.0080 && of.valid("best", "dash 1M")});
  cpu_target("C: best on dash 1M: at most 0.30 of the CPU of libigl's LSCM (stretch: 0.15)", of, "best", "dash 1M",
             peers.find("lscm", "dash 1M", mesh_of(all, "dash 1M")), 0.30, 1, report);
}

double cpu_of(const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double before = bench::process_cpu_seconds();
    work();
    least = std::min(least, bench::process_cpu_seconds() - before);
  }
  return least;
}

/// The largest part of a file, welded.
TriangleMesh part_of(const std::string& file) {
  Scene scene = read_scene(file);
  const auto largest = std::max_element(scene.parts.begin(), scene.parts.end(), [](const Part& a, const Part& b) {
    return a.mesh.triangles.size() < b.mesh.triangles.size();
  });
  if (largest == scene.parts.end()) throw InvalidInput(file + ": no part");
  return weld_equal(std::move(largest->mesh)).mesh;
}

std::vector<NamedMesh> files_of(const bench::BenchReport& report) {
  std::vector<NamedMesh> all;
  for (const std::string& file : report.options().inputs) {
    try {
      TriangleMesh mesh = part_of(file);
      if (!mesh.triangles.empty()) all.push_back({std::filesystem::path(file).filename().string(), std::move(mesh)});
    } catch (const Error&) {  // not a mesh
    }
  }
  return all;
}

/// Whether the method takes the whole mesh as one chart.
bool is_disk(const TriangleMesh& mesh) {
  BestOptions strict;
  strict.fall_back = false;
  strict.max_iterations = 0;
  try {
    const ChartSet charts = components_as_charts(mesh);
    if (charts.count != 1) return false;
    flatten_best(mesh, charts, strict);
    return true;
  } catch (const InvalidInput&) {
    return false;
  } catch (const SolverFailure&) {
    return true;
  }
}

void report_curved(Peers& peers, bench::BenchReport& report) {
  std::vector<NamedMesh> all = bench::curved_disks(report.options().quick);
  for (NamedMesh& file : files_of(report))
    if (is_disk(file.mesh)) all.push_back(std::move(file));
  bench::EvidenceTable table{
      "Curved and branched disks, and given files that are disks",
      "best, one chart each. SLIM: libigl's, 300 iterations at most, until the energy falls by less than 1e-5.",
      {"disk", "triangles", "flipped / degenerate / overlapping", "symmetric Dirichlet", "SLIM's", "ratio", "CPU s",
       "of SLIM's CPU"},
      {}};
  std::size_t valid = 0, as_good = 0, as_fast = 0, with_peer = 0;
  std::string failed, worse, slower;
  const auto note = [](std::string& list, const std::string& name) {
    list += (list.empty() ? "; not: " : ", ") + name;
  };
  for (const NamedMesh& m : all) {
    Flattening f;
    const double seconds = cpu_of([&] { f = best(m.mesh); });
    const DistortionReport r = measure_distortion(m.mesh, f.uv);
    const bool is_valid = f.notes.empty() && r.flipped + r.degenerate_uv + r.overlapping_within_charts == 0;
    valid += is_valid;
    if (!is_valid) note(failed, m.name);
    const Peer* slim = peers.find("slimconv", m.name, m.mesh);
    const bool slim_valid =
        slim && slim->report.flipped + slim->report.degenerate_uv == 0 && slim->report.overlapping_within_charts == 0;
    const double energy = r.symmetric_dirichlet.mean;
    std::string theirs = "-", ratio = "-", share = "-";
    if (slim) {
      theirs = fmt::format("{:.4f}{}", slim->report.symmetric_dirichlet.mean, slim_valid ? "" : " (not valid)");
      ratio = fmt::format("{:.4f}", energy / slim->report.symmetric_dirichlet.mean);
      share = fmt::format("1/{:.1f}", slim->map.cpu_seconds / seconds);
    }
    if (slim_valid) {
      ++with_peer;
      const bool good = energy <= 1.02 * slim->report.symmetric_dirichlet.mean;
      const bool fast = 5 * seconds <= slim->map.cpu_seconds;
      as_good += good, as_fast += fast;
      if (!good) note(worse, m.name);
      if (!fast) note(slower, m.name);
    }
    table.rows.push_back({m.name, std::to_string(m.mesh.triangles.size()),
                          fmt::format("{} / {} / {}", r.flipped, r.degenerate_uv, r.overlapping_within_charts),
                          fmt::format("{:.4f}", energy), theirs, ratio, fmt::format("{:.3f}", seconds), share});
  }
  report.table(std::move(table));
  report.target({"D: best on curved and branched disks: no flipped, no degenerate, no overlapping triangle",
                 fmt::format("{} of {}{}", valid, all.size(), failed), valid == all.size()});
  if (with_peer == 0) return;
  report.target({"D: symmetric Dirichlet at most 1.02 of converged SLIM's, where that is valid",
                 fmt::format("{} of {}{}", as_good, with_peer, worse), as_good == with_peer});
  report.target(
      {"D: in at most 1/5 of its CPU", fmt::format("{} of {}{}", as_fast, with_peer, slower), as_fast == with_peer});
}

void report_extremes(const TriangleMesh& dash, bench::BenchReport& report) {
  const auto moved = [&](double scale, double offset) {
    TriangleMesh mesh = dash;
    for (Vec3& p : mesh.positions) p = scale * p + Vec3{offset, 0, 0};
    return mesh;
  };
  // An offset of 1e4 when the dashboard is 1.4 long.
  const std::vector<NamedMesh> extremes{{"scale 1e-6", moved(1e-6, 0)},
                                        {"scale 1e6", moved(1e6, 0)},
                                        {"offset 1e7 mm", moved(1, 1e7)},
                                        {"1 % squashed to 1e-9", bench::squashed(dash, 1e-9)},
                                        {"1 % without area", bench::squashed(dash, 0)},
                                        {"trimmed holes", bench::trimmed(dash)},
                                        {"needles 1:1000", bench::needle_panel(1)},
                                        {"needles 1:100 000", bench::needle_panel(0.01)}};
  bench::EvidenceTable table{
      "Extremes of the dashboard",
      "Mean symmetric Dirichlet energy of triangles that have an area; flipped / degenerate in uv / "
      "charts that took another map.",
      {"extreme", "best", "maillot", "levy", "lscm (hermitian)"},
      {}};
  const std::pair<const char*, Method> methods[] = {
      {"best", best}, {"maillot", maillot}, {"levy", levy}, {"lscm", [](const TriangleMesh& m) {
                                                               return lscm_with(m, LscmSolver::hermitian);
                                                             }}};
  std::map<std::string, std::size_t> passed;
  std::map<std::string, double> base, drift, rise;
  for (const auto& [name, method] : methods)
    base[name] = measure_distortion(dash, method(dash).uv).symmetric_dirichlet.mean;
  for (const NamedMesh& extreme : extremes) {
    std::vector<std::string> row{extreme.name};
    for (const auto& [name, method] : methods) {
      const Flattening f = method(extreme.mesh);
      const DistortionReport r = measure_distortion(extreme.mesh, f.uv);
      const double energy = r.symmetric_dirichlet.mean;
      passed[name] += r.flipped + r.degenerate_uv == 0 && r.overlap_within_charts == 0 && std::isfinite(energy);
      if (extreme.name.starts_with("scale") || extreme.name.starts_with("offset"))
        drift[name] = std::max(drift[name], std::abs(energy / base[name] - 1));
      if (extreme.name.starts_with("1 %")) rise[name] = std::max(rise[name], energy / base[name] - 1);
      row.push_back(fmt::format("{:.5f}; {} / {} / {}", energy, r.flipped, r.degenerate_uv, f.notes.size()));
    }
    table.rows.push_back(std::move(row));
  }
  report.table(std::move(table));
  for (const auto& [name, method] : methods)
    report.target({fmt::format("E: {}: 8 of 8 extremes valid", name), fmt::format("{} of 8", passed[name]),
                   passed[name] == extremes.size()});
  report.target({"E: best: scale and offset change the energy by less than 1e-6", fmt::format("{:.1g}", drift["best"]),
                 drift["best"] < 1e-6});
  report.target({"E: best: triangles without area raise it by at most 1 %", fmt::format("{:.2g} %", 100 * rise["best"]),
                 rise["best"] <= 0.01});
}

/// A peer's charts on a shape of the same formula and size, as measured with them once; seam over the root of the area.
struct KnownPeer {
  const char *part, *peer;
  int charts;
  double seam, energy, cpu_seconds;
};

constexpr KnownPeer k_known_peers[] = {{"panel 20k", "xatlas", 6, 6.11, 4.0295, 8.1},
                                       {"panel 20k", "geogram (LSCM)", 6, 6.11, 4.0375, 0.32},
                                       {"panel 20k", "geogram (ABF)", 6, 6.11, 4.0196, 0.46},
                                       {"torus 20k", "xatlas", 15, 13.2, 4.0053, 1.9},
                                       {"torus 20k", "geogram (LSCM)", 15, 9.18, 4.0214, 0.57},
                                       {"capped cylinder", "xatlas", 5, 4.38, 4.0000, 0.067},
                                       {"capped cylinder", "geogram (LSCM)", 4, 3.67, 4.0000, 0.096},
                                       {"handle 10k", "xatlas", 25, 9.36, 4.1344, 1.3},
                                       {"handle 10k", "geogram (LSCM)", 6, 2.96, 4.0782, 0.30},
                                       {"handle 100k", "xatlas", 1024, 34.4, 4.0581, 36},
                                       {"dash 100k", "xatlas", 1, 0, 4.0210, 214}};

/// What seams cost against distortion; the first is the default.
constexpr double k_seam_costs[] = {0.03, 0.01, 0.1};

/// xatlas took longer than this on what counts as big [s].
constexpr double k_big_s = 5;

struct Whole {
  std::uint32_t charts = 0;
  double seam = 0, cpu_seconds = 0, fill = 0;
  DistortionReport report;
};

Whole unwrap_whole(const TriangleMesh& mesh, double seam_cost) {
  Whole whole;
  Flattening f;
  double seam = 0;
  whole.cpu_seconds = cpu_of([&] {
    SegmentationOptions options;
    options.disks = false;
    options.seam_cost = seam_cost;
    const ChartSet charts = segment_charts(mesh, options).charts;
    seam = charts.seam_length_mm;
    f = flatten_automatic(cut_open(mesh, charts), charts).flattening;
  });
  whole.charts = f.charts.count;

  const UniqueAtlas atlas = pack_unique(f.uv, f.charts);
  whole.fill = atlas.fill_rate;
  whole.report = measure_distortion(mesh, atlas.uv);
  whole.seam = seam / std::sqrt(whole.report.area_mm2);
  return whole;
}

void report_parts(const std::vector<Disk>& all, bench::BenchReport& report) {
  std::vector<NamedMesh> parts{{"panel 20k", test::panel_mesh(118, 42)},
                               {"torus 20k", test::torus_mesh(160, 64)},
                               {"capped cylinder", test::capped_cylinder_mesh(256)}};
  for (const char* name : {"handle 10k", "handle 100k", "dash 10k", "dash 100k"})
    parts.push_back({name, mesh_of(all, name)});
  parts.push_back({"panel 200k", test::panel_mesh(374, 134)});
  for (NamedMesh& file : files_of(report))
    if (!is_disk(file.mesh)) parts.push_back(std::move(file));
  bench::EvidenceTable table{
      "Whole parts",
      "Segmentation and auto, for seam costs of 0.03 (the default), 0.01 and 0.1, and the fill of a square texture of "
      "2048 "
      "texels with gutters of 4. Seam: length over the root of the area. Peers: numbers once measured on shapes of the "
      "same formulas and sizes, CPU on another day.",
      {"part", "by", "charts", "seam", "symmetric Dirichlet", "CPU s", "flipped / mirrored / unmapped / overlapping",
       "fill"},
      {}};
  std::map<std::string, Whole> wholes;
  bool clean = true;
  std::string losers, slow;
  const auto note = [](std::string& list, const std::string& name) { list += (list.empty() ? "not: " : ", ") + name; };
  for (const NamedMesh& part : parts) {
    std::vector<Whole> tried;
    for (const double cost : k_seam_costs) {
      const Whole& w = tried.emplace_back(unwrap_whole(part.mesh, cost));
      const DistortionReport& r = w.report;
      clean = clean && r.flipped + r.mirrored_charts + r.without_uv + r.overlapping_triangles == 0;
      table.rows.push_back(
          {part.name, fmt::format("papilla, {}", cost), std::to_string(w.charts), fmt::format("{:.2f}", w.seam),
           fmt::format("{:.4f}", r.symmetric_dirichlet.mean), fmt::format("{:.3f}", w.cpu_seconds),
           fmt::format("{} / {} / {} / {}", r.flipped, r.mirrored_charts, r.without_uv, r.overlapping_triangles),
           fmt::format("{:.2f}", w.fill)});
    }
    wholes[part.name] = tried.front();
    for (const KnownPeer& p : k_known_peers) {
      if (p.part != part.name) continue;
      table.rows.push_back({part.name, p.peer, std::to_string(p.charts), fmt::format("{:.2f}", p.seam),
                            fmt::format("{:.4f}", p.energy), fmt::format("{:.3f}", p.cpu_seconds), "", ""});
      const std::string pair = part.name + " against " + p.peer;
      const bool dominated = std::any_of(tried.begin(), tried.end(), [&](const Whole& w) {
        return w.charts <= static_cast<std::uint32_t>(p.charts) && w.seam <= 1.005 * p.seam + 1e-9 &&
               w.report.symmetric_dirichlet.mean <= p.energy + 5e-5;
      });
      if (!dominated) note(losers, pair);
      const double share = p.cpu_seconds > k_big_s ? 0.1 : 1.0 / 3;
      if (std::string(p.peer) == "xatlas" && tried.front().cpu_seconds > share * p.cpu_seconds) note(slow, pair);
    }
  }
  report.table(std::move(table));
  report.target({"F: no worse than each peer in charts, seam length and distortion at once, with one of the seam costs",
                 losers.empty() ? "on every part" : losers, losers.empty()});
  report.target({"F: CPU at most 1/3 of xatlas's on small parts, 1/10 on big ones",
                 slow.empty() ? "on every part" : slow, slow.empty()});
  report.target({"F: no flipped, mirrored, unmapped or overlapping triangle in the atlas",
                 clean ? "none" : "see the table", clean});
  const std::tuple<const char*, const char*> sizes[] = {
      {"handle 10k", "handle 100k"}, {"dash 10k", "dash 100k"}, {"panel 20k", "panel 200k"}};
  for (const auto& [coarse, fine] : sizes)
    report.target({fmt::format("F: as many charts, ±1, on {} as on {}", fine, coarse),
                   fmt::format("{} and {}", wholes[fine].charts, wholes[coarse].charts),
                   std::max(wholes[fine].charts, wholes[coarse].charts) <=
                       1 + std::min(wholes[fine].charts, wholes[coarse].charts)});
}

void report_triplanar(const std::vector<Disk>& all, const Medians& of, bench::BenchReport& report) {
  const auto least = [&](const std::string& name, double wanted, const char* quantity, const std::string& promise) {
    const double value = of("triplanar", name, quantity);
    report.target({promise, fmt::format("{:.1f} million", value), value >= wanted});
  };
  least("dash 1M", 50, "project_mtri_per_second",
        "G: triplanar's projection: 50 million triangles a second, one thread");
  least("dash 1M", 5, "mtri_per_second", "G: the whole method: 5 million triangles a second, one thread");
  double overlap = 0, lone = 0;
  for (const Disk& disk : all) {
    overlap = std::max(overlap, of("triplanar", disk.name, "overlap_within_charts"));
    lone += of("triplanar", disk.name, "charts_of_one_face");
  }
  report.target({"G: no overlap, no chart of one face, on all disks above",
                 fmt::format("overlap {}, {} charts of one face", overlap, lone), overlap == 0 && lone == 0});
  report.target({"G: at most half of the 42 charts of Blender's smart project on handle 10k",
                 fmt::format("{}", of("triplanar", "handle 10k", "charts")),
                 of("triplanar", "handle 10k", "charts") <= 21});
}

void report_same(const std::vector<Disk>& all, bench::BenchReport& report) {
  const std::pair<const char*, Method> methods[] = {
      {"lscm", [](const TriangleMesh& m) { return lscm_with(m, LscmSolver::hermitian); }},
      {"levy", levy},
      {"maillot", maillot},
      {"best", best},
      {"triplanar", [](const TriangleMesh& m) { return flatten_triplanar(m).flattening; }},
      {"auto", [](const TriangleMesh& m) { return flatten_automatic(m, segment_charts(m).charts).flattening; }}};
  std::string different;
  for (const char* name : {"dash 100k", "handle 10k"})
    for (const auto& [method, map] : methods) {
      const TriangleMesh& mesh = mesh_of(all, name);
      const Flattening first = map(mesh), again = map(mesh);
      const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, 1);
      const Flattening alone = map(mesh);
      const auto same = [&](const Flattening& f) {
        return f.uv.values == first.uv.values && f.uv.indices == first.uv.indices &&
               f.charts.of_triangle == first.charts.of_triangle;
      };
      if (!same(again) || !same(alone))
        different += fmt::format("{}{} on {}", different.empty() ? "not: " : ", ", method, name);
    }
  report.target({"H: the same bytes again and on one thread: lscm, levy, maillot, best, triplanar, auto",
                 different.empty() ? "on dash 100k and handle 10k" : different, different.empty()});
}

/// What a method says to bad input.
std::string answer(const std::function<std::string()>& work, bool& defined) {
  try {
    return work();
  } catch (const InvalidInput& error) {
    return std::string("refused as input: ") + error.what();
  } catch (const SolverFailure& error) {
    return std::string("refused by the solver: ") + error.what();
  } catch (const std::exception& error) {
    defined = false;
    return std::string("UNDEFINED: ") + error.what();
  }
}

void report_bad_input(bench::BenchReport& report) {
  const auto strict = [](const TriangleMesh& mesh) {
    BestOptions options;
    options.fall_back = false;
    return fmt::format("{} chart mapped", flatten_best(mesh, test::one_chart(mesh), options).charts.count);
  };
  const auto with = [](TriangleMesh mesh, const std::function<void(TriangleMesh&)>& change) {
    change(mesh);
    return mesh;
  };
  const TriangleMesh plane = test::plane(2, 2, 2, 2);
  TriangleMesh pocket;
  pocket.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  pocket.triangles = {{0, 1, 2}, {0, 2, 1}};
  const auto pinned = [&](std::vector<LevyPin> pins) {
    LevyOptions options;
    options.pins = std::move(pins);
    return fmt::format("{} chart mapped", flatten_levy(plane, test::one_chart(plane), options).flattening.charts.count);
  };
  const auto phi = [&](double value) {
    MaillotOptions options;
    options.length_weight = value;
    return fmt::format("{} chart mapped",
                       flatten_maillot(plane, test::one_chart(plane), options).flattening.charts.count);
  };
  const std::pair<const char*, std::function<std::string()>> cases[] = {
      {"a closed surface as one chart", [&] { return strict(test::cube(1)); }},
      {"a torus as one chart", [&] { return strict(test::torus(3, 1, 12, 8)); }},
      {"an edge of three triangles",
       [&] {
         return strict(with(plane, [](TriangleMesh& m) {
           m.positions.push_back({0, 0, 1});
           m.triangles.push_back({m.triangles[0][0], m.triangles[0][1], static_cast<Index>(m.positions.size() - 1)});
         }));
       }},
      {"a Möbius strip", [&] { return strict(test::moebius_strip(10, 2, 20, 2)); }},
      {"isolated vertices",
       [&] { return strict(with(plane, [](TriangleMesh& m) {
               m.positions.push_back({9, 9, 9});
             })); }},
      {"one triangle", [&] { return strict(with(plane, [](TriangleMesh& m) { m.triangles.resize(1); })); }},
      {"no triangle", [&] { return strict(with(plane, [](TriangleMesh& m) { m.triangles.clear(); })); }},
      {"a coordinate that is not a number",
       [&] { return strict(with(plane, [](TriangleMesh& m) { m.positions[3].y = std::nan(""); })); }},
      {"an index out of range", [&] { return strict(with(plane, [](TriangleMesh& m) { m.triangles[1][2] = 99; })); }},
      {"no area at all",
       [&] {
         return strict(with(plane, [](TriangleMesh& m) {
           for (Vec3& p : m.positions) p = {};
         }));
       }},
      {"a border of two vertices", [&] { return strict(pocket); }},
      {"φ = 1.5", [&] { return phi(1.5); }},
      {"φ not a number", [&] { return phi(std::nan("")); }},
      {"two pins on one vertex",
       [&] {
         return pinned({{0, {0, 0}}, {0, {1, 1}}});
       }},
      {"two pins on one place",
       [&] {
         return pinned({{0, {0, 0}}, {5, {0, 0}}});
       }},
      {"one pin on a free border",
       [&] {
         return pinned({{0, {0, 0}}});
       }},
      {"a pin on a vertex that does not exist",
       [&] {
         return pinned({{0, {0, 0}}, {77, {1, 1}}});
       }},
      {"natural without CAD parameters", [&] { return fmt::format("{}", flatten_natural(plane).charts.count); }}};
  bench::EvidenceTable table{"Bad input", "Each method's answer without a fallback.", {"input", "answer"}, {}};
  bool defined = true;
  for (const auto& [name, work] : cases) table.rows.push_back({name, answer(work, defined)});
  report.target({"H: every bad input is refused with its place, or has a defined result",
                 fmt::format("{} cases, see the table", std::size(cases)), defined});
  report.table(std::move(table));
}

void report_methods(const std::vector<Disk>& all, const Medians& of, bench::BenchReport& report) {
  bench::EvidenceTable table{
      "Methods on one chart",
      "Medians over the repeats; CPU of the whole process.",
      {"disk", "method", "CPU s", "symmetric Dirichlet", "Maillot", "flipped / degenerate / fell back"},
      {}};
  for (const Disk& disk : all)
    for (const char* subject : {"triplanar", "lscm/cgal", "lscm/hermitian", "levy/direct", "levy/direct, lengths",
                                "arap/cgal", "maillot/gauss-newton", "best"}) {
      const std::string name = subject;
      if (disk.size == Disk::huge && (name.ends_with("cgal") || name.starts_with("maillot"))) continue;
      if (std::string(subject) == "arap/cgal" && (disk.size != Disk::small || disk.name.starts_with("needle")))
        continue;
      table.rows.push_back({disk.name, subject, fmt::format("{:.4f}", of.cpu(subject, disk.name)),
                            fmt::format("{:.5f}", of.energy(subject, disk.name)),
                            fmt::format("{:.4g}", of(subject, disk.name, "maillot_length")),
                            fmt::format("{} / {} / {}", of(subject, disk.name, "flipped"),
                                        of(subject, disk.name, "degenerate_uv"), of(subject, disk.name, "fell_back"))});
    }
  report.table(std::move(table));
}

void body(bench::BenchReport& report) {
  const std::vector<Disk> all = disks(report.options().quick);
  add_speed(all, report);
  report.measure();
  report_bad_input(report);
  if (report.options().quick) return;
  const Medians of{report};
  Peers peers;
  report_linear(all, peers, of, report);
  report_maillot(all, peers, of, report);
  report_million(all, peers, of, report);
  report_curved(peers, report);
  report_extremes(mesh_of(all, "dash 10k"), report);
  report_parts(all, report);
  report_triplanar(all, of, report);
  report_same(all, report);
  report_methods(all, of, report);
}

}  // namespace

int main(int argc, char** argv) {
  return bench::run_benchmark("param", "Maps of charts: speed, distortion, validity", argc, argv, body);
}
