// SPDX-License-Identifier: GPL-3.0-or-later
#include "grain_maker.hpp"

#include <oneapi/tbb/global_control.h>

#include <utility>

namespace papilla {

GrainMaker::GrainMaker(const Materials& rules, const RecipeLibrary& library, const Deadline& deadline,
                       const StageCache* cache)
    : rules_(rules), library_(library), deadline_(deadline), cache_(cache) {}

GrainMaker::~GrainMaker() {
  if (!ahead_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    stops_ = true;
  }
  ahead_.join();
}

void GrainMaker::begin_ahead() {
  using tbb::global_control;
  if (!deadline_.never() || global_control::active_value(global_control::max_allowed_parallelism) < 2) return;
  std::vector<std::string> wanted;
  for (const AssignRule& rule : rules_.assign) {
    const auto found = rules_.materials.find(rule.material);
    if (found != rules_.materials.end() && !found->second.texture.empty()) wanted.push_back(rule.material);
  }
  ahead_ = std::thread([this, wanted = std::move(wanted)] {
    for (const std::string& material : wanted) {
      {
        const std::scoped_lock lock(mutex_);
        if (stops_) return;
      }
      if (begin(material)) make(material);
    }
  });
}

void GrainMaker::put(const std::string& material, Grain grain) {
  const std::scoped_lock lock(mutex_);
  Entry& entry = begun_[material];
  entry.grain = std::move(grain);
  entry.done = true;
}

Grain GrainMaker::take(const std::string& material) {
  if (begin(material)) make(material);
  std::unique_lock lock(mutex_);
  Entry& entry = begun_.at(material);
  done_.wait(lock, [&] { return entry.done; });
  if (entry.failure) std::rethrow_exception(entry.failure);
  return std::move(entry.grain);
}

/// @return whether the caller is to make it.
bool GrainMaker::begin(const std::string& material) {
  const std::scoped_lock lock(mutex_);
  return begun_.try_emplace(material).second;
}

void GrainMaker::make(const std::string& material) {
  const Deadline deadline = [this] {
    const std::scoped_lock lock(mutex_);
    return deadline_;
  }();
  Entry made;
  try {
    made.grain = make_grain(rules_.materials.at(material), library_, deadline, cache_);
  } catch (...) {
    made.failure = std::current_exception();
  }
  made.done = true;
  {
    const std::scoped_lock lock(mutex_);
    begun_.at(material) = std::move(made);
  }
  done_.notify_all();
}

}  // namespace papilla
