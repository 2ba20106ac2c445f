// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "papilla/core/trace.hpp"
#include "papilla/io/scene_file.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct Arguments {
  std::string scene, config, output;
  SceneOptions read;
};

/// OUT.glb, or OUT.0000.glb and so on for a series.
std::string file_of(const std::string& output, std::size_t step, std::size_t steps) {
  if (steps == 1) return output;
  std::filesystem::path path(output);
  return path.replace_extension(fmt::format("{:04}{}", step, std::filesystem::path(output).extension().string()))
      .string();
}

Json run(const Arguments& a, VerbContext& context) {
  const WeatherConfig config = read_weather_config(a.config);
  const Scene scene = read_scene(a.scene, a.read.read_options(), context.progress);
  Json json{{"materials", Json::array()}, {"images", 0}, {"duplicates_removed", 0}, {"files", Json::array()}};
  const Stopwatch clock;
  for (std::size_t step = 0; step < config.times.size(); ++step) {
    WeatherResult result = weather(scene, config, config.times[step]);
    const std::string file = file_of(a.output, step, config.times.size());
    write_output(result.scene, file, context.console);
    context.console.print(fmt::format("{}: time {:.2f}, {} maps, {} of them alike\n", file, config.times[step],
                                      result.images, result.duplicates_removed));
    json["materials"] = std::move(result.materials);
    json["images"] = json["images"].get<int>() + result.images;
    json["duplicates_removed"] = json["duplicates_removed"].get<int>() + result.duplicates_removed;
    json["files"].push_back({{"file", file}, {"time", config.times[step]}});
  }
  json["seconds"] = clock.seconds();
  return json;
}

}  // namespace

void add_weather(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* verb = add_verb(program,
                            {"weather", "Ages a scene: layers of dirt, rust, snow and wear over its materials",
                             "papilla weather house.glb -c weather.json -o old-house.glb"},
                            [a](VerbContext& context) { return run(*a, context); });
  verb->add_option("scene", a->scene, "Scene with uv")->required()->type_name("SCENE");
  verb->add_option("-c,--layers", a->config, "Which recipes lie on which materials, at what size and time (JSON)")
      ->required()
      ->type_name("CONFIG");
  verb->add_option("-o,--output", a->output, "GLB or OBJ file to write; a series is numbered")
      ->required()
      ->type_name("OUT");
  a->read.add_to(*verb);
}

}  // namespace papilla::app
