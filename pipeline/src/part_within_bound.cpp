// SPDX-License-Identifier: MIT
#include "part_within_bound.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "papilla/meshing/coarsen.hpp"
#include "part_charts.hpp"

namespace papilla::detail {
namespace {

/// Of maps under a bound at most, unless another is given, over what it leaves of D - 4: what an iteration still gains
/// is seam that is not needed.
constexpr double k_tolerance = 0.01, k_least_tolerance = 1e-5;

/// A mesh is made coarser where that leaves at most this part of its triangles; where several are made, each has so
/// many times the triangles of the next.
constexpr double k_worth_coarsening = 2.0 / 3;
constexpr std::size_t k_level_growth = 12;

/// Triangles of the coarsest mesh of each attempt; none: seams are sought on the whole mesh.
std::vector<std::size_t> coarsest_triangles(UnwrapEffort effort) {
  switch (effort) {
    case UnwrapEffort::fast: return {800, 2200};
    case UnwrapEffort::normal: return {2200};
    case UnwrapEffort::best: break;
  }
  return {};
}

/// Of a mesh, the coarsest last.
std::vector<std::size_t> level_triangles(std::size_t triangles, std::size_t coarsest) {
  std::vector<std::size_t> levels;
  if (static_cast<double>(coarsest) > k_worth_coarsening * static_cast<double>(triangles)) return {};
  for (std::size_t count = coarsest; count == coarsest || k_level_growth * count <= 2 * triangles;
       count *= k_level_growth)
    levels.push_back(count);
  std::reverse(levels.begin(), levels.end());
  return levels;
}

struct Level {
  CoarseMesh coarse;
  PartMemory memory;
  std::optional<CoarseSurface> surface;
};

/// Makes tools for meshes of one part.
class BoundTools {
 public:
  BoundTools(const MethodOptions& o, const PartContext& context, FlattenedPart& part)
      : options_(o), context_(context), part_(part) {
    options_.progress = options_.best.progress = options_.automatic.best.progress = {};
    options_.segmentation.common_price = true;
    for (BestOptions* best : {&options_.best, &options_.automatic.best}) {
      best->energy_limit = std::numeric_limits<double>::infinity();
      if (!o.tolerance)
        best->tolerance =
            std::min(best->tolerance, std::max(k_least_tolerance, k_tolerance * (o.max_distortion->most - 4)));
    }
  }

  /// @param mesh, memory have to outlive the tools.
  SeamTools of(const TriangleMesh& mesh, PartMemory& memory) {
    SeamTools tools;
    tools.chart = [&](double seam_cost, bool feature_seams) {
      options_.segmentation.feature_seams = feature_seams;
      options_.segmentation.seam_cost = seam_cost;
      return charted(chart_and_map(mesh, options_, context_, memory, part_));
    };
    tools.map = [&](const ChartSet& charts, double most_excess_mm2, const CornerAttribute<Vec2>* nearby) {
      part_.choices.clear();
      MethodOptions tried = options_;
      tried.best.give_up_excess_mm2 = tried.automatic.best.give_up_excess_mm2 = most_excess_mm2;
      tried.best.nearby = tried.automatic.best.nearby = nearby;
      return charted(map_or_halve(mesh, charts, std::move(tried), 0, memory, part_.choices));
    };
    tools.halve = [&](const ChartSet& charts, std::span<const std::uint32_t> numbers) {
      if (!memory.halver) memory.halver.emplace(mesh);
      return memory.halver->halve(charts, numbers);
    };
    if (!memory.segmenter) memory.segmenter.emplace(mesh);
    tools.seam_costs = memory.segmenter->seam_costs(options_.segmentation);
    tools.brief = options_.effort == UnwrapEffort::fast;
    return tools;
  }

 private:
  ChartedMap charted(Flattening flattening) { return {std::move(flattening), std::move(part_.choices)}; }

  MethodOptions options_;
  const PartContext& context_;
  FlattenedPart& part_;
};

/// Coarse meshes of a part, made when they are asked for.
class CoarseSurfaces {
 public:
  CoarseSurfaces(const TriangleMesh& mesh, UnwrapEffort effort, BoundTools& tools_of)
      : mesh_(mesh), coarsest_(coarsest_triangles(effort)), tools_of_(tools_of) {}

  /// @return null: there is none.
  const CoarseSurface* of_attempt(std::size_t attempt) {
    while (made_.size() <= attempt && made_.size() < coarsest_.size()) made_.push_back(make(coarsest_[made_.size()]));
    return attempt < made_.size() ? made_[attempt] : nullptr;
  }

 private:
  /// One that seams are sought on with the help of coarser ones, where there is room for these.
  const CoarseSurface* make(std::size_t coarsest) {
    const CoarseSurface* finest = nullptr;
    SeamTools* finer_tools = nullptr;
    const TriangleMesh* finer = &mesh_;
    for (const std::size_t triangles : level_triangles(mesh_.triangles.size(), coarsest)) {
      Level& level = levels_.emplace_back();
      level.coarse = coarsen(*finer, triangles);
      finer = &level.coarse.mesh;
      level.surface.emplace(CoarseSurface{*finer, level.coarse.vertices, tools_of_.of(*finer, level.memory)});
      const CoarseSurface* surface = &*level.surface;
      if (finer_tools)
        finer_tools->coarse = [surface](std::size_t attempt) { return attempt == 0 ? surface : nullptr; };
      if (!finest) finest = surface;
      finer_tools = &level.surface->tools;
    }
    return finest;
  }

  const TriangleMesh& mesh_;
  std::vector<std::size_t> coarsest_;
  BoundTools& tools_of_;
  std::deque<Level> levels_;
  std::vector<const CoarseSurface*> made_;
};

}  // namespace

Flattening chart_within_bound(const TriangleMesh& mesh, const MethodOptions& o, const PartContext& context,
                              FlattenedPart& part) {
  BoundTools tools_of(o, context, part);
  PartMemory memory;
  SeamTools tools = tools_of.of(mesh, memory);
  CoarseSurfaces surfaces(mesh, o.effort, tools_of);
  tools.coarse = [&](std::size_t attempt) { return surfaces.of_attempt(attempt); };
  BoundedSeams result = keep_bound(mesh, *o.max_distortion, tools, o.deadline, o.progress);
  part.bound = BoundReport{*o.max_distortion, result.kept,         result.distortion,
                           result.seam_mm,    result.seam_cost_mm, std::move(result.trace)};
  part.choices = std::move(result.charted.choices);
  return std::move(result.charted.flattening);
}

}  // namespace papilla::detail
