// SPDX-License-Identifier: MIT
#include <span>

#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/meshing/chart_cuts.hpp"
#include "papilla/meshing/deviation.hpp"
#include "papilla/meshing/repair.hpp"
#include "papilla/meshing/segmentation.hpp"
#include "papilla/meshing/simplify.hpp"
#include "papilla/meshing/statistics.hpp"
#include "papilla/meshing/uv_charts.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/pipeline/perception.hpp"
#include "papilla/pipeline/repair_scene.hpp"
#include "papilla/pipeline/scene_sides.hpp"
#include "papilla/pipeline/simplify_scene.hpp"

namespace papilla::python {
namespace {

void add_repair(py::module_& module) {
  define<RepairOptions>(module, "repair(mesh: TriangleMesh) -> RepairResult", docs::repair,
                        [](TriangleMesh mesh, RepairOptions& options, const ProgressCallback& progress) {
                          options.progress = progress;
                          return repair(std::move(mesh), options);
                        });
  define(module, "weld_equal(mesh: TriangleMesh) -> WeldResult", docs::weld_equal,
         [](TriangleMesh mesh) { return weld_equal(std::move(mesh)); });
  define<WeldOptions>(module, "weld(mesh: TriangleMesh) -> WeldResult", docs::weld,
                      [](TriangleMesh mesh, const WeldOptions& options) { return weld(std::move(mesh), options); });
  define<WeldOptions>(module, "weld_ladder(mesh: TriangleMesh, tolerances_mm: ArrayLike) -> NDArray[np.void]",
                      docs::weld_ladder,
                      [](const TriangleMesh& mesh, std::span<const double> tolerances, const WeldOptions& options) {
                        return weld_ladder(mesh, tolerances, options);
                      });
  define(module, "mesh_statistics(mesh: TriangleMesh) -> MeshStatistics", docs::mesh_statistics,
         [](const TriangleMesh& mesh) { return mesh_statistics(mesh); });
  define<RepairSceneOptions>(module, "repair_scene(scene: Scene) -> RepairSceneResult", docs::repair_scene,
                             [](Scene scene, const RepairSceneOptions& options, const ProgressCallback& progress) {
                               return repair_scene(std::move(scene), options, progress);
                             });
  define<SceneSideOptions>(
      module, "find_sides(scene: Scene) -> SceneSides", docs::find_sides,
      [](const Scene& scene, const SceneSideOptions& options) { return find_sides(scene, options); });
}

void add_simplify(py::module_& module) {
  define<SimplifyOptions>(module, "simplify(mesh: TriangleMesh) -> SimplifyResult", docs::simplify,
                          [](const TriangleMesh& mesh, SimplifyOptions& options, const ProgressCallback& progress) {
                            options.progress = progress;
                            return simplify(mesh, options);
                          });
  define<SimplifyOptions>(module, "simplify_ladder(mesh: TriangleMesh, tolerances_mm: ArrayLike) -> list[SimplifyStep]",
                          docs::simplify_ladder,
                          [](const TriangleMesh& mesh, std::span<const double> tolerances, SimplifyOptions& options,
                             const ProgressCallback& progress) {
                            options.progress = progress;
                            return simplify_ladder(mesh, tolerances, options);
                          });
  define<SimplifyOptions>(module,
                          "levels_of_detail(mesh: TriangleMesh, tolerances_mm: ArrayLike) -> list[SimplifyResult]",
                          docs::levels_of_detail,
                          [](const TriangleMesh& mesh, std::span<const double> tolerances, SimplifyOptions& options,
                             const ProgressCallback& progress) {
                            options.progress = progress;
                            return levels_of_detail(mesh, tolerances, options);
                          });
  define<SimplifySceneOptions>(module, "simplify_scene(scene: Scene) -> SimplifySceneResult", docs::simplify_scene,
                               [](Scene scene, const SimplifySceneOptions& options, const ProgressCallback& progress) {
                                 return simplify_scene(std::move(scene), options, progress);
                               });
  define<DeviationOptions>(
      module, "surface_deviation(of: TriangleMesh, to: TriangleMesh) -> DeviationResult", docs::surface_deviation,
      [](const TriangleMesh& of, const TriangleMesh& to, DeviationOptions& options, const ProgressCallback& progress) {
        options.progress = progress;
        return surface_deviation(of, to, options);
      });
  define<PerceptionOptions>(module, "measure_perception(scene: Scene) -> ScenePerception", docs::measure_perception,
                            [](const Scene& scene, const PerceptionOptions& options, const ProgressCallback& progress) {
                              return measure_perception(scene, options, progress);
                            });
}

void add_charts(py::module_& module) {
  define<SegmentationOptions>(
      module, "segment_charts(mesh: TriangleMesh) -> SegmentationResult", docs::segment_charts,
      [](const TriangleMesh& mesh, SegmentationOptions& options, const ProgressCallback& progress) {
        options.progress = progress;
        return segment_charts(mesh, options);
      });
  define(module, "uv_charts(mesh: TriangleMesh) -> ChartSet", docs::uv_charts,
         [](const TriangleMesh& mesh) { return uv_charts(mesh); });
  define(module, "open_charts(mesh: TriangleMesh, charts: ChartSet, disks: bool = True) -> ChartSet", docs::open_charts,
         [](const TriangleMesh& mesh, const ChartSet& charts, bool disks) { return open_charts(mesh, charts, disks); });
}

}  // namespace

void add_meshing(py::module_& module) {
  add_repair(module);
  add_simplify(module);
  add_charts(module);
}

}  // namespace papilla::python
