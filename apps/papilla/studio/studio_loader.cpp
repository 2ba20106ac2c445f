// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_loader.hpp"

#include <utility>

#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/pipeline/bake_file.hpp"

namespace papilla::app {

StudioLoader::StudioLoader(BakeOptions bake, ReadOptions read, StudioEvents& events, Handlers handlers)
    : bake_(std::move(bake)), read_(std::move(read)), events_(events), handlers_(std::move(handlers)) {}

StudioLoader::~StudioLoader() {
  is_cancelled_ = true;
  if (thread_.joinable()) thread_.join();
}

void StudioLoader::load(const std::string& file) {
  const std::scoped_lock lock(mutex_);
  is_cancelled_ = true;
  if (thread_.joinable()) thread_.join();
  is_cancelled_ = false;
  is_loading_ = true;
  thread_ = std::thread([this, file, number = ++loads_] { run(file, number); });
}

void StudioLoader::run(const std::string& file, std::uint64_t number) {
  const auto report = [&](const Progress& done) {
    events_.tell_progress(
        {{"event", "loading"}, {"file", file}, {"stage", std::string(done.stage)}, {"fraction", done.fraction}});
    return !is_cancelled_;
  };
  std::string problem;
  try {
    const Stopwatch clock;
    Scene scene = read_scene(file, read_, report);
    BakeFileOptions way;
    way.read = read_;
    way.bake = bake_;
    const auto made =
        std::make_shared<StudioScene>(std::move(scene), bake_, bake_way(file, way).in_place, std::to_string(number));
    handlers_.taken({file, made, number, clock.seconds()});
  } catch (const Cancelled&) {
    problem = "cancelled";
  } catch (const std::exception& error) {
    problem = error.what();
  }
  is_loading_ = false;
  handlers_.ended(problem);
  events_.tell({{"event", "loaded"}, {"file", file}, {"problem", problem}});
}

}  // namespace papilla::app
