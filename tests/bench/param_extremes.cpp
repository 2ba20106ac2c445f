// SPDX-License-Identifier: MIT
// Target E: extremes of scale and shape.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/param_targets.hpp"

namespace papilla::bench {

void report_extremes(const TriangleMesh& dash, BenchReport& report) {
  const auto moved = [&](double scale, double offset) {
    TriangleMesh mesh = dash;
    for (Vec3& p : mesh.positions) p = scale * p + Vec3{offset, 0, 0};
    return mesh;
  };
  // An offset of 1e4 when the dashboard is 1.4 long.
  const std::vector<NamedMesh> extremes{
      {"scale 1e-6", moved(1e-6, 0)},          {"scale 1e6", moved(1e6, 0)},
      {"offset 1e7 mm", moved(1, 1e7)},        {"1 % squashed to 1e-9", squashed(dash, 1e-9)},
      {"1 % without area", squashed(dash, 0)}, {"trimmed holes", trimmed(dash)},
      {"needles 1:1000", needle_panel(1)},     {"needles 1:100 000", needle_panel(0.01)}};
  EvidenceTable table{"Extremes of the dashboard",
                      "Mean symmetric Dirichlet energy of triangles that have an area; flipped / degenerate in uv / "
                      "charts that took another map.",
                      {"extreme", "best", "maillot", "levy", "lscm (hermitian)"},
                      {}};
  const std::pair<const char*, MapMethod> methods[] = {
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
      if (extreme.name.starts_with("1 %")) rise[name] = std::max(rise[name], energy - base[name]);
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
  report.target({"E: best: triangles without area raise it by at most 0.0003", fmt::format("{:.2g}", rise["best"]),
                 rise["best"] <= 3e-4});
}

}  // namespace papilla::bench
