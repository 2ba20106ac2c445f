// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include "papilla/pipeline/studio/studio_scene.hpp"

namespace papilla::app {

/// Bakes the surfaces that a document wants and that are not there, one after the other, in a thread of its own: those
/// of the newest change first; then those that are only tried. A surface that nobody wants any more is given up; what
/// was made stays for a while, so that undo shows it at once.
class StudioWorker {
 public:
  struct Handlers {  ///< Called from the worker's thread.
    std::function<void(const StudioSurface&, const std::string& name)> ready;
    std::function<void(const std::string& label, const std::string& name, const std::string& problem)> failed;
    std::function<void(std::size_t left, const std::string& label)> working;  ///< Nothing left: the label is empty.
  };

  explicit StudioWorker(Handlers handlers);
  ~StudioWorker();  ///< Gives up what runs.
  StudioWorker(const StudioWorker&) = delete;
  StudioWorker& operator=(const StudioWorker&) = delete;

  /// Another scene, or a document for it. The newest wins.
  void want(std::shared_ptr<StudioScene> scene, std::shared_ptr<const StudioPlan> plan);

  /// Surfaces that a document would have, for the scene of want(). The newest wins.
  void try_also(std::shared_ptr<const StudioPlan> plan);

  /// By short_name() of a wish's key; null when it is not there.
  std::shared_ptr<const StudioSurface> find(const std::string& name) const;
  /// Why a surface could not be made; empty.
  std::string problem_of(const std::string& name) const;

 private:
  struct Entry {
    std::shared_ptr<const StudioSurface> surface;
    std::string problem;
    std::uint64_t used = 0;
  };
  static constexpr std::size_t k_most_entries = 2000;  ///< Beside those that are wanted.

  void run();
  /// The wish to be made next, and the plan that has it. @pre locked.
  std::pair<std::shared_ptr<const StudioPlan>, const StudioWish*> next(std::size_t& left) const;
  /// @pre locked.
  bool is_tried(const std::string& name) const;
  void make(const std::shared_ptr<StudioScene>& scene, const std::shared_ptr<const StudioPlan>& plan,
            const StudioWish& wish, const std::string& name);
  void forget_old();

  Handlers handlers_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false;
  std::shared_ptr<StudioScene> scene_;
  std::shared_ptr<const StudioPlan> plan_, tried_;
  std::map<std::string, std::uint64_t> wanted_;  ///< Names, with the number of the change that first wanted them.
  std::map<std::string, Entry> made_;
  std::uint64_t changes_ = 0;
  std::thread thread_;
};

}  // namespace papilla::app
