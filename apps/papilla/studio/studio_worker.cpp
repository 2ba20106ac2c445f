// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_worker.hpp"

#include <algorithm>
#include <utility>

#include "papilla/core/error.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {

StudioWorker::StudioWorker(Handlers handlers) : handlers_(std::move(handlers)), thread_([this] { run(); }) {}

StudioWorker::~StudioWorker() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StudioWorker::want(std::shared_ptr<StudioScene> scene, std::shared_ptr<const StudioPlan> plan) {
  {
    const std::scoped_lock lock(mutex_);
    ++changes_;
    if (scene != scene_) made_.clear(), wanted_.clear(), tried_.reset();
    scene_ = std::move(scene);
    plan_ = std::move(plan);
    std::map<std::string, std::uint64_t> wanted;
    for (const StudioWish& wish : plan_->wishes) {
      const std::string name = short_name(wish.key);
      const auto before = wanted_.find(name);
      wanted[name] = before == wanted_.end() ? changes_ : before->second;
      if (const auto made = made_.find(name); made != made_.end()) made->second.used = changes_;
    }
    wanted_ = std::move(wanted);
    forget_old();
  }
  changed_.notify_all();
}

void StudioWorker::try_also(std::shared_ptr<const StudioPlan> plan) {
  {
    const std::scoped_lock lock(mutex_);
    tried_ = std::move(plan);
  }
  changed_.notify_all();
}

std::shared_ptr<const StudioSurface> StudioWorker::find(const std::string& name) const {
  const std::scoped_lock lock(mutex_);
  const auto found = made_.find(name);
  return found == made_.end() ? nullptr : found->second.surface;
}

std::string StudioWorker::problem_of(const std::string& name) const {
  const std::scoped_lock lock(mutex_);
  const auto found = made_.find(name);
  return found == made_.end() ? std::string() : found->second.problem;
}

void StudioWorker::forget_old() {
  while (made_.size() > wanted_.size() + k_most_entries) {
    auto oldest = made_.end();
    for (auto entry = made_.begin(); entry != made_.end(); ++entry)
      if (!wanted_.contains(entry->first) && (oldest == made_.end() || entry->second.used < oldest->second.used))
        oldest = entry;
    if (oldest == made_.end()) return;
    made_.erase(oldest);
  }
}

std::pair<std::shared_ptr<const StudioPlan>, const StudioWish*> StudioWorker::next(std::size_t& left) const {
  left = 0;
  const StudioWish* newest = nullptr;
  std::uint64_t since = 0;
  if (!plan_) return {};
  for (const StudioWish& wish : plan_->wishes) {
    const std::string name = short_name(wish.key);
    if (made_.contains(name)) continue;
    ++left;
    if (newest != nullptr && wanted_.at(name) <= since) continue;
    newest = &wish;
    since = wanted_.at(name);
  }
  if (newest != nullptr || !tried_) return {plan_, newest};
  for (const StudioWish& wish : tried_->wishes) {
    if (made_.contains(short_name(wish.key))) continue;
    ++left;
    if (newest == nullptr) newest = &wish;
  }
  return {tried_, newest};
}

bool StudioWorker::is_tried(const std::string& name) const {
  return tried_ && std::any_of(tried_->wishes.begin(), tried_->wishes.end(),
                               [&](const StudioWish& wish) { return short_name(wish.key) == name; });
}

void StudioWorker::run() {
  std::unique_lock lock(mutex_);
  bool was_working = false;
  while (!ends_) {
    std::size_t left = 0;
    const auto [plan, wish] = next(left);  // The plan keeps the wish.
    if (wish == nullptr && std::exchange(was_working, false)) {
      lock.unlock();
      handlers_.working(0, {});
      lock.lock();
      continue;
    }
    if (wish == nullptr) {
      changed_.wait(lock);
      continue;
    }
    was_working = true;
    const auto scene = scene_;
    lock.unlock();
    handlers_.working(left, wish->label);
    make(scene, plan, *wish, short_name(wish->key));
    lock.lock();
  }
}

void StudioWorker::make(const std::shared_ptr<StudioScene>& scene, const std::shared_ptr<const StudioPlan>& plan,
                        const StudioWish& wish, const std::string& name) {
  const auto is_wanted = [&](const Progress&) {
    const std::scoped_lock lock(mutex_);
    return !ends_ && scene_ == scene && (wanted_.contains(name) || is_tried(name));
  };
  Entry entry;
  try {
    entry.surface = std::make_shared<const StudioSurface>(scene->bake(*plan, wish, is_wanted));
  } catch (const Cancelled&) {
    return;
  } catch (const std::exception& error) {
    entry.problem = error.what();
  }
  {
    const std::scoped_lock lock(mutex_);
    if (scene_ != scene) return;
    entry.used = changes_;
    made_[name] = entry;
  }
  if (entry.surface)
    handlers_.ready(*entry.surface, name);
  else
    handlers_.failed(wish.label, name, entry.problem);
}

}  // namespace papilla::app
