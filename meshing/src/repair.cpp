// SPDX-License-Identifier: MIT
#include "papilla/meshing/repair.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "check_mesh.hpp"
#include "find_t_junctions.hpp"
#include "papilla/core/error.hpp"
#include "repair_steps.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Three times what counts as degenerate, so that writing single precision doesn't make a triangle degenerate again.
constexpr double k_repaired_altitude = 3e-7;

/// Wider than any noise of coordinates, narrower than the slots and panel gaps that designers draw.
constexpr double k_stitched_gap = 2e-4;

/// The state of a repair: the mesh, the table of its edges while that is valid, and what was done so far.
class Repair {
 public:
  Repair(TriangleMesh mesh, const RepairOptions& options) : options_(options) {
    all_.mesh = std::move(mesh);
    diagonal_ = bounding_diagonal(all_.mesh);
    all_.weld_tolerance_mm = options.weld_mm.value_or(WeldOptions{}.relative_tolerance * diagonal_);
    all_.stitch_tolerance_mm = options.stitch_mm.value_or(k_stitched_gap * diagonal_);
  }

  RepairResult run() {
    while (!all_.settled && all_.passes < options_.max_passes) {
      const RepairCounts before = all_.counts;
      clean();
      turn();
      part();
      close_gaps();
      ++all_.passes;
      all_.settled = !changed_surface(before, all_.counts) || is_clean();
      report(1);
    }
    move_to_end(all_.mesh, std::move(touching_));  // where another repair would put them
    drop_unused(all_.mesh);
    return std::move(all_);
  }

 private:
  const EdgeTable& edges() {
    if (!edges_) edges_.emplace(all_.mesh.triangles, all_.mesh.positions.size());
    return *edges_;
  }

  void forget_edges_if(bool changed) {
    if (changed) edges_.reset();
  }

  void report(double fraction) const {
    if (options_.progress) options_.progress("repair", fraction);
  }

  void note(double RepairDeviations::*operation, double deviation_mm) {
    all_.deviations.*operation = std::max(all_.deviations.*operation, deviation_mm);
    all_.max_deviation_mm += deviation_mm;
  }

  /// Splitting T-junctions can fold a border onto itself, and such doubles must go before edges are parted.
  void clean() {
    touching_.clear();
    const std::size_t merged = merge_equal(all_.mesh);
    all_.counts.welded_equal += merged;
    forget_edges_if(true);
    bool found_t_junctions = true;
    for (std::size_t round = 0; found_t_junctions && round < options_.max_passes; ++round) {
      weld_cracks();
      drop_doubles();
      drop_degenerate();
      found_t_junctions = close_t_junctions();
    }
    report(0.6);
  }

  void weld_cracks() {
    WeldResult step;
    forget_edges_if(weld_borders(all_.mesh, edges(), all_.weld_tolerance_mm, WeldOptions{}.feature_fraction, step));
    all_.counts.welded_near += step.merged_near;
    note(&RepairDeviations::weld, step.max_deviation_mm);
    report(0.2);
  }

  void drop_doubles() {
    DuplicateResult step;
    forget_edges_if(drop_duplicates(all_.mesh, edges(), step));
    all_.counts.duplicates += step.same;
    all_.counts.opposites += step.opposite;
    all_.counts.walls += step.walls;
    report(0.3);
  }

  void drop_degenerate() {
    DegenerateResult step;
    forget_edges_if(resolve_degenerate(all_.mesh, k_repaired_altitude * diagonal_, step));
    all_.counts.repeated_corners += step.repeated;
    all_.counts.collapsed_needles += step.collapsed;
    all_.counts.flipped_caps += step.flipped;
    all_.counts.pushed_apexes += step.pushed;
    note(&RepairDeviations::degenerate, step.max_deviation_mm);
    report(0.4);
  }

  bool close_t_junctions() {
    TJunctionResult step;
    const bool changed = split_borders(all_.mesh, edges(), TJunctionOptions{}.relative_tolerance * diagonal_, step);
    forget_edges_if(changed);
    all_.counts.t_junctions += step.inserted_vertices;
    all_.counts.border_slivers += step.slivers;
    note(&RepairDeviations::t_junctions, step.max_deviation_mm);
    report(0.5);
    return changed;
  }

  void turn() {
    OrientResult step;
    forget_edges_if(turn_over(all_.mesh, edges(), step));
    all_.counts.reversed += step.reversed;
    report(0.7);
  }

  /// Sheets that were linked may be closed once parted, or free to turn, which can leave new edges to part.
  void part() {
    for (std::size_t round = 0; round < options_.max_passes; ++round) {
      ManifoldResult step;
      forget_edges_if(part_sheets(all_.mesh, edges(), ManifoldOptions{}.relative_gap * diagonal_, step, touching_));
      all_.counts.parted_edges += step.parted_edges;
      all_.counts.added_vertices += step.added_vertices;
      note(&RepairDeviations::partings, step.max_deviation_mm);
      if (step.parted_edges == 0) break;
      turn();
      if (!has_bad_edges(all_.mesh.triangles, edges())) break;
    }
    report(0.8);
  }

  void close_gaps() {
    FillHolesResult step;
    forget_edges_if(
        fill_borders(all_.mesh, edges(),
                     {.max_slit_width_mm = all_.stitch_tolerance_mm, .max_diameter_mm = options_.fill_holes_mm}, step));
    all_.counts.stitched_gaps += step.slits;
    all_.counts.filled_holes += step.holes;
    all_.counts.added_triangles += step.triangles;
    note(&RepairDeviations::stitches, step.max_slit_width_mm);
    report(0.9);
  }

  /// Would another pass find nothing to do? Equal positions are those of fans that touch in a point, which it would
  /// join and part again.
  bool is_clean() {
    const TriangleMesh& mesh = all_.mesh;
    return !has_bad_edges(mesh.triangles, edges()) && !has_duplicates(mesh.triangles, edges()) &&
           !has_degenerate(mesh, k_repaired_altitude * diagonal_) &&
           !has_near_borders(mesh, edges(), all_.weld_tolerance_mm, WeldOptions{}.feature_fraction) &&
           find_t_junctions(mesh.positions, mesh.triangles, edges(), TJunctionOptions{}.relative_tolerance * diagonal_)
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

  const RepairOptions& options_;
  RepairResult all_;
  double diagonal_ = 0;
  std::optional<EdgeTable> edges_;
  std::vector<TouchingCopy> touching_;  ///< Of this pass.
};

void check_options(const RepairOptions& options) {
  if (options.max_passes == 0) throw InvalidInput("repair: max_passes 0 is less than 1");
  const auto require = [](double value, const char* name) {
    if (!(value >= 0 && std::isfinite(value)))
      throw InvalidInput(std::string("repair: ") + name + " " + std::to_string(value) + " is out of range");
  };
  require(options.weld_mm.value_or(0), "weld_mm");
  require(options.stitch_mm.value_or(0), "stitch_mm");
  require(options.fill_holes_mm, "fill_holes_mm");
}

}  // namespace

RepairResult repair(TriangleMesh mesh, const RepairOptions& options) {
  check_options(options);
  check_mesh(mesh, "repair");
  return Repair(std::move(mesh), options).run();
}

}  // namespace papilla
