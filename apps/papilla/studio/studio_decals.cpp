// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_decals.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {
namespace {

Json wish_json(const StudioDecalWish& wish) {
  Json surfaces = Json::array();
  for (const StudioDecalWish::Below& below : wish.below) surfaces.push_back(short_name(below.surface));
  return {{"number", wish.number}, {"name", short_name(wish.key)}, {"surfaces", surfaces}, {"problem", wish.problem}};
}

const StudioDecalWish* find_wish(const StudioPlan* plan, const std::string& name) {
  if (plan == nullptr) return nullptr;
  const auto found = std::find_if(plan->decals.begin(), plan->decals.end(),
                                  [&](const StudioDecalWish& wish) { return short_name(wish.key) == name; });
  return found == plan->decals.end() ? nullptr : &*found;
}

}  // namespace

void StudioDecals::want(std::shared_ptr<const StudioScene> scene, std::shared_ptr<const StudioPlan> plan) {
  const std::scoped_lock lock(mutex_);
  if (scene != scene_) made_.clear(), tried_.reset();
  scene_ = std::move(scene);
  plan_ = std::move(plan);
}

void StudioDecals::try_also(std::shared_ptr<const StudioPlan> plan) {
  const std::scoped_lock lock(mutex_);
  tried_ = std::move(plan);
}

Json StudioDecals::list(const StudioPlan& plan) { return changed(plan, {}); }

Json StudioDecals::changed(const StudioPlan& plan, const StudioPlan& shown) {
  std::set<std::string> known;
  for (const StudioDecalWish& wish : shown.decals) known.insert(wish.key);
  Json list = Json::array();
  for (const StudioDecalWish& wish : plan.decals)
    if (!known.contains(wish.key)) list.push_back(wish_json(wish));
  return list;
}

std::shared_ptr<const StudioDecal> StudioDecals::decal(const std::string& name) {
  const std::scoped_lock making(making_mutex_);
  std::shared_ptr<const StudioScene> scene;
  std::shared_ptr<const StudioPlan> plan;
  const StudioDecalWish* wish = nullptr;
  {
    const std::scoped_lock lock(mutex_);
    const auto known =
        std::find_if(made_.begin(), made_.end(), [&](const auto& decal) { return short_name(decal->key) == name; });
    if (known != made_.end()) {
      made_.splice(made_.begin(), made_, known);
      return made_.front();
    }
    scene = scene_;
    plan = plan_;
    wish = find_wish(plan.get(), name);
    if (wish == nullptr) {
      plan = tried_;
      wish = find_wish(plan.get(), name);
    }
  }
  if (!scene || wish == nullptr) throw InvalidInput("there is no such decal");
  std::vector<std::shared_ptr<const StudioSurface>> surfaces;
  for (const StudioDecalWish::Below& below : wish->below) {
    const std::string surface = short_name(below.surface);
    surfaces.push_back(worker_.find(surface));
    if (surfaces.back()) continue;
    if (worker_.problem_of(surface).empty()) throw InvalidInput("the surface is not there yet");
    surfaces.back() = std::make_shared<const StudioSurface>(scene->as_read(below.part, below.slot));
  }
  const auto made = std::make_shared<const StudioDecal>(scene->decal(*plan, *wish, surfaces));
  const std::scoped_lock lock(mutex_);
  if (scene == scene_) made_.push_front(made);
  if (made_.size() > k_most_made) made_.pop_back();
  return made;
}

SharedText StudioDecals::bytes(const std::string& name) { return decal_bytes(*decal(name)); }

PageAnswer StudioDecals::picture(const std::string& name, std::size_t number) {
  const auto made = decal(name);
  if (made->patches.empty()) throw InvalidInput("there is no such picture");
  return picture_answer(*made->patches.front().surface->look, number);
}

std::vector<FeltSurface> StudioDecals::placed() const {
  const std::scoped_lock lock(mutex_);
  std::vector<FeltSurface> placed;
  if (!scene_ || !plan_) return placed;
  for (const StudioDecalWish& wish : plan_->decals)
    for (const auto& decal : made_)
      if (decal->key == wish.key)
        for (const StudioDecal::Patch& patch : decal->patches)
          placed.push_back({patch.surface, scene_->uses().at(patch.use).world});
  return placed;
}

void add_decal_routes(StudioRoutes& routes, StudioDecals& decals) {
  routes.get["/decal"] = [&decals](const Query& query) {
    return bytes_answer("application/octet-stream", decals.bytes(required(query, "id")));
  };
  routes.get["/decal-picture"] = [&decals](const Query& query) {
    return decals.picture(required(query, "id"), number_of(query, "image"));
  };
}

}  // namespace papilla::app
