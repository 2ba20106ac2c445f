// SPDX-License-Identifier: MIT
#include "papilla/meshing/repair.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "check_mesh.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/core/union_find.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/meshing/mesh_bounds.hpp"
#include "repair_steps.hpp"
#include "scramble.hpp"
#include "surface_change.hpp"
#include "triangle_shape.hpp"

namespace papilla {
namespace {

using namespace detail;

/// Wider than any noise of coordinates, narrower than the slots and panel gaps that designers draw.
constexpr double k_stitched_gap = 2e-4;

/// A measured distance exceeds the true one by a hundredth at most.
constexpr double k_measured_within = 1.01;

/// Distances below this share of the tolerance need not be told apart.
constexpr double k_told_apart = 0.02;

/// Beyond, distances overflow the trees they are measured with [mm].
constexpr double k_farthest_measured = 1e15;

/// The fewest triangles that a closed surface has.
constexpr std::size_t k_least_solid = 4;

/// Triangles connected through shared vertices.
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

/// The box around some triangles of a mesh.
Bounds3 bounds_of(const TriangleMesh& mesh, std::span<const Index> triangles) {
  Bounds3 bounds;
  for (const Index t : triangles)
    for (const Index v : mesh.triangles[t]) bounds.add(mesh.positions[v]);
  return bounds;
}

/// Splits boxes into sets so that no box, grown by `margin`, overlaps one of another set. Where that would be more than
/// `k_most_sets`, sets that lie apart are joined, too. Returns the numbers that came with the boxes. O(n) for n boxes.
std::vector<std::vector<std::size_t>> parted_by_boxes(const std::vector<std::pair<std::size_t, Bounds3>>& boxes,
                                                      double margin) {
  constexpr std::size_t k_most_sets = 256;  // as each box is compared with that of each set
  struct Set {
    std::vector<std::size_t> members;
    Bounds3 bounds;
    void take(const Set& other) {
      members.insert(members.end(), other.members.begin(), other.members.end());
      bounds.add(other.bounds);
    }
  };
  std::vector<Set> sets;
  for (const auto& [number, bounds] : boxes) {
    Set grown{{number}, bounds};
    const auto is_near = [&](const Set& s) {
      return sets.size() > k_most_sets || s.bounds.overlaps(grown.bounds, margin);
    };
    for (auto near = std::find_if(sets.begin(), sets.end(), is_near); near != sets.end();
         near = std::find_if(sets.begin(), sets.end(), is_near)) {
      if (near->members.size() > grown.members.size()) std::swap(*near, grown);
      grown.take(*near);
      sets.erase(near);
    }
    sets.push_back(std::move(grown));
  }
  std::vector<std::vector<std::size_t>> members;
  for (Set& set : sets) members.push_back(std::move(set.members));
  return members;
}

RepairCounts operator+(RepairCounts a, const RepairCounts& b) {
  for (const auto& [name, count] : k_repair_counts) a.*count += b.*count;
  return a;
}

/// Adds what was done to a piece, or a part, that has nothing to do with the others.
void add(RepairResult& all, const RepairResult& piece) {
  all.counts = all.counts + piece.counts;
  for (double RepairDeviations::*operation :
       {&RepairDeviations::weld, &RepairDeviations::degenerate, &RepairDeviations::t_junctions,
        &RepairDeviations::partings, &RepairDeviations::stitches})
    all.deviations.*operation = std::max(all.deviations.*operation, piece.deviations.*operation);
  for (double RepairResult::*distance :
       {&RepairResult::weld_tolerance_mm, &RepairResult::stitch_tolerance_mm, &RepairResult::tolerance_mm,
        &RepairResult::max_deviation_mm, &RepairResult::lost_mm, &RepairResult::added_mm, &RepairResult::refused_mm})
    all.*distance = std::max(all.*distance, piece.*distance);
  all.sampled = all.sampled || piece.sampled;
  all.refused_triangles += piece.refused_triangles;
  all.unfinished_triangles += piece.unfinished_triangles;
  all.two_sided.insert(piece.two_sided.begin(), piece.two_sided.end());
  all.passes = std::max(all.passes, piece.passes);
  all.settled = all.settled && piece.settled;
}

/// Can what was done have changed the shape of the surface?
bool changes_shape(RepairCounts counts) {
  counts.welded_equal = counts.reversed = counts.added_vertices = 0;
  return !(counts == RepairCounts{});
}

/// The places of numbers in ascending order, equal ones in their own.
std::vector<Index> order_of(std::span<const std::uint32_t> numbers) {
  if (numbers.empty()) return {};
  std::vector<Index> begin(*std::max_element(numbers.begin(), numbers.end()) + std::size_t{2}, 0);
  for (const std::uint32_t number : numbers) ++begin[number + std::size_t{1}];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Index> order(numbers.size());
  for (Index i = 0; i < numbers.size(); ++i) order[begin[numbers[i]]++] = i;
  return order;
}

/// True when each edge is run as often one way as the other, as on a closed surface of one orientation; else only by
/// chance. Reads the triangles once, where a table of the edges would look up every vertex.
bool edges_cancel(std::span<const Triangle> all, std::span<const Index> triangles) {
  std::uint64_t sum = 0;
  for (const Index t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = all[t][k], to = all[t][next_corner(k)];
      if (from == to) continue;
      const auto [low, high] = std::minmax(from, to);
      const std::uint64_t edge = scramble(scramble(std::uint64_t{high} << 32 | low));
      sum += from < to ? edge : -edge;
    }
  return sum == 0;
}

/// Repairs what does not depend on each other one by one, in caches and in parallel: closed solids, and then sets of
/// surfaces with borders, or inside out, that lie apart.
class SoupRepair {
 public:
  SoupRepair(TriangleMesh mesh, const RepairScale& scale, const Deadline& deadline, const ProgressCallback& progress)
      : mesh_(std::move(mesh)),
        scale_(scale),
        deadline_(deadline),
        margin_(scale.weld.tolerance_mm + scale.stitch_mm),
        progress_(progress, "repair", static_cast<double>(mesh_.triangles.size())),
        components_(connected_triangles(mesh_)) {}

  RepairResult run() {
    repair_solids();
    repair_others();
    RepairResult all;
    all.settled = true;
    for (const auto& piece : pieces_)
      if (piece) add(all, *piece);
    all.mesh = all.counts == RepairCounts{} ? std::move(mesh_) : put_together();
    return all;
  }

 private:
  struct OutOfTime {};

  /// Triangles of the mesh on their own; `face` says which.
  TriangleMesh piece(std::span<const Index> triangles) const {
    TriangleMesh result = extract_triangles(mesh_, triangles);
    result.face.assign(triangles.begin(), triangles.end());
    return result;
  }

  void repair_solids() {
    pieces_.resize(components_.size());
    oneapi::tbb::parallel_for(std::size_t{0}, components_.size(), [&](std::size_t c) {
      const auto triangles = components_.of(c);
      if (deadline_.passed() || triangles.size() < k_least_solid || !edges_cancel(mesh_.triangles, triangles)) return;
      pieces_[c] = repair_solid(piece(triangles), scale_);
      if (pieces_[c]) measure(triangles, *pieces_[c]);
      if (pieces_[c]) progress_.add(static_cast<double>(triangles.size()));
    });
  }

  /// Those without a result so far, and solids around one of them: what is inside out may be a cavity.
  std::vector<std::pair<std::size_t, Bounds3>> others() {
    std::vector<std::pair<std::size_t, Bounds3>> result;
    for (std::size_t c = 0; c < components_.size(); ++c)
      if (!pieces_[c]) result.emplace_back(c, bounds_of(mesh_, components_.of(c)));
    const std::size_t open = result.size();
    for (std::size_t c = 0; c < components_.size() && open > 0; ++c) {
      if (!pieces_[c]) continue;
      const Bounds3 solid = bounds_of(mesh_, components_.of(c));
      if (std::none_of(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(open),
                       [&](const auto& other) { return solid.contains(other.second, -margin_); }))
        continue;
      result.emplace_back(c, solid);
      pieces_[c].reset();
    }
    return result;
  }

  /// For a piece that reports fractions of itself, several times where it takes several passes.
  /// Throws OutOfTime.
  ProgressCallback progress_of_piece(std::size_t triangles) {
    return [this, size = static_cast<double>(triangles), reported = 0.0](const Progress& piece) mutable {
      if (deadline_.passed()) throw OutOfTime{};
      progress_.add((piece.fraction - reported) * size);
      reported = std::max(reported, piece.fraction);
      return true;
    };
  }

  void repair_others() {
    const std::vector<std::vector<Index>> sets = triangles_of_sets(parted_by_boxes(others(), margin_));
    const std::size_t before = pieces_.size();
    pieces_.resize(before + sets.size());
    oneapi::tbb::parallel_for(std::size_t{0}, sets.size(), [&](std::size_t s) {
      pieces_[before + s] = std::make_unique<RepairResult>();
      RepairResult& result = *pieces_[before + s];
      try {
        if (deadline_.passed()) throw OutOfTime{};
        result = repair_piece(piece(sets[s]), scale_, progress_of_piece(sets[s].size()));
        measure(sets[s], result);
      } catch (const OutOfTime&) {
        result = {};
        result.mesh = piece(sets[s]);
        result.unfinished_triangles = sets[s].size();
      }
    });
  }

  /// Measures how far a piece moved; one that moved too far becomes again what it was.
  void measure(std::span<const Index> triangles, RepairResult& result) const {
    if (!changes_shape(result.counts)) return;
    if (scale_.reference_mm > k_farthest_measured) {
      result.lost_mm = result.added_mm = result.max_deviation_mm;
      return;
    }
    const SurfaceChange change = surface_change(
        mesh_, triangles, result.mesh,
        {.least_altitude_mm = (k_touching_distance + 2 * k_rounding_distance) * scale_.reference_mm,
         .reach_mm = scale_.tolerance_mm,
         .floor_mm = std::max(k_told_apart * scale_.tolerance_mm, 4 * k_touching_distance * scale_.reference_mm),
         .sample_above = scale_.sample_above});
    result.sampled = change.sampled;
    result.lost_mm = change.lost_mm;
    result.added_mm = change.added_mm;
    const double allowed = k_measured_within * scale_.tolerance_mm;
    if (change.lost_mm <= allowed && change.added_mm <= std::max(allowed, scale_.fill_holes_mm)) return;
    RepairResult refused;
    refused.mesh = piece(triangles);
    refused.refused_triangles = triangles.size();
    refused.refused_mm = std::max(change.lost_mm, change.added_mm);
    refused.sampled = change.sampled;
    refused.passes = result.passes;
    refused.settled = true;
    result = std::move(refused);
  }

  /// The triangles of sets of components, ascending within each set.
  std::vector<std::vector<Index>> triangles_of_sets(const std::vector<std::vector<std::size_t>>& sets) const {
    std::vector<Index> set_of(mesh_.triangles.size(), k_none);
    for (std::size_t s = 0; s < sets.size(); ++s)
      for (const std::size_t c : sets[s])
        for (const Index t : components_.of(c)) set_of[t] = static_cast<Index>(s);
    std::vector<std::vector<Index>> triangles(sets.size());
    for (Index t = 0; t < set_of.size(); ++t)
      if (set_of[t] != k_none) triangles[set_of[t]].push_back(t);
    return triangles;
  }

  /// All triangles in the order of those they come from.
  TriangleMesh put_together() {
    const Values<std::uint32_t> face = std::move(mesh_.face);
    mesh_ = {};
    TriangleMesh all;
    for (auto& piece : pieces_) {
      if (piece) append_mesh(all, piece->mesh);
      piece.reset();
    }
    TriangleMesh result = extract_triangles(all, order_of(all.face));
    if (face.empty()) result.face.clear();
    for (std::uint32_t& f : result.face) f = face[f];
    return result;
  }

  TriangleMesh mesh_;
  const RepairScale& scale_;
  Deadline deadline_;
  double margin_;  ///< Boxes that lie further apart have nothing to do with each other.
  SharedProgress progress_;
  Components components_;
  std::vector<std::unique_ptr<RepairResult>> pieces_;  ///< Per component, then per set of others; null where in none.
};

void check_options(const RepairOptions& options) {
  if (options.max_passes == 0) throw InvalidInput("repair: max_passes 0 is less than 1");
  const auto require = [](double value, const char* name) {
    if (!(value >= 0 && std::isfinite(value)))
      throw InvalidInput(std::string("repair: ") + name + " " + std::to_string(value) + " is out of range");
  };
  require(options.weld_mm.value_or(0), "weld_mm");
  require(options.stitch_mm.value_or(0), "stitch_mm");
  require(options.tolerance_mm.value_or(0), "tolerance_mm");
  require(options.fill_holes_mm, "fill_holes_mm");
}

RepairScale scale_of(const TriangleMesh& mesh, const RepairOptions& options) {
  const Bounds3 bounds = bounds_of(mesh);
  const double reference = reference_length(bounds);
  const WeldOptions weld;
  const double weld_mm = options.weld_mm.value_or(weld.relative_tolerance * reference);
  const double gap_mm = k_stitched_gap * bounds.diagonal(), stitch_mm = options.stitch_mm.value_or(gap_mm);
  return {
      .reference_mm = reference,
      .weld = {weld_mm, weld.feature_fraction, k_degenerate_altitude * reference},
      .stitch_mm = stitch_mm,
      .fill_holes_mm = options.fill_holes_mm,
      .tolerance_mm = options.tolerance_mm.value_or(weld_mm + std::max(stitch_mm, gap_mm) +
                                                    k_most_parting_steps * ManifoldOptions{}.relative_gap * reference),
      .max_passes = options.max_passes,
      .sample_above = options.sample_above};
}

}  // namespace

RepairResult repair(TriangleMesh mesh, const RepairOptions& options) {
  check_options(options);
  check_mesh(mesh, "repair");
  const RepairScale scale = scale_of(mesh, options);
  std::size_t merged = merge_equal(mesh);
  double rounding_mm = 0;
  merged += merge_stored_equal(mesh, rounding_mm);
  RepairResult result = SoupRepair(std::move(mesh), scale, options.deadline, options.progress).run();
  result.counts.welded_equal += merged;
  result.deviations.weld = std::max(result.deviations.weld, rounding_mm);
  for (double RepairResult::*distance :
       {&RepairResult::max_deviation_mm, &RepairResult::lost_mm, &RepairResult::added_mm})
    result.*distance += rounding_mm;
  result.weld_tolerance_mm = scale.weld.tolerance_mm;
  result.stitch_tolerance_mm = scale.stitch_mm;
  result.tolerance_mm = scale.tolerance_mm;
  return result;
}

RepairResult total_repair(std::span<const RepairResult> results) {
  RepairResult total;
  total.settled = true;
  for (const RepairResult& result : results) add(total, result);
  return total;
}

}  // namespace papilla
