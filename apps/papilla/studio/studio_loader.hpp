// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "studio/studio_events.hpp"

namespace papilla::app {

/// Reads one scene after the other in a thread, with progress.
class StudioLoader {
 public:
  struct Loaded {
    std::string file;
    std::shared_ptr<StudioScene> scene;
    std::uint64_t number = 0;  ///< Of the readings; the name of the scene.
    double seconds = 0;
  };
  struct Handlers {  ///< Called from the thread.
    std::function<void(const Loaded&)> taken;
    std::function<void(const std::string& problem)> ended;  ///< Empty: taken. Before pages are told.
  };

  StudioLoader(BakeOptions bake, ReadOptions read, StudioEvents& events, Handlers handlers);
  ~StudioLoader();  ///< Gives up what runs.
  StudioLoader(const StudioLoader&) = delete;
  StudioLoader& operator=(const StudioLoader&) = delete;

  /// Another file; one that is being read is given up.
  void load(const std::string& file);
  void cancel() noexcept { is_cancelled_ = true; }
  bool is_loading() const noexcept { return is_loading_; }

 private:
  void run(const std::string& file, std::uint64_t number);

  const BakeOptions bake_;
  const ReadOptions read_;
  StudioEvents& events_;
  const Handlers handlers_;
  std::mutex mutex_;
  std::uint64_t loads_ = 0;
  std::atomic<bool> is_cancelled_{false}, is_loading_{false};
  std::thread thread_;
};

}  // namespace papilla::app
