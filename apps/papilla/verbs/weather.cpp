// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "file_options.hpp"
#include "option_checks.hpp"
#include "options/output_option.hpp"
#include "options/scene_option.hpp"
#include "verbs.hpp"
#include "weather/weather_build.hpp"
#include "weather/weather_live.hpp"

namespace papilla::app {
namespace {

struct Options {
  std::string scene;
  WeatherBuildOptions build;
  bool live = false;
  WeatherLiveOptions follow;
  SceneOptions read;
  OutputOptions stored;
};

Json run(const Options& options, VerbContext& context) {
  WeatherBuildOptions wanted = options.build;
  wanted.write = options.stored.write_options(options.build.output);
  WeatherBuilder builder(options.scene,
                         read_scene(options.scene, options.read.read_options(context.cache), context.progress));
  WeatherBuild build = builder.build(wanted, options.live, context);
  if (!options.live) return weather_build_json(build);
  const std::string url = follow_weather(wanted, options.follow, builder, context, build);
  Json json = weather_build_json(build);
  json["url"] = url;
  return json;
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
  auto* live = verb->add_flag("--live", options->live,
                              "Stay, and serve a page on this machine, at an address with a secret token, that shows "
                              "what changes whenever CONFIG, a library or a picture of it is saved; OUT is built again "
                              "when edits rest");
  verb->add_option("--port", options->follow.port, "Of the page; 0 takes any that is free")
      ->type_name("N")
      ->check(in_range(0, 65535))
      ->needs(live);
  verb->add_flag("--no-open", options->follow.no_open, "Don't start a browser for the page")->needs(live);
  options->read.add_to(*verb);
  options->stored.add_to(*verb);
}

}  // namespace papilla::app
