// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/materials.hpp"

namespace papilla {

/// Makes the grains of materials, each once: when it is asked for, or before, while a scene is still being read by one
/// thread. The grains are the same either way.
class GrainMaker {
 public:
  /// @param rules, library, cache  must outlive this. @param deadline of searches in pictures.
  GrainMaker(const Materials& rules, const RecipeLibrary& library, const Deadline& deadline, const StageCache* cache);
  GrainMaker(const GrainMaker&) = delete;
  GrainMaker& operator=(const GrainMaker&) = delete;

  /// Waits for a grain that is being made ahead; those not begun are left.
  ~GrainMaker();

  /// Begins with the grains of materials that rules assign, in the order of the rules, beside the caller. What a scene
  /// then does not show was made in vain, so this is for scenes that take longer to read than their grains to make.
  /// Does nothing on one thread, and where a deadline decides how much of a picture is searched.
  void begin_ahead();

  /// Of grains that are begun from now on: when searches in pictures end.
  void finish_by(const Deadline& deadline) {
    const std::scoped_lock lock(mutex_);
    deadline_ = deadline;
  }

  /// A grain that was made before, for take().
  void put(const std::string& material, Grain grain);

  /// The grain of a material, to be asked for once. Thread-safe.
  /// @throws what make_grain() does.
  Grain take(const std::string& material);

 private:
  struct Entry {
    bool done = false;
    Grain grain;
    std::exception_ptr failure;
  };
  bool begin(const std::string& material);
  void make(const std::string& material);

  const Materials& rules_;
  const RecipeLibrary& library_;
  Deadline deadline_;
  const StageCache* cache_;
  std::mutex mutex_;
  std::condition_variable done_;
  std::map<std::string, Entry> begun_;
  bool stops_ = false;
  std::thread ahead_;
};

}  // namespace papilla
