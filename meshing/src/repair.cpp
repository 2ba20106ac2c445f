// SPDX-License-Identifier: MIT
#include "papilla/meshing/repair.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "bounds.hpp"
#include "check_mesh.hpp"
#include "papilla/core/error.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "repair_piece.hpp"
#include "triangle_shape.hpp"
#include "union_find.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Wider than any noise of coordinates, narrower than the slots and panel gaps that designers draw.
constexpr double k_stitched_gap = 2e-4;

/// The fewest triangles that a closed surface has.
constexpr std::size_t k_least_solid = 4;

RepairCounts operator+(RepairCounts a, const RepairCounts& b) {
  for (std::size_t RepairCounts::*count :
       {&RepairCounts::welded_equal, &RepairCounts::welded_near, &RepairCounts::repeated_corners,
        &RepairCounts::collapsed_needles, &RepairCounts::flipped_caps, &RepairCounts::pushed_apexes,
        &RepairCounts::duplicates, &RepairCounts::opposites, &RepairCounts::walls, &RepairCounts::t_junctions,
        &RepairCounts::border_slivers, &RepairCounts::reversed, &RepairCounts::parted_edges,
        &RepairCounts::added_vertices, &RepairCounts::stitched_gaps, &RepairCounts::filled_holes,
        &RepairCounts::added_triangles})
    a.*count += b.*count;
  return a;
}

/// Adds what was done to a piece that has nothing to do with the others.
void add(RepairResult& all, const RepairResult& piece) {
  all.counts = all.counts + piece.counts;
  for (double RepairDeviations::*operation :
       {&RepairDeviations::weld, &RepairDeviations::degenerate, &RepairDeviations::t_junctions,
        &RepairDeviations::partings, &RepairDeviations::stitches})
    all.deviations.*operation = std::max(all.deviations.*operation, piece.deviations.*operation);
  all.max_deviation_mm = std::max(all.max_deviation_mm, piece.max_deviation_mm);
  all.passes = std::max(all.passes, piece.passes);
  all.settled = all.settled && piece.settled;
}

/// Triangles that hang together by vertices.
struct Components {
  std::vector<Index> begin;      ///< Of each one in `triangles`, and the end of the last.
  std::vector<Index> triangles;  ///< Ascending within each; components in the order of their smallest vertices.

  std::size_t size() const noexcept { return begin.size() - 1; }
  std::span<const Index> of(std::size_t c) const noexcept {
    return std::span(triangles).subspan(begin[c], begin[c + 1] - begin[c]);
  }
};

Components connected_triangles(const TriangleMesh& mesh) {
  UnionFind sets(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  Index count = 0;
  const std::vector<Index> label = sets.labels(count);
  Components result;
  result.begin.assign(count + 1, 0);
  for (const Triangle& t : mesh.triangles) ++result.begin[label[t[0]] + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  std::vector<Index> next(result.begin.begin(), result.begin.end() - 1);
  result.triangles.resize(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) result.triangles[next[label[mesh.triangles[t][0]]]++] = t;
  return result;
}

Bounds bounds_of(const TriangleMesh& mesh, std::span<const Index> triangles) {
  Bounds bounds;
  for (const Index t : triangles)
    for (const Index v : mesh.triangles[t]) bounds.add(mesh.positions[v]);
  return bounds;
}

/// Tells the caller how many triangles are done, one call at a time.
class SharedProgress {
 public:
  SharedProgress(const Progress& progress, std::size_t all) : progress_(progress), all_(static_cast<double>(all)) {}

  void done(std::size_t triangles) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    done_ += static_cast<double>(triangles);
    progress_("repair", done_ / all_);
  }

  /// For the last piece, which tells fractions of itself.
  Progress rest() const {
    if (!progress_) return {};
    return [this](std::string_view stage, double fraction) {
      progress_(stage, (done_ + fraction * (all_ - done_)) / all_);
    };
  }

 private:
  const Progress& progress_;
  double all_, done_ = 0;
  std::mutex mutex_;
};

/// Repairs solids one by one, in caches and in parallel, and then everything else at once: only surfaces with borders,
/// or inside out, depend on what lies around them.
class SoupRepair {
 public:
  SoupRepair(TriangleMesh mesh, const RepairScale& scale, const Progress& progress)
      : mesh_(std::move(mesh)), scale_(scale), progress_(progress, mesh_.triangles.size()) {}

  RepairResult run() {
    components_ = connected_triangles(mesh_);
    solids_.resize(components_.size());
    oneapi::tbb::parallel_for(std::size_t{0}, components_.size(), [&](std::size_t c) {
      const auto triangles = components_.of(c);
      if (triangles.size() < k_least_solid) return;
      solids_[c] = repair_solid(piece(triangles), scale_);
      if (solids_[c]) progress_.done(triangles.size());
    });
    return_shells_around_others();
    RepairResult all;
    all.settled = true;
    for (const auto& solid : solids_)
      if (solid) add(all, *solid);
    RepairResult rest = repair_rest();
    add(all, rest);
    all.mesh = all.counts == RepairCounts{} ? std::move(mesh_) : put_together(std::move(rest.mesh));
    return all;
  }

 private:
  /// Triangles of the mesh on their own; `face` says which.
  TriangleMesh piece(std::span<const Index> triangles) const {
    TriangleMesh result = extract_triangles(mesh_, triangles);
    result.face.assign(triangles.begin(), triangles.end());
    return result;
  }

  /// A surface that is inside out may be meant so when it lies in a solid: such solids are repaired together with it.
  void return_shells_around_others() {
    std::vector<Bounds> others;
    for (std::size_t c = 0; c < components_.size(); ++c)
      if (!solids_[c]) others.push_back(bounds_of(mesh_, components_.of(c)));
    for (std::size_t c = 0; c < components_.size(); ++c) {
      if (!solids_[c]) continue;
      const Bounds solid = bounds_of(mesh_, components_.of(c));
      const double margin = -(scale_.weld.tolerance_mm + scale_.stitch_mm);
      if (std::any_of(others.begin(), others.end(), [&](const Bounds& b) { return solid.contains(b, margin); }))
        solids_[c].reset();
    }
  }

  RepairResult repair_rest() {
    std::vector<Index> rest;
    for (std::size_t c = 0; c < components_.size(); ++c)
      if (!solids_[c]) rest.insert(rest.end(), components_.of(c).begin(), components_.of(c).end());
    std::sort(rest.begin(), rest.end());
    return repair_piece(piece(rest), scale_, progress_.rest());
  }

  /// All triangles in the order of those they come from.
  TriangleMesh put_together(TriangleMesh all) {
    for (auto& solid : solids_) {
      if (!solid) continue;
      append_mesh(all, solid->mesh);
      solid->mesh = {};
    }
    std::vector<Index> order(all.triangles.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return all.face[a] < all.face[b]; });
    TriangleMesh result = extract_triangles(all, order);
    if (mesh_.face.empty())
      result.face.clear();
    else
      for (std::uint32_t& face : result.face) face = mesh_.face[face];
    return result;
  }

  TriangleMesh mesh_;
  const RepairScale& scale_;
  SharedProgress progress_;
  Components components_;
  std::vector<std::unique_ptr<RepairResult>> solids_;  ///< Per component; null for the rest.
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

RepairScale scale_of(const TriangleMesh& mesh, const RepairOptions& options) {
  const double diagonal = bounding_diagonal(mesh);
  const WeldOptions weld;
  return {.diagonal_mm = diagonal,
          .weld = {options.weld_mm.value_or(weld.relative_tolerance * diagonal), weld.feature_fraction,
                   k_degenerate_altitude * diagonal},
          .stitch_mm = options.stitch_mm.value_or(k_stitched_gap * diagonal),
          .fill_holes_mm = options.fill_holes_mm,
          .max_passes = options.max_passes};
}

}  // namespace

RepairResult repair(TriangleMesh mesh, const RepairOptions& options) {
  check_options(options);
  check_mesh(mesh, "repair");
  const RepairScale scale = scale_of(mesh, options);
  const std::size_t merged = merge_equal(mesh);
  RepairResult result = SoupRepair(std::move(mesh), scale, options.progress).run();
  result.counts.welded_equal += merged;
  result.weld_tolerance_mm = scale.weld.tolerance_mm;
  result.stitch_tolerance_mm = scale.stitch_mm;
  return result;
}

}  // namespace papilla
