// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include <csignal>
#include <filesystem>
#include <memory>

#include "file_options.hpp"
#include "json/scene_json.hpp"
#include "options/scene_option.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/file_guard.hpp"
#include "papilla/core/progress.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "verbs.hpp"
#include "weather/follow_files.hpp"
#include "weather/weather_build.hpp"

namespace papilla::app {
namespace {

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

struct Options {
  std::string scene;
  WeatherBuildOptions build;
  bool live = false;
  SceneOptions read;
};

/// Builds again whenever the configuration or a file that it rests on is saved. A mistake in them is printed and
/// waited for.
void rebuild_on_change(const Options& options, WeatherBuilder& builder, const VerbContext& context,
                       WeatherBuild& build) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  const auto list = [&] {
    std::vector<std::filesystem::path> files(builder.files().begin(), builder.files().end());
    files.emplace_back(options.build.config);
    return files;
  };
  const auto again = [&] {
    try {
      forget_written_outputs();
      build = builder.build(options.build, true, context);
      context.console.print(shown_format("{} painted anew in {:.2f} s\n", build.painted, build.seconds));
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      context.console.print(shown_format("{}\n", error.what()));
    }
  };
  context.console.print("waiting for changes; Ctrl-C ends\n");
  follow_files(list, again, [&] { return g_stop || context.deadline.passed(); });
}

Json run(const Options& options, VerbContext& context) {
  WeatherBuilder builder(options.scene, read_scene(options.scene, options.read.read_options(), context.progress));
  WeatherBuild build = builder.build(options.build, options.live, context);
  if (options.live) rebuild_on_change(options, builder, context, build);
  return weather_build_json(build);
}

}  // namespace

void add_weather(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = add_verb(program,
                            {"weather", "Ages a scene: layers of dirt, rust, snow and wear over its materials",
                             "papilla weather data/exchange/vent.glb -c examples/weather.json -o old-vent.glb"},
                            [options](VerbContext& context) { return run(*options, context); });
  reads(verb->add_option("scene", options->scene, "Scene with uv"))->required()->type_name("SCENE");
  reads(verb->add_option("-c,--layers", options->build.config,
                         "Which recipes lie on which materials, at what size and time (JSON)"))
      ->required()
      ->type_name("CONFIG");
  writes(verb->add_option("-o,--output", options->build.output, "GLB or OBJ file to write; a series is numbered"))
      ->required()
      ->type_name("OUT");
  auto* report = writes_into(verb->add_option("--report", options->build.report,
                                              "Folder for a page: before, after, a slider over the times"),
                             {"index.html"})
                     ->type_name("DIR");
  verb->add_flag("--pictures", options->build.pictures, "The page's pictures as PNG files in its folder, too")
      ->needs(report);
  verb->add_flag("--video", options->build.video, "The series as an animated GIF in the page's folder, too")
      ->needs(report);
  verb->add_flag("--strict", options->build.strict, "Refuse layers that lie on no surface");
  verb->add_flag("--live", options->live,
                 "Stay, and build again whenever CONFIG, a library or a picture of it is saved");
  options->read.add_to(*verb);
}

}  // namespace papilla::app
