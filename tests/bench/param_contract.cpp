// SPDX-License-Identifier: MIT
// Targets G and H: projection, the same bytes in every run, bad input.
#include <fmt/core.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/param_targets.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/levy.hpp"
#include "papilla/param/maillot.hpp"
#include "papilla/param/natural.hpp"
#include "papilla/param/triplanar.hpp"
#include "papilla_test/shapes.hpp"
#include "support/formula_meshes.hpp"

namespace papilla::bench {

void report_triplanar(const std::vector<Disk>& all, const Medians& of, BenchReport& report) {
  // The steps are clocked by the wall: their shares of it are those of the CPU.
  const TriangleMesh& mesh = mesh_of(all, "dash 1M");
  double cpu = std::numeric_limits<double>::infinity(), project = cpu;
  for (int i = 0; i < 10; ++i) {
    TriplanarSeconds seconds;
    const double own = cpu_of(1, [&] { seconds = flatten_triplanar(mesh).seconds; });
    cpu = std::min(cpu, own);
    project = std::min(project, own * seconds.project / seconds.total);
  }
  const double millions = 1e-6 * static_cast<double>(mesh.triangles.size());
  const auto least = [&](double value, double wanted, const std::string& promise) {
    report.target({promise, fmt::format("{:.1f} million", value), value >= wanted});
  };
  least(millions / project, 50, "G: triplanar's projection: 50 million triangles a second, one thread");
  least(millions / cpu, 5, "G: the whole method: 5 million triangles a second, one thread");
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

void report_same(const std::vector<Disk>& all, BenchReport& report) {
  const std::pair<const char*, MapMethod> methods[] = {
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

namespace {

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

}  // namespace

void report_bad_input(BenchReport& report) {
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
  EvidenceTable table{"Bad input", "Each method's answer without a fallback.", {"input", "answer"}, {}};
  bool defined = true;
  for (const auto& [name, work] : cases) table.rows.push_back({name, answer(work, defined)});
  report.target({"H: every bad input is refused with its place, or has a defined result",
                 fmt::format("{} cases, see the table", std::size(cases)), defined});
  report.table(std::move(table));
}

}  // namespace papilla::bench
