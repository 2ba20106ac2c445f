// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather/weather_build.hpp"

#include <fmt/core.h>

#include "json/scene_json.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/io/animation_file.hpp"
#include "papilla/io/image_file.hpp"
#include "scene_output.hpp"
#include "shown_format.hpp"
#include "weather/weather_page.hpp"

namespace papilla::app {
namespace {

namespace fs = std::filesystem;

constexpr double k_pictures_a_second = 4;

WeatherConfig config_of(const WeatherBuildOptions& options, bool live) {
  WeatherConfig config = read_weather_config(options.config);
  config.strict = options.strict;
  config.stable_layout = live;
  return config;
}

/// OUT.glb, or OUT.0000.glb and so on for a series.
std::string file_of(const std::string& output, std::size_t step, std::size_t steps) {
  if (steps == 1) return output;
  fs::path path(output);
  return path.replace_extension(fmt::format("{:04}{}", step, fs::path(output).extension().string())).string();
}

/// The page and, if asked for, its pictures as files.
void write_report(const WeatherBuildOptions& options, const std::string& scene_file, const ColorImage& before,
                  const std::vector<WeatherView>& views, bool live, WeatherBuild& build) {
  const fs::path folder = options.report;
  make_folder(folder);
  build.page = (folder / "index.html").string();
  write_atomically(build.page, weather_page(fs::path(scene_file).filename().string(), before, views, build.materials,
                                            read_file(options.config), live));
  if (options.video) {
    std::vector<ColorImage> frames;
    for (const WeatherView& view : views) frames.push_back(view.picture);
    build.video = (folder / "series.gif").string();
    write_animation(build.video, frames, k_pictures_a_second);
  }
  if (!options.pictures) return;
  const auto write = [&](const std::string& name, const ColorImage& picture) {
    write_color_image(folder / name, picture);
    build.pictures.push_back(name);
  };
  write("before.png", before);
  for (std::size_t step = 0; step < views.size(); ++step)
    write(fmt::format("time.{:04}.png", step), views[step].picture);
}

/// A row a layer: on how many surfaces it lies.
std::string layers_text(const std::vector<RuleUse>& layers) {
  std::string text = shown_format("layer  {:>8}  {:>8}  for\n", "surfaces", "uses");
  for (std::size_t i = 0; i < layers.size(); ++i)
    text += shown_format("{:>5}  {:>8}  {:>8}  {}\n", i + 1, layers[i].surfaces, layers[i].uses, layers[i].selector);
  return text;
}

}  // namespace

WeatherLooks WeatherBuilder::looks(const WeatherBuildOptions& options, const ProgressCallback& progress) {
  const WeatherConfig config = config_of(options, true);
  return weather_looks(scene_, config, config.times.back(), cache_, progress);
}

WeatherBuild WeatherBuilder::build(const WeatherBuildOptions& options, bool live, const VerbContext& context) {
  const WeatherConfig config = config_of(options, live);
  WeatherBuild build;
  const Stopwatch clock;
  std::vector<WeatherView> views;
  for (std::size_t step = 0; step < config.times.size(); ++step) {
    WeatherResult result = weather_scene(scene_, config, config.times[step], cache_, context.progress);
    if (const std::string reason = reason_for_no_paint(result); !reason.empty())
      throw InvalidInput(file_ + ", with " + options.config + ": " + reason);
    if (step == 0) context.console.print(layers_text(result.layers));
    const std::string file = file_of(options.output, step, config.times.size());
    write_output(result.scene, file, options.write, context.console);
    context.console.print(shown_format("{}: time {:.2f}, {} maps, {} of them alike\n", file, config.times[step],
                                       result.images, result.duplicates_removed));
    if (!options.report.empty()) views.push_back({config.times[step], view_of(result.scene)});
    build.materials = std::move(result.materials);
    build.layers = std::move(result.layers);
    build.images += result.images;
    build.duplicates_removed += result.duplicates_removed;
    build.painted += result.painted;
    build.files.push_back({file, config.times[step]});
    if (live && step + 1 == config.times.size()) build.shown = std::move(result.scene);
  }
  if (!options.report.empty()) {
    if (!before_) before_ = view_of(scene_);
    write_report(options, file_, *before_, views, live, build);
  }
  build.seconds = clock.seconds();
  return build;
}

Json weather_build_json(const WeatherBuild& build) {
  Json json{{"materials", Json::array()}, {"layers", rules_json(build.layers)},
            {"images", build.images},     {"duplicates_removed", build.duplicates_removed},
            {"painted", build.painted},   {"files", Json::array()}};
  for (const WeatheredMaterial& material : build.materials) json["materials"].push_back(weather_json(material));
  for (const WeatherBuild::File& file : build.files)
    json["files"].push_back({{"file", file.file}, {"time", file.time}});
  if (!build.page.empty()) json["page"] = build.page;
  if (!build.video.empty()) json["video"] = build.video;
  if (!build.pictures.empty()) json["pictures"] = build.pictures;
  json["seconds"] = build.seconds;
  return json;
}

}  // namespace papilla::app
