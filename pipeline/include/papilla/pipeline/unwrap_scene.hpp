// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/param/flattening.hpp"
#include "papilla/param/pack_unique.hpp"
#include "papilla/param/seam_visibility.hpp"
#include "papilla/pipeline/scene_sides.hpp"
#include "papilla/pipeline/unwrap_method.hpp"

namespace papilla {

/// Atlas: no two charts of the scene overlap. Tile: the grain's phase goes on over seams, charts may lie over one
/// another.
enum class UvLayout { atlas, tile };

/// A second set of uv (channel 1, in [0, 1]) for one texture in which every place of every part has texels of its own.
struct UniqueUv {
  int texture_px = 2048;
  double gutter_px = 4;
};

/// Options of unwrap_scene(). Every caller that wants uv starts from these defaults.
struct UnwrapOptions {
  MethodOptions method;
  SceneSideOptions sides;  ///< Of unwrap_scene(). Its deadline is replaced by that of the method.
  bool repair = false;     ///< repair() every part before; without, equal positions are welded and nothing else.
  UvLayout layout = UvLayout::atlas;
  std::optional<double> gutter_mm;  ///< Not given: 0.5 % of the side of a square with the area of all charts.
  Vec2 tile_mm{0, 0};               ///< Of the grain; 0: unknown.
  std::optional<double> grain_mm;   ///< Size of one grain; not given: an eighth of the tile's smaller side, or 1 mm.
  std::optional<UniqueUv> unique;   ///< Given: all parts share one texture in channel 1.
  /// Texel density there of parts whose names match the pattern (* and ?), the first match counts; others have 1.
  std::vector<std::pair<std::string, double>> density;
};

/// UnwrapOptions::grain_mm, or what stands for it when it is not given.
double grain_size(const UnwrapOptions& options);

/// What has to be done with every triangle when the time for maps is up: projection, packing, measuring, writing.
inline constexpr double k_seconds_to_finish = 5e-6;

struct UnwrapSeconds {
  double segment = 0, solve = 0, pack = 0, total = 0;
};

struct UnwrappedPart : FlattenedPart {
  SeamVisibility seams;                  ///< For the tile and the grain's size.
  double grain_continued_mm = 0;         ///< Length of the seam over which the grain goes on.
  std::size_t opposed_edges = 0;         ///< Of two triangles that are wound against each other: charts end there.
  std::size_t shared_edges = 0;          ///< Of two triangles or more.
  std::size_t nonmanifold_edges = 0;     ///< Of these, of three triangles or more: charts end there, too.
  std::size_t opposed_pairs = 0;         ///< Of these, of two that are wound against each other.
  std::optional<RepairResult> repaired;  ///< Without its mesh; when repair was wanted.
  std::string failure;                   ///< Why the part has no uv; empty when it has.
  double repair_seconds = 0, solve_seconds = 0;

  /// A twentieth of the inner edges ends charts: repair() leaves fewer and larger ones.
  bool is_far_from_manifold() const noexcept { return 20 * (nonmanifold_edges + opposed_pairs) > shared_edges; }
};

struct UnwrapResult {
  Scene scene;
  SceneSides sides;
  std::vector<UnwrappedPart> parts;  ///< As in the scene.
  std::uint32_t charts = 0;
  StopReason stop = StopReason::direct;  ///< The worst ending of any chart.
  Trace trace;                           ///< Of all parts, by time.
  double fill_rate = 0;                  ///< Of the atlas; 0 for tiles.
  double grain_mm = 1;                   ///< The size of grain that seams are judged by.
  std::optional<UniqueAtlas> unique;     ///< Without its uv, which the parts have.
  UnwrapSeconds seconds;
};

/// What the parts of a scene have in common: their number, their extent as instances place them, the upward axis.
PartContext unwrap_context(const Scene& scene, Vec2 tile_mm);

/// Gives one mesh charts and uv in millimetres: weld_equal() or repair(), flatten_part(), align_phase(). The charts are
/// not packed. This is what every part of unwrap_scene() and every surface of bake_scene() goes through.
/// @throws InvalidInput, SolverFailure of the method.
UnwrappedPart unwrap_part(TriangleMesh& mesh, const PartContext& context, const UnwrapOptions& options);

/// turn_sheets(), unwrap_part() of every part, and the atlas (channel 0, millimetres; environment: textures, not
/// placed). Parts run in parallel; the result does not depend on the number of threads. Parts whose method fails keep
/// what they had and say why; when all fail, the first failure is thrown.
/// @throws InvalidInput when there is no triangle; naming the part, when charts are to be those of uv and a triangle
/// has none.
UnwrapResult unwrap_scene(Scene scene, const UnwrapOptions& options = {}, const ProgressCallback& progress = {});

}  // namespace papilla
