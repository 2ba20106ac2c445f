// SPDX-License-Identifier: MIT
// Target D: curved and branched disks.
#include <fmt/core.h>

#include "bench/param_targets.hpp"

namespace papilla::bench {

void report_curved(Peers& peers, BenchReport& report) {
  std::vector<NamedMesh> all = curved_disks(report.options().quick);
  for (NamedMesh& file : files_of(report))
    if (is_disk(file.mesh)) all.push_back(std::move(file));
  EvidenceTable table{
      "Curved and branched disks, and given files that are disks",
      "best, one chart each. SLIM: libigl's, 300 iterations at most, until the energy falls by less than 1e-5.",
      {"disk", "triangles", "flipped / degenerate / overlapping", "symmetric Dirichlet", "SLIM's", "ratio", "CPU s",
       "of SLIM's CPU"},
      {}};
  std::size_t valid = 0, as_good = 0, as_fast = 0, with_peer = 0;
  std::string failed, worse, slower;
  const auto note = [](std::string& list, const std::string& name) { add_name(list, name, "; not: "); };
  for (const NamedMesh& m : all) {
    Flattening f;
    const double seconds = cpu_of(3, [&] { f = best(m.mesh); });
    const DistortionReport r = measure_distortion(m.mesh, f.uv);
    const bool is_valid = f.notes.empty() && r.flipped + r.degenerate_uv + r.overlapping_within_charts == 0;
    valid += is_valid;
    if (!is_valid) note(failed, m.name);
    const Peer* slim = peers.find("slimconv", m.name, m.mesh);
    const bool slim_valid = slim && slim->valid();
    const double energy = r.symmetric_dirichlet.mean;
    std::string theirs = "-", ratio = "-", share = "-";
    if (slim) {
      theirs = fmt::format("{:.4f}{}", slim->report.symmetric_dirichlet.mean, slim_valid ? "" : " (not valid)");
      ratio = fmt::format("{:.4f}", energy / slim->report.symmetric_dirichlet.mean);
      if (seconds > 0) share = fmt::format("1/{:.1f}", slim->map.cpu_seconds / seconds);
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

}  // namespace papilla::bench
