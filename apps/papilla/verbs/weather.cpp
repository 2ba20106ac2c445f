// SPDX-License-Identifier: GPL-3.0-or-later
#include "papilla/pipeline/weather_scene.hpp"

#include <fmt/core.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>

#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/animation_file.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/read_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "verbs.hpp"
#include "weather/follow_files.hpp"
#include "weather/weather_page.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

constexpr double k_pictures_a_second = 4;

struct Arguments {
  std::string scene, config, output, report;
  bool pictures = false, video = false, live = false;
  SceneOptions read;
};

/// What stays from one build of a scene to the next.
struct Workshop {
  Scene scene;
  WeatherCache cache;
  std::optional<ColorImage> before;
};

/// OUT.glb, or OUT.0000.glb and so on for a series.
std::string file_of(const std::string& output, std::size_t step, std::size_t steps) {
  if (steps == 1) return output;
  fs::path path(output);
  return path.replace_extension(fmt::format("{:04}{}", step, fs::path(output).extension().string())).string();
}

/// The page and, if asked for, its pictures as files.
void write_report(const Arguments& a, Workshop& shop, const std::vector<WeatherView>& views, Json& json) {
  const fs::path folder = a.report;
  fs::create_directories(folder);
  if (!shop.before) shop.before = look_at(shop.scene);
  write_atomically(folder / "index.html", weather_page(fs::path(a.scene).filename().string(), *shop.before, views,
                                                       json["materials"], read_file(a.config), a.live));
  json["page"] = (folder / "index.html").string();
  if (a.video) {
    std::vector<ColorImage> frames;
    for (const WeatherView& view : views) frames.push_back(view.picture);
    write_animation(folder / "series.gif", frames, k_pictures_a_second);
    json["video"] = (folder / "series.gif").string();
  }
  if (!a.pictures) return;
  write_color_image(folder / "before.png", *shop.before);
  json["pictures"] = {"before.png"};
  for (std::size_t step = 0; step < views.size(); ++step) {
    const std::string name = fmt::format("time.{:04}.png", step);
    write_color_image(folder / name, views[step].picture);
    json["pictures"].push_back(name);
  }
}

Json build(const Arguments& a, Workshop& shop, const VerbContext& context) {
  const WeatherConfig config = read_weather_config(a.config);
  Json json{
      {"materials", Json::array()}, {"images", 0}, {"duplicates_removed", 0}, {"painted", 0}, {"files", Json::array()}};
  const Stopwatch clock;
  std::vector<WeatherView> views;
  for (std::size_t step = 0; step < config.times.size(); ++step) {
    WeatherResult result = weather(shop.scene, config, config.times[step], shop.cache);
    const std::string file = file_of(a.output, step, config.times.size());
    write_output(result.scene, file, context.console);
    context.console.print(fmt::format("{}: time {:.2f}, {} maps, {} of them alike\n", file, config.times[step],
                                      result.images, result.duplicates_removed));
    if (!a.report.empty()) views.push_back({config.times[step], look_at(result.scene)});
    json["materials"] = std::move(result.materials);
    for (const auto& [key, value] :
         {std::pair{"images", result.images}, std::pair{"duplicates_removed", result.duplicates_removed},
          std::pair{"painted", result.painted}})
      json[key] = json[key].get<int>() + value;
    json["files"].push_back({{"file", file}, {"time", config.times[step]}});
  }
  if (!a.report.empty()) write_report(a, shop, views, json);
  json["seconds"] = clock.seconds();
  return json;
}

/// Builds again whenever the configuration or a file that it rests on is saved. A mistake in them is told and waited
/// for.
Json follow(const Arguments& a, Workshop& shop, const VerbContext& context, Json json) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  const auto list = [&] {
    std::vector<fs::path> files(shop.cache.files.begin(), shop.cache.files.end());
    files.emplace_back(a.config);
    return files;
  };
  const auto again = [&] {
    try {
      json = build(a, shop, context);
      context.console.print(
          fmt::format("{} painted anew in {:.2f} s\n", json["painted"].get<int>(), json["seconds"].get<double>()));
    } catch (const Error& error) {
      context.console.print(std::string(error.what()) + "\n");
    }
  };
  context.console.print("waiting for changes; Ctrl-C ends\n");
  follow_files(list, again, [] { return g_stop.load(); });
  return json;
}

Json run(const Arguments& a, VerbContext& context) {
  Workshop shop;
  shop.scene = read_scene(a.scene, a.read.read_options(), context.progress);
  Json json = build(a, shop, context);
  return a.live ? follow(a, shop, context, std::move(json)) : json;
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
  auto* report = verb->add_option("--report", a->report, "Folder for a page: before, after, a slider over the times")
                     ->type_name("DIR");
  verb->add_flag("--pictures", a->pictures, "The page's pictures as PNG files in its folder, too")->needs(report);
  verb->add_flag("--video", a->video, "The series as an animated GIF in the page's folder, too")->needs(report);
  verb->add_flag("--live", a->live, "Stay, and build again whenever CONFIG, a library or a picture of it is saved");
  a->read.add_to(*verb);
}

}  // namespace papilla::app
