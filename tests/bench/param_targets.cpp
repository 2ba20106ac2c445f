// SPDX-License-Identifier: MIT
#include "bench/param_targets.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "papilla/core/error.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/best.hpp"
#include "papilla/param/components.hpp"
#include "papilla/param/reference_maps.hpp"
#include "support/formula_meshes.hpp"

namespace papilla::bench {

Flattening lscm_with(const TriangleMesh& mesh, LscmSolver solver) {
  LscmOptions options;
  options.solver = solver;
  return flatten_lscm(mesh, test::one_chart(mesh), options);
}

Flattening arap(const TriangleMesh& mesh) {
  ReferenceOptions options;
  options.map = ReferenceMap::arap;
  return flatten_reference(mesh, test::one_chart(mesh), options);
}

Flattening levy_conformal(const TriangleMesh& mesh) {
  LevyOptions options;
  options.length = 0;
  return flatten_levy(mesh, test::one_chart(mesh), options).flattening;
}

Flattening levy(const TriangleMesh& mesh) { return flatten_levy(mesh, test::one_chart(mesh)).flattening; }
Flattening levy_written(const TriangleMesh& mesh, LevyBorder border, LevySolver solver) {
  return flatten_levy(mesh, test::one_chart(mesh), levy_as_written(border, solver)).flattening;
}

Flattening maillot_written(const TriangleMesh& mesh, MaillotStart start) {
  return flatten_maillot(mesh, test::one_chart(mesh), maillot_as_written(start)).flattening;
}

Flattening maillot(const TriangleMesh& mesh) { return flatten_maillot(mesh, test::one_chart(mesh)).flattening; }
Flattening best(const TriangleMesh& mesh) { return flatten_best(mesh, test::one_chart(mesh)); }

Flattening lscm_hermitian(const TriangleMesh& mesh) { return lscm_with(mesh, LscmSolver::hermitian); }

const TriangleMesh& mesh_of(const std::vector<Disk>& all, const std::string& name) {
  return std::find_if(all.begin(), all.end(), [&](const Disk& d) { return d.name == name; })->mesh;
}

const Peer* Peers::find(const std::string& method, const std::string& name, const TriangleMesh& mesh) {
  const auto [place, is_new] = peers_.try_emplace({method, name});
  if (is_new) {
    const int repeats = mesh.triangles.size() < 50'000 ? 3 : 1;
    for (int i = 0; i < repeats; ++i)
      if (auto map = peer_map(method, mesh);
          map && (!place->second || map->cpu_seconds < place->second->map.cpu_seconds))
        place->second = Peer{std::move(*map), {}};
    if (place->second) place->second->report = measure_distortion(mesh, place->second->map.uv);
  }
  return place->second ? &*place->second : nullptr;
}

void cpu_target(const std::string& promise, const TriangleMesh& mesh, const MapMethod& map, const Peer* peer,
                double limit, double peer_share, BenchReport& report) {
  const double own = cpu_of(mesh.triangles.size() < 500'000 ? 3 : 1, [&] { map(mesh); });
  if (!peer) {
    report.target({promise, fmt::format("{:.4f} s; no peer program was given", own), {}});
    return;
  }
  const double theirs = peer->map.cpu_seconds, ratio = own / theirs;
  const std::string share = peer_share < 1 ? fmt::format("1/{:.1f}", theirs / own) : fmt::format("{:.3f}", ratio);
  report.target(
      {promise, fmt::format("{} ({:.4f} s against {:.4f} s)", share, own, theirs), ratio <= limit * peer_share});
}

namespace {

/// The largest part of a file, welded.
TriangleMesh part_of(const std::string& file) {
  Scene scene = read_scene(file);
  const auto largest = std::max_element(scene.parts.begin(), scene.parts.end(), [](const Part& a, const Part& b) {
    return a.mesh.triangles.size() < b.mesh.triangles.size();
  });
  if (largest == scene.parts.end()) throw InvalidInput(file + ": no part");
  return weld_equal(std::move(largest->mesh)).mesh;
}

}  // namespace

std::vector<NamedMesh> files_of(const BenchReport& report) {
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

void add_name(std::string& list, const std::string& name, const char* start) {
  list += (list.empty() ? start : ", ") + name;
}

}  // namespace papilla::bench
