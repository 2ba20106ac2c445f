// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/weather_scene.hpp"
#include "papilla/texture/image.hpp"
#include "verb.hpp"

namespace papilla::app {

/// What is written: a scene a time, and a page of them.
struct WeatherBuildOptions {
  std::string config, output, report;  ///< The page's folder; empty: no page.
  bool pictures = false, video = false;
  bool strict = false;  ///< A layer that lies on no surface is an error.
  WriteOptions write;
};

struct WeatherBuild {
  std::vector<WeatheredMaterial> materials;  ///< At the last time.
  std::vector<RuleUse> layers;
  int images = 0, duplicates_removed = 0, painted = 0;
  struct File {
    std::string file;
    double time = 0;
  };
  std::vector<File> files;
  std::string page, video;            ///< Empty when not written.
  std::vector<std::string> pictures;  ///< In the page's folder.
  std::optional<Scene> shown;         ///< Of live builds: the scene at the last time.
  double seconds = 0;
};

/// Builds the scenes of a configuration; what was painted is kept from one build to the next.
class WeatherBuilder {
 public:
  WeatherBuilder(std::string file, Scene scene) : file_(std::move(file)), scene_(std::move(scene)) {}

  /// @param live the report reads itself again every two seconds, and the layout of atlases is stable.
  /// @throws IoError, InvalidInput as read_weather_config(), weather_scene() and write_scene(), and when nothing would
  /// be painted: nothing is written then.
  WeatherBuild build(const WeatherBuildOptions& options, bool live, const VerbContext& context);

  /// What a live build would show at the last time.
  /// @throws as build(), but for writing.
  WeatherLooks looks(const WeatherBuildOptions& options, const ProgressCallback& progress);

  /// All that was ever read beside the configuration.
  const std::set<std::filesystem::path>& files() const noexcept { return cache_.files(); }

 private:
  std::string file_;
  Scene scene_;
  WeatherCache cache_;
  std::optional<ColorImage> before_;
};

Json weather_build_json(const WeatherBuild& build);

}  // namespace papilla::app
