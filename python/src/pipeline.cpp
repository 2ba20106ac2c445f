// SPDX-License-Identifier: MIT
#include "fields_of_work.hpp"
#include "function.hpp"
#include "papilla/pipeline/bake_file.hpp"
#include "papilla/pipeline/bake_plan.hpp"
#include "papilla/pipeline/bake_scene.hpp"
#include "papilla/pipeline/evaluate/evaluation.hpp"
#include "papilla/pipeline/evaluate/stability.hpp"
#include "papilla/pipeline/weather_scene.hpp"
#include "pictures.hpp"

namespace papilla::python {
namespace {

using Path = std::filesystem::path;

void add_bake(py::module_& module) {
  define<BakePlanOptions>(
      module, "plan_bake(scene: Scene, rules: Materials) -> BakePlan", docs::plan_bake,
      [](Scene scene, const Materials& rules, const BakePlanOptions& options, const ProgressCallback& progress) {
        return plan_bake(std::move(scene), rules, options, progress);
      });
  define<BakeFileOptions>(module, "plan_file(input: str | os.PathLike[str], rules: Materials) -> PlannedFile",
                          docs::plan_file,
                          [](const Path& input, const Materials& rules, const BakeFileOptions& options,
                             const ProgressCallback& progress) { return plan_file(input, rules, options, progress); });
  define<BakeOptions>(
      module, "bake_scene(scene: Scene, rules: Materials) -> BakeResult", docs::bake_scene,
      [](Scene scene, const Materials& rules, const BakeOptions& options, const ProgressCallback& progress) {
        return bake_scene(std::move(scene), rules, options, progress);
      });
  define<BakeFileOptions>(
      module,
      "bake_file(input: str | os.PathLike[str], output: str | os.PathLike[str], rules: Materials) -> BakeFileResult",
      docs::bake_file,
      [](const Path& input, const Path& output, const Materials& rules, const BakeFileOptions& options,
         const ProgressCallback& progress) { return bake_file(input, output, rules, options, progress); });
  define(module, "write_bake_pictures(result: BakeResult, folder: str | os.PathLike[str]) -> list[str]",
         docs::write_bake_pictures, [](const BakeResult& result, const Path& folder, const ProgressCallback& progress) {
           return write_bake_pictures(result, folder, nullptr, progress);
         });
}

void add_weather(py::module_& module) {
  define(module, "read_weather_config(path: str | os.PathLike[str]) -> WeatherConfig",
         "Reads the CONFIG of papilla weather. Raises IoError, InvalidInput naming file and key.",
         [](const Path& path) { return read_weather_config(path); });
  define(module, "weather_scene(scene: Scene, config: WeatherConfig, time: float) -> WeatherResult",
         docs::weather_scene,
         [](const Scene& scene, const WeatherConfig& config, double time, const ProgressCallback& progress) {
           return weather_scene(scene, config, time, progress);
         });
}

void add_evaluation(py::module_& module) {
  define<EvaluateOptions>(
      module, "evaluate() -> Evaluation", docs::evaluate,
      [](const EvaluateOptions& options, const ProgressCallback& progress) { return evaluate(options, progress); });
  define(module, "evaluation_kinds() -> list[tuple[str, str]]", "Name and one line of help of each kind of evaluation.",
         [] {
           std::vector<std::pair<std::string, std::string>> kinds;
           for (const EvaluationKind& kind : evaluation_kinds()) kinds.emplace_back(kind.name, kind.summary);
           return kinds;
         });
  define(module, "evaluate_stability(seconds: float = 3600.0) -> list[StabilitySuite]", docs::evaluate_stability,
         [](double seconds, const ProgressCallback& progress) { return evaluate_stability(seconds, progress); });
  define(module, "pareto_front(runs: list[EvaluationRun]) -> NDArray[np.void]",
         "Samples of the runs' traces that no other one beats in both time and error, from the fastest to the slowest. "
         "Errors that are not finite are left out.",
         [](const std::vector<EvaluationRun>& runs) {
           std::vector<Trace> traces;
           for (const EvaluationRun& run : runs) traces.push_back(run.trace);
           return pareto_front(traces);
         });
}

}  // namespace

void add_pipeline(py::module_& module) {
  add_bake(module);
  add_weather(module);
  add_evaluation(module);
}

}  // namespace papilla::python
