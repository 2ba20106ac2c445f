// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_atlases.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "papilla/core/error.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {
namespace {

constexpr int k_step = 32, k_least_side = 64;

/// The side of the picture of a surface that has a share of side x side texels.
int side_of(int side, double share) {
  return std::max(k_least_side, k_step * static_cast<int>(side * std::sqrt(share) / k_step));
}

}  // namespace

StudioAtlases::StudioAtlases(std::function<void()> made) : told_(std::move(made)), thread_([this] { run(); }) {}

StudioAtlases::~StudioAtlases() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StudioAtlases::want(std::shared_ptr<StudioScene> scene, std::shared_ptr<const StudioPlan> plan) {
  const std::scoped_lock lock(mutex_);
  if (scene != scene_) made_.clear(), jobs_.clear(), areas_mm2_.clear();
  scene_ = std::move(scene);
  plan_ = std::move(plan);
}

double StudioAtlases::area_mm2(const StudioWish& wish) {
  const auto [known, is_new] = areas_mm2_.try_emplace({wish.part, wish.slot}, 0);
  if (is_new) known->second = scene_->area_mm2(wish.part, wish.slot);
  return known->second;
}

const StudioAtlases::Entry* StudioAtlases::find(const std::function<bool(const Entry&)>& is) {
  const auto known = std::find_if(made_.begin(), made_.end(), is);
  if (known == made_.end()) return nullptr;
  made_.splice(made_.begin(), made_, known);
  return &made_.front();
}

std::vector<StudioAtlases::Laid> StudioAtlases::ask(const std::string& material, const ProceduralTexture& texture,
                                                    int side) {
  std::vector<Laid> list;
  {
    const std::scoped_lock lock(mutex_);
    if (!scene_ || !plan_ || material.empty()) return list;
    std::vector<std::pair<const StudioWish*, double>> wishes;
    double all_mm2 = 0;
    for (const StudioWish& wish : plan_->wishes) {
      if (wish.material != material) continue;
      wishes.emplace_back(&wish, area_mm2(wish));
      all_mm2 += wishes.back().second;
    }
    jobs_.clear();
    for (const auto& [wish, mm2] : wishes) {
      const int own = side_of(side, all_mm2 > 0 ? mm2 / all_mm2 : 1);
      Job job{plan_,
              wish,
              texture,
              own,
              short_name(recipe_atlas_key(*wish, texture, own)),
              short_name(recipe_atlas_key(*wish, texture, 0))};
      Laid& laid = list.emplace_back(Laid{wish->part, wish->slot, wish->uses.front(), job.name, nullptr, false, {}});
      const Entry* entry = find([&](const Entry& e) { return e.name == job.name; });
      if (entry == nullptr) {
        laid.is_under_way = true;
        entry = find([&](const Entry& e) { return e.any_side == job.any_side; });
        jobs_.push_back(std::move(job));
      }
      if (entry != nullptr) laid.name = entry->name, laid.atlas = entry->atlas, laid.problem = entry->problem;
    }
    while (made_.size() > wishes.size() + k_most_kept) made_.pop_back();
  }
  changed_.notify_all();
  return list;
}

SharedText StudioAtlases::bytes(const std::string& name) const {
  std::shared_ptr<const RecipeAtlas> atlas;
  {
    const std::scoped_lock lock(mutex_);
    const auto known = std::find_if(made_.begin(), made_.end(), [&](const Entry& entry) { return entry.name == name; });
    if (known != made_.end()) atlas = known->atlas;
  }
  if (!atlas) throw InvalidInput("there is no such atlas");
  return mesh_bytes(atlas->mesh);
}

void StudioAtlases::run() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    if (jobs_.empty()) {
      changed_.wait(lock);
      continue;
    }
    const Job job = jobs_.front();
    jobs_.pop_front();
    const auto scene = scene_;
    if (find([&](const Entry& e) { return e.name == job.name; }) != nullptr) continue;
    lock.unlock();
    Entry entry = make(*scene, job);
    lock.lock();
    if (ends_ || scene != scene_) continue;
    made_.push_front(std::move(entry));
    lock.unlock();
    told_();
    lock.lock();
  }
}

StudioAtlases::Entry StudioAtlases::make(StudioScene& scene, const Job& job) {
  Entry entry{job.name, job.any_side, nullptr, {}};
  const auto is_wanted = [&](const Progress&) {
    const std::scoped_lock lock(mutex_);
    return !ends_ && scene_.get() == &scene;
  };
  try {
    entry.atlas = scene.recipe_atlas(*job.plan, *job.wish, job.texture, job.side, is_wanted);
  } catch (const std::exception& error) {
    entry.problem = error.what();
  }
  return entry;
}

void add_atlas_routes(StudioRoutes& routes, StudioAtlases& atlases) {
  routes.get["/recipe-atlas"] = [&atlases](const Query& query) {
    return bytes_answer("application/octet-stream", atlases.bytes(required(query, "id")));
  };
}

}  // namespace papilla::app
