// SPDX-License-Identifier: MIT
#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/param/pack.hpp"
#include "papilla/pipeline/measure_scene.hpp"
#include "papilla/pipeline/unwrap_method.hpp"
#include "papilla/pipeline/unwrap_scene.hpp"
#include "uv_input.hpp"

namespace papilla::python {
namespace {

TriangleMesh mesh_of(Values<Vec3>&& positions, Values<Triangle>&& triangles) {
  TriangleMesh mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  return mesh;
}

void add_measures(py::module_& module) {
  define<MeasureOptions>(
      module, "distortion(V: ArrayLike, F: ArrayLike, uv: ArrayLike | CornerVec2) -> DistortionReport",
      docs::measure_distortion,
      [](Values<Vec3>& positions, Values<Triangle>& triangles, UvInput& uv, const MeasureOptions& options) {
        TriangleMesh mesh = mesh_of(std::move(positions), std::move(triangles));
        return measure_distortion(mesh, uv.seen_on(mesh), options);
      });
  define<MeasureOptions>(module, "measure_distortion(mesh: TriangleMesh, uv: CornerVec2) -> DistortionReport",
                         docs::measure_distortion,
                         [](const TriangleMesh& mesh, const CornerAttribute<Vec2>& uv, const MeasureOptions& options) {
                           return measure_distortion(mesh, uv, options);
                         });
  define<MeasureOptions>(
      module, "measure_scene(scene: Scene) -> SceneDistortion",
      "The distortion of all parts of a scene that have uv, as one list of triangles.\nRaises "
      "InvalidInput when no part has uv.",
      [](const Scene& scene, const MeasureOptions& options) { return measure_scene(scene, options); });
  define(module, "worst_chart(distortion: SceneDistortion) -> WorstChart | None", docs::worst_chart,
         [](const SceneDistortion& distortion) { return worst_chart(distortion); });
}

template <class Options, class F>
void add_method(py::module_& module, const std::string& name, const std::string& result, const char* doc, F flatten) {
  define<Options>(module, (name + "(mesh: TriangleMesh, charts: ChartSet) -> " + result).c_str(), doc,
                  [flatten](const TriangleMesh& mesh, const ChartSet& charts, const Options& options) {
                    return flatten(mesh, charts, options);
                  });
}

template <class Options, class F>
void add_projection(py::module_& module, const std::string& name, const std::string& result, const char* doc,
                    F flatten) {
  define<Options>(module, (name + "(mesh: TriangleMesh) -> " + result).c_str(), doc,
                  [flatten](const TriangleMesh& mesh, const Options& options) { return flatten(mesh, options); });
}

void add_methods(py::module_& module) {
  add_method<LscmOptions>(module, "flatten_lscm", "Flattening", docs::flatten_lscm, flatten_lscm);
  add_method<ReferenceOptions>(module, "flatten_reference", "Flattening", docs::flatten_reference, flatten_reference);
  add_method<MaillotOptions>(module, "flatten_maillot", "MaillotResult", docs::flatten_maillot, flatten_maillot);
  add_method<LevyOptions>(module, "flatten_levy", "LevyResult", docs::flatten_levy, flatten_levy);
  add_method<AutomaticOptions>(module, "flatten_automatic", "AutomaticResult", docs::flatten_automatic,
                               flatten_automatic);
  define<BestOptions>(
      module, "flatten_best(mesh: TriangleMesh, charts: ChartSet) -> Flattening", docs::flatten_best,
      [](const TriangleMesh& mesh, const ChartSet& charts, BestOptions& options, const ProgressCallback& progress) {
        options.progress = progress;
        return flatten_best(mesh, charts, options);
      });
  add_projection<NaturalOptions>(module, "flatten_natural", "Flattening", docs::flatten_natural, flatten_natural);
  add_projection<PlanarOptions>(module, "flatten_planar", "ProjectionResult", docs::flatten_planar, flatten_planar);
  add_projection<IntermediateOptions>(module, "flatten_intermediate", "ProjectionResult", docs::flatten_intermediate,
                                      flatten_intermediate);
  add_projection<TriplanarOptions>(module, "flatten_triplanar", "TriplanarResult", docs::flatten_triplanar,
                                   flatten_triplanar);
  add_projection<EnvironmentOptions>(module, "environment_uv", "CornerVec2", docs::environment_uv, environment_uv);
}

constexpr char k_parameterize_doc[] =
    "Charts and maps a surface of arrays: positions V (n, 3) in millimetres, triangles F (m, 3). method is one of "
    "choices[\"UnwrapMethod\"]; each method's own options are fields of the options by its name. Equal positions are "
    "joined first, triangles keep their order. The result's flattening.uv is in millimetres, a value per corner; the "
    "charts are not packed: pack_atlas() does that. As flatten_part() of the headers.\n\n";

void add_jobs(py::module_& module) {
  static const std::string k_doc = k_parameterize_doc + std::string(docs::flatten_part);
  define<MethodOptions>(module, "parameterize(V: ArrayLike, F: ArrayLike) -> FlattenedPart", k_doc.c_str(),
                        [](Values<Vec3>& positions, const Values<Triangle>& triangles, MethodOptions& options,
                           const ProgressCallback& progress) {
                          options.progress = progress;
                          // Welding gives positions a new array and numbers the triangles anew in theirs.
                          const TriangleMesh mesh =
                              weld_equal(mesh_of(std::move(positions), Values<Triangle>(triangles))).mesh;
                          return flatten_part(mesh, {}, options);
                        });
  define<MethodOptions>(module, "flatten_part(mesh: TriangleMesh, context: PartContext) -> FlattenedPart",
                        docs::flatten_part,
                        [](const TriangleMesh& mesh, const PartContext& context, MethodOptions& options,
                           const ProgressCallback& progress) {
                          options.progress = progress;
                          return flatten_part(mesh, context, options);
                        });
  define(module, "given_charts(mesh: TriangleMesh, source: ChartSource) -> ChartSet", docs::given_charts,
         [](const TriangleMesh& mesh, ChartSource source) { return given_charts(mesh, source); });
  define<AtlasOptions>(module, "pack_atlas(uv: CornerVec2, charts: ChartSet) -> Atlas", docs::pack_atlas,
                       [](const CornerAttribute<Vec2>& uv, const ChartSet& charts, const AtlasOptions& options) {
                         return pack_atlas(uv, charts, options);
                       });
  define<UnwrapOptions>(module, "unwrap_scene(scene: Scene) -> UnwrapResult", docs::unwrap_scene,
                        [](Scene scene, const UnwrapOptions& options, const ProgressCallback& progress) {
                          return unwrap_scene(std::move(scene), options, progress);
                        });
}

}  // namespace

void add_param(py::module_& module) {
  add_measures(module);
  add_methods(module);
  add_jobs(module);
}

}  // namespace papilla::python
