// SPDX-License-Identifier: MIT
// Target F: whole parts.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "bench/param_targets.hpp"
#include "papilla/meshing/cut_open.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/param/automatic.hpp"
#include "papilla/param/pack_unique.hpp"
#include "papilla/param/seam_choice.hpp"
#include "support/formula_meshes.hpp"
#include "support/solid_meshes.hpp"

namespace papilla::bench {
namespace {

/// A peer's charts; seam over the root of the area.
struct PartPeer {
  std::string part, peer;
  std::uint32_t charts;
  double seam, energy, cpu_seconds;
};

/// Measured once on shapes of the same formula and size, for peers that are not there or take minutes.
const std::vector<PartPeer>& known_peers() {
  static const std::vector<PartPeer> known{{"panel 20k", "xatlas", 6, 6.11, 4.0295, 8.1},
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
  return known;
}

/// Of meshes up to this size xatlas is measured anew.
constexpr std::size_t k_most_triangles = 25'000;

std::vector<PartPeer> peers_of(const NamedMesh& part) {
  std::vector<PartPeer> peers;
  for (const PartPeer& known : known_peers()) {
    if (known.part != part.name) continue;
    PartPeer peer = known;
    const bool again = peer.peer == "xatlas" && part.mesh.triangles.size() <= k_most_triangles;
    if (const auto atlas = again ? peer_atlas("xatlas", part.mesh) : std::nullopt) {
      const DistortionReport r = measure_distortion(part.mesh, atlas->uv);
      peer = {part.name,
              "xatlas, now",
              r.charts,
              r.seam_length_mm / std::sqrt(r.area_mm2),
              r.symmetric_dirichlet.mean,
              atlas->cpu_seconds};
    }
    peers.push_back(peer);
  }
  return peers;
}

/// What seams cost against distortion; the first is what comes without a wish.
constexpr std::optional<double> k_seam_costs[] = {std::nullopt, 0.03, 0.01, 0.1};

/// xatlas took longer than this on what counts as big [s].
constexpr double k_big_s = 5;

struct Whole {
  std::uint32_t charts = 0;
  double seam = 0, cpu_seconds = 0, fill = 0;
  DistortionReport report;
};

/// @param seam_cost not given: found by choose_seam_cost().
Whole unwrap_whole(const TriangleMesh& mesh, std::optional<double> seam_cost) {
  Whole whole;
  Flattening f;
  const auto map = [&](double cost) {
    SegmentationOptions options;
    options.disks = false;
    options.seam_cost = cost;
    const ChartSet charts = segment_charts(mesh, options).charts;
    return flatten_automatic(cut_open(mesh, charts), charts).flattening;
  };
  whole.cpu_seconds = cpu_of(3, [&] { f = seam_cost ? map(*seam_cost) : choose_seam_cost(mesh, map).flattening; });
  whole.charts = f.charts.count;

  const UniqueAtlas atlas = pack_unique(f.uv, f.charts);
  whole.fill = atlas.fill_rate;
  whole.report = measure_distortion(mesh, atlas.uv);
  whole.seam = whole.report.seam_length_mm / std::sqrt(whole.report.area_mm2);
  return whole;
}

/// The parts that targets speak of; files are repaired first, as bake does.
std::vector<NamedMesh> parts_of(const std::vector<Disk>& all, const BenchReport& report) {
  std::vector<NamedMesh> parts{{"panel 20k", test::panel_mesh(118, 42)},
                               {"torus 20k", test::torus_mesh(160, 64)},
                               {"capped cylinder", test::capped_cylinder_mesh(256)}};
  for (const char* name : {"handle 10k", "handle 100k", "dash 10k", "dash 100k"})
    parts.push_back({name, mesh_of(all, name)});
  parts.push_back({"panel 200k", test::panel_mesh(374, 134)});
  for (NamedMesh& file : files_of(report))
    if (!is_disk(file.mesh)) parts.push_back({file.name, repair(std::move(file.mesh)).mesh});
  return parts;
}

/// No worse in charts, seam length and distortion at once.
bool dominates(const Whole& own, const PartPeer& peer) {
  return own.charts <= peer.charts && own.seam <= 1.005 * peer.seam + 1e-9 &&
         own.report.symmetric_dirichlet.mean <= peer.energy + 5e-5;
}

void report_chart_counts(std::map<std::string, Whole>& wholes, BenchReport& report) {
  const std::pair<const char*, const char*> sizes[] = {
      {"handle 10k", "handle 100k"}, {"dash 10k", "dash 100k"}, {"panel 20k", "panel 200k"}};
  for (const auto& [coarse, fine] : sizes)
    report.target({fmt::format("F: as many charts, ±1, on {} as on {}", fine, coarse),
                   fmt::format("{} and {}", wholes[fine].charts, wholes[coarse].charts),
                   std::max(wholes[fine].charts, wholes[coarse].charts) <=
                       1 + std::min(wholes[fine].charts, wholes[coarse].charts)});
}

}  // namespace

void report_parts(const std::vector<Disk>& all, BenchReport& report) {
  EvidenceTable table{"Whole parts",
                      "Segmentation and auto, with the seam cost that it chooses, and with 0.03, 0.01 and 0.1, and the "
                      "fill of a square "
                      "texture of 2048 texels with gutters of 4. Seam: length over the root of the area. Peers: "
                      "measured now where it says so; "
                      "else numbers once measured on shapes of the same formulas and sizes, CPU on another day.",
                      {"part", "by", "charts", "seam", "symmetric Dirichlet", "CPU s",
                       "flipped / mirrored / unmapped / overlapping", "fill"},
                      {}};
  std::map<std::string, Whole> wholes;
  bool clean = true;
  std::string lost, lost_by_default, slow;
  for (const NamedMesh& part : parts_of(all, report)) {
    std::vector<Whole> tried;
    for (const std::optional<double> cost : k_seam_costs) {
      const Whole& w = tried.emplace_back(unwrap_whole(part.mesh, cost));
      const DistortionReport& r = w.report;
      clean = clean && r.flipped + r.mirrored_charts + r.without_uv + r.overlapping_triangles == 0;
      table.rows.push_back(
          {part.name, cost ? fmt::format("papilla, {}", *cost) : "papilla", std::to_string(w.charts),
           fmt::format("{:.2f}", w.seam), fmt::format("{:.4f}", r.symmetric_dirichlet.mean),
           fmt::format("{:.3f}", w.cpu_seconds),
           fmt::format("{} / {} / {} / {}", r.flipped, r.mirrored_charts, r.without_uv, r.overlapping_triangles),
           fmt::format("{:.2f}", w.fill)});
    }
    wholes[part.name] = tried.front();
    for (const PartPeer& peer : peers_of(part)) {
      table.rows.push_back({part.name, peer.peer, std::to_string(peer.charts), fmt::format("{:.2f}", peer.seam),
                            fmt::format("{:.4f}", peer.energy), fmt::format("{:.3f}", peer.cpu_seconds), "", ""});
      const std::string pair = part.name + " against " + peer.peer;
      if (!dominates(tried.front(), peer)) add_name(lost_by_default, pair);
      if (std::none_of(tried.begin(), tried.end(), [&](const Whole& w) { return dominates(w, peer); }))
        add_name(lost, pair);
      const double share = peer.cpu_seconds > k_big_s ? 0.1 : 1.0 / 3;
      if (peer.peer.starts_with("xatlas") && tried.front().cpu_seconds > share * peer.cpu_seconds) add_name(slow, pair);
    }
  }
  report.table(std::move(table));
  const auto on_every_part = [&](const std::string& promise, const std::string& exceptions) {
    report.target({promise, exceptions.empty() ? "on every part" : exceptions, exceptions.empty()});
  };
  on_every_part("F: no worse than each peer in charts, seam length and distortion at once, as it comes",
                lost_by_default);
  on_every_part("F: the same with one of the three seam costs", lost);
  on_every_part("F: CPU at most 1/3 of xatlas's on small parts, 1/10 on big ones", slow);
  report.target({"F: no flipped, mirrored, unmapped or overlapping triangle in the atlas",
                 clean ? "none" : "see the table", clean});
  report_chart_counts(wholes, report);
}

}  // namespace papilla::bench
