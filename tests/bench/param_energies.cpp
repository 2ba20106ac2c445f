// SPDX-License-Identifier: MIT
// Targets A and B: linear maps, Maillot's energy.
#include <fmt/core.h>

#include "bench/param_targets.hpp"
#include "papilla/param/maillot.hpp"
#include "support/formula_meshes.hpp"

namespace papilla::bench {

void report_linear(const std::vector<Disk>& all, Peers& peers, const Medians& of, BenchReport& report) {
  const std::pair<const char*, double> limits[] = {{"dash 10k", 0.40}, {"dash 100k", 0.33}, {"dash 1M", 0.15}};
  for (const auto& [name, limit] : limits) {
    const Peer* peer = peers.find("lscm", name, mesh_of(all, name));
    cpu_target(fmt::format("A: lscm (hermitian) on {}: at most {} of the CPU of libigl's LSCM", name, limit),
               mesh_of(all, name), lscm_hermitian, peer, limit, 1, report);
    cpu_target(fmt::format("A: levy (direct, conformal) on {}: at most {} of it", name, limit), mesh_of(all, name),
               levy_conformal, peer, limit, 1, report);
    cpu_target(fmt::format("A, stretch: levy with lengths on {}: at most as much CPU", name), mesh_of(all, name), levy,
               peer, 1, 1, report);
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

void report_maillot(const std::vector<Disk>& all, Peers& peers, const Medians& of, BenchReport& report) {
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
    cpu_target(fmt::format("B: maillot on {}: at most 1/20 of the CPU of 20 SLIM iterations", name), mesh_of(all, name),
               maillot, peers.find("slim20", name, mesh_of(all, name)), 1, 0.05, report);
  for (const char* name : {"dash 10k", "handle 10k", "dash 100k", "handle 100k"}) {
    const TriangleMesh& mesh = mesh_of(all, name);
    const double share = cpu_of(1, [&] { arap(mesh); }) / cpu_of(3, [&] { maillot(mesh); });
    report.target({fmt::format("B: maillot on {}: at most 1/30 of the CPU of CGAL's ARAP", name),
                   fmt::format("1/{:.1f}", share), share >= 30});
  }
  EvidenceTable table{"Maillot: which φ",
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

}  // namespace papilla::bench
