// SPDX-License-Identifier: MIT
#include "papilla/meshing/repair.hpp"

#include <utility>

#include "mesh_attributes.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/degenerate.hpp"
#include "papilla/meshing/duplicate.hpp"
#include "papilla/meshing/manifold.hpp"
#include "papilla/meshing/orient.hpp"
#include "papilla/meshing/t_junction.hpp"
#include "papilla/meshing/weld.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Three times what counts as degenerate, so that writing single precision doesn't make a triangle degenerate again.
constexpr double k_repaired_altitude = 3e-7;

void weld_mesh(RepairResult& all, const RepairOptions& options) {
  WeldOptions weld_options;
  weld_options.tolerance_mm = options.weld_mm;
  WeldResult step = weld(std::move(all.mesh), weld_options);
  all.mesh = std::move(step.mesh);
  if (all.passes == 0) all.weld_tolerance_mm = step.tolerance_mm;
  all.counts.welded_equal += step.merged_equal;
  all.counts.welded_near += step.merged_near;
  all.max_deviation_mm += step.max_deviation_mm;
}

void drop_duplicates(RepairResult& all) {
  DuplicateResult step = remove_duplicates(std::move(all.mesh));
  all.mesh = std::move(step.mesh);
  all.counts.duplicates += step.same;
  all.counts.opposites += step.opposite;
  all.counts.walls += step.walls;
}

void drop_degenerate(RepairResult& all) {
  DegenerateOptions degenerate_options;
  degenerate_options.relative_altitude = k_repaired_altitude;
  DegenerateResult step = remove_degenerate(std::move(all.mesh), degenerate_options);
  all.mesh = std::move(step.mesh);
  all.counts.repeated_corners += step.repeated;
  all.counts.collapsed_needles += step.collapsed;
  all.counts.flipped_caps += step.flipped;
  all.max_deviation_mm += step.max_deviation_mm;
}

void close_t_junctions(RepairResult& all) {
  TJunctionResult step = split_t_junctions(std::move(all.mesh));
  all.mesh = std::move(step.mesh);
  all.counts.t_junctions += step.inserted_vertices;
  all.counts.border_slivers += step.slivers;
  all.max_deviation_mm += step.max_deviation_mm;
}

void turn(RepairResult& all) {
  OrientResult step = orient(std::move(all.mesh));
  all.mesh = std::move(step.mesh);
  all.counts.reversed += step.reversed;
}

void part_sheets(RepairResult& all) {
  ManifoldResult step = split_nonmanifold(std::move(all.mesh));
  all.mesh = std::move(step.mesh);
  all.counts.parted_edges += step.parted_edges;
  all.counts.added_vertices += step.added_vertices;
  all.max_deviation_mm += step.max_deviation_mm;
  if (step.parted_edges > 0) turn(all);  // sheets that were linked may now be closed, or free to turn
}

/// Welding equal positions, turning triangles over and giving fans that touch in a point their own vertices leave the
/// surface as it is, so they can't give another operation new work.
bool changed_surface(const RepairCounts& before, RepairCounts now) {
  now.welded_equal = before.welded_equal;
  now.reversed = before.reversed;
  now.added_vertices = before.added_vertices;
  return !(now == before);
}

}  // namespace

RepairResult repair(TriangleMesh mesh, const RepairOptions& options) {
  if (options.max_passes == 0) throw InvalidInput("repair: max_passes 0 is less than 1");
  RepairResult all;
  all.mesh = std::move(mesh);
  const auto step = [&](double fraction, auto&& operation) {
    operation();
    if (options.progress) options.progress("repair", fraction);
  };
  while (!all.settled && all.passes < options.max_passes) {
    const RepairCounts before = all.counts;
    step(0.3, [&] { weld_mesh(all, options); });
    step(0.4, [&] { drop_duplicates(all); });
    step(0.5, [&] { drop_degenerate(all); });
    step(0.6, [&] { close_t_junctions(all); });
    step(0.8, [&] { turn(all); });
    step(1.0, [&] { part_sheets(all); });
    all.settled = !changed_surface(before, all.counts);
    ++all.passes;
  }
  drop_unused(all.mesh);
  return all;
}

}  // namespace papilla
