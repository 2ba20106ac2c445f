// SPDX-License-Identifier: MIT
#include "repair_steps.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "find_t_junctions.hpp"
#include "triangle_shape.hpp"

namespace papilla::detail {
namespace {

/// The state of a repair: the mesh, the table of its edges while that is valid, and what was done so far.
class Repair {
 public:
  Repair(TriangleMesh mesh, const RepairScale& scale, ProgressCallback progress)
      : scale_(scale), progress_(std::move(progress)) {
    all_.mesh = std::move(mesh);
  }

  void run() {
    while (!all_.settled && all_.passes < scale_.max_passes) {
      const RepairCounts before = all_.counts;
      if (all_.passes > 0) join_touching();
      clean();
      report(0.6);
      turn();
      report(0.7);
      part();
      report(0.8);
      close_gaps();
      ++all_.passes;
      all_.settled = !changed_surface(before, all_.counts) || is_clean();
    }
    report(1);
  }

  RepairResult take() {
    drop_unused(all_.mesh);
    return std::move(all_);
  }

  bool is_closed() { return edges().boundary_halfedges().empty(); }

  /// Every edge has two triangles that run it in opposite senses and are not each other's back.
  bool is_closed_and_consistent() {
    const Values<Triangle>& triangles = all_.mesh.triangles;
    if (has_bad_edges(triangles, edges()) || has_duplicates(triangles, edges())) return false;
    for (std::size_t e = 0; e < edges().size(); ++e)
      if (edges().halfedges(e).size() != 2) return false;
    return true;
  }

 private:
  const EdgeTable& edges() {
    if (!edges_) edges_.emplace(all_.mesh.triangles, all_.mesh.positions.size());
    return *edges_;
  }

  void forget_edges_if(bool changed) {
    if (changed) edges_.reset();
  }

  /// How near to an edge a vertex makes a T-junction, also after both are rounded, and how far from the edge's ends.
  double t_junction_reach_mm() const { return (k_touching_distance + 2 * k_rounding_distance) * scale_.reference_mm; }
  double t_junction_from_ends_mm() const { return 2 * k_touching_distance * scale_.reference_mm; }

  void report(double fraction) const { report_progress(progress_, "repair", fraction); }

  void note(double RepairDeviations::*operation, double deviation_mm) {
    all_.deviations.*operation = std::max(all_.deviations.*operation, deviation_mm);
    all_.max_deviation_mm += deviation_mm;
  }

  /// Fans that the pass before parted from others they touch in a point.
  void join_touching() {
    const std::size_t merged = merge_equal(all_.mesh);
    all_.counts.welded_equal += merged;
    forget_edges_if(merged > 0);
  }

  /// Splitting T-junctions can fold a border onto itself, and such doubles must go before edges are parted.
  void clean() {
    bool found_t_junctions = true;
    for (std::size_t round = 0; found_t_junctions && round < scale_.max_passes; ++round) {
      weld_cracks();
      report(0.1);
      drop_doubles();
      report(0.2);
      drop_degenerate();
      report(0.4);
      found_t_junctions = close_t_junctions();
    }
    all_.counts.kept_walls += kept_walls_;
    all_.counts.kept_backs += kept_backs_;
  }

  void weld_cracks() {
    WeldResult step;
    forget_edges_if(weld_borders(all_.mesh, edges(), scale_.weld, step));
    all_.counts.welded_near += step.merged_near;
    all_.counts.repeated_corners += step.repeated;
    note(&RepairDeviations::weld, step.max_deviation_mm);
  }

  void drop_doubles() {
    DuplicateResult step;
    drop_doubles(Backs::keep_seen, step);
    kept_walls_ = step.kept_walls;
    kept_backs_ = step.kept_backs;
  }

  void drop_doubles(Backs backs, DuplicateResult& step) {
    forget_edges_if(drop_duplicates(all_.mesh, edges(), backs, step));
    all_.counts.duplicates += step.same;
    all_.counts.opposites += step.opposite;
    all_.two_sided.merge(step.two_sided);
  }

  void drop_degenerate() {
    DegenerateResult step;
    forget_edges_if(resolve_degenerate(all_.mesh, k_sought_altitude * scale_.reference_mm,
                                       k_repaired_altitude * scale_.reference_mm, step));
    all_.counts.repeated_corners += step.repeated;
    all_.counts.collapsed_needles += step.collapsed;
    all_.counts.flipped_caps += step.flipped;
    all_.counts.pushed_apexes += step.pushed;
    note(&RepairDeviations::degenerate, step.max_deviation_mm);
  }

  bool close_t_junctions() {
    TJunctionResult step;
    const bool changed = split_borders(all_.mesh, edges(), t_junction_reach_mm(), t_junction_from_ends_mm(), step);
    forget_edges_if(changed);
    all_.counts.t_junctions += step.inserted_vertices;
    all_.counts.border_slivers += step.slivers;
    all_.counts.repeated_corners += step.repeated;
    note(&RepairDeviations::t_junctions, step.max_deviation_mm);
    return changed;
  }

  void turn() {
    OrientResult step;
    forget_edges_if(turn_over(all_.mesh, edges(), step));
    all_.counts.reversed += step.reversed;
  }

  /// Sheets that were linked may be closed once parted, or free to turn, which can leave new edges to part.
  void part() {
    for (std::size_t round = 0; round < scale_.max_passes; ++round) {
      ManifoldResult step;
      forget_edges_if(part_sheets(all_.mesh, edges(), ManifoldOptions{}.relative_gap * scale_.reference_mm, step));
      all_.counts.parted_edges += step.parted_edges;
      all_.counts.added_vertices += step.added_vertices;
      note(&RepairDeviations::partings, step.max_deviation_mm);
      if (step.parted_edges == 0) break;
      turn();
      if (!has_bad_edges(all_.mesh.triangles, edges())) break;
    }
    if (kept_walls_ + kept_backs_ == 0) return;
    DuplicateResult step;  // a triangle that hangs together with its back around all three corners can't be parted
    drop_doubles(Backs::drop, step);
  }

  void close_gaps() {
    FillHolesResult step;
    forget_edges_if(fill_borders(
        all_.mesh, edges(), {.max_slit_width_mm = scale_.stitch_mm, .max_diameter_mm = scale_.fill_holes_mm}, step));
    all_.counts.stitched_gaps += step.slits;
    all_.counts.filled_holes += step.holes;
    all_.counts.added_triangles += step.triangles;
    note(&RepairDeviations::stitches, step.max_slit_width_mm);
  }

  /// Would another pass find nothing to do? Equal positions are those of fans that touch in a point, which it would
  /// join and part again.
  bool is_clean() {
    const TriangleMesh& mesh = all_.mesh;
    return !has_bad_edges(mesh.triangles, edges()) && !has_duplicates(mesh.triangles, edges()) &&
           !has_degenerate(mesh, k_sought_altitude * scale_.reference_mm) &&
           !has_near_borders(mesh, edges(), scale_.weld) &&
           find_t_junctions(mesh.positions, mesh.triangles, edges(), t_junction_reach_mm(), t_junction_from_ends_mm())
               .empty();
  }

  /// Welding equal positions, turning triangles over and giving fans that touch in a point their own vertices leave
  /// the surface as it is, so they can't give another operation new work.
  static bool changed_surface(const RepairCounts& before, RepairCounts now) {
    now.welded_equal = before.welded_equal;
    now.reversed = before.reversed;
    now.added_vertices = before.added_vertices;
    return !(now == before);
  }

  const RepairScale& scale_;
  ProgressCallback progress_;
  RepairResult all_;
  std::optional<EdgeTable> edges_;
  std::size_t kept_walls_ = 0, kept_backs_ = 0;  ///< Of this pass.
};

double enclosed_volume(const TriangleMesh& mesh) {
  const Vec3 origin = mesh.corner(0, 0);
  double volume = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    volume += dot(mesh.corner(t, 0) - origin, cross(mesh.corner(t, 1) - origin, mesh.corner(t, 2) - origin)) / 6;
  return volume;
}

}  // namespace

RepairResult repair_piece(TriangleMesh mesh, const RepairScale& scale, ProgressCallback progress) {
  Repair repair(std::move(mesh), scale, std::move(progress));
  repair.run();
  return repair.take();
}

std::unique_ptr<RepairResult> repair_solid(const TriangleMesh& mesh, const RepairScale& scale) {
  if (mesh.triangles.empty() || !(enclosed_volume(mesh) > 0)) return nullptr;
  Repair repair(mesh, scale, {});
  if (!repair.is_closed_and_consistent()) return nullptr;
  repair.run();
  if (!repair.is_closed()) return nullptr;
  return std::make_unique<RepairResult>(repair.take());
}

}  // namespace papilla::detail
