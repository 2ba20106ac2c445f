// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_carriers.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "papilla/core/error.hpp"
#include "studio/studio_answers.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {

void StudioCarrierMaker::want(std::shared_ptr<const StudioScene> scene, std::shared_ptr<const StudioPlan> plan) {
  const std::scoped_lock lock(mutex_);
  if (scene != scene_) made_.clear();
  scene_ = std::move(scene);
  plan_ = std::move(plan);
}

Json StudioCarrierMaker::wanted(const StudioPlan& plan) {
  if (!plan.carriers) return nullptr;
  std::set<std::string> surfaces;
  for (const StudioCarrierWish::Use& use : plan.carriers->uses)
    for (const StudioCarrierWish::Surface& surface : use.surfaces) surfaces.insert(short_name(surface.surface));
  Json problems = Json::array();
  for (const RuleUse& use : plan.carriers->selected) problems.push_back(use.problem);
  return {{"name", short_name(plan.carriers->key)}, {"surfaces", surfaces}, {"problems", problems}};
}

std::shared_ptr<const StudioCarriers> StudioCarrierMaker::carriers(const std::string& name) {
  const std::scoped_lock making(making_mutex_);
  std::shared_ptr<const StudioScene> scene;
  std::shared_ptr<const StudioPlan> plan;
  {
    const std::scoped_lock lock(mutex_);
    const auto known =
        std::find_if(made_.begin(), made_.end(), [&](const auto& made) { return short_name(made->key) == name; });
    if (known != made_.end()) {
      made_.splice(made_.begin(), made_, known);
      return made_.front();
    }
    scene = scene_;
    plan = plan_;
  }
  if (!scene || !plan || !plan->carriers || short_name(plan->carriers->key) != name)
    throw InvalidInput("there are no such carriers");
  std::map<std::string, std::shared_ptr<const StudioSurface>> surfaces;
  for (const StudioCarrierWish::Use& use : plan->carriers->uses)
    for (const StudioCarrierWish::Surface& surface : use.surfaces) {
      const std::string wanted = short_name(surface.surface);
      if (const auto made = worker_.find(wanted))
        surfaces[surface.surface] = made;
      else if (worker_.problem_of(wanted).empty())
        throw InvalidInput("a surface is not there yet");
    }
  const auto made = std::make_shared<const StudioCarriers>(scene->carriers(*plan, surfaces));
  const std::scoped_lock lock(mutex_);
  if (scene == scene_) made_.push_front(made);
  if (made_.size() > k_most_made) made_.pop_back();
  return made;
}

SharedText StudioCarrierMaker::bytes(const std::string& name) { return carrier_bytes(*carriers(name)); }

PageAnswer StudioCarrierMaker::picture(const std::string& name, std::size_t rectangle, std::size_t number) {
  const auto made = carriers(name);
  if (rectangle >= made->rectangles.size()) throw InvalidInput("there is no such picture");
  return picture_answer(*made->rectangles[rectangle].surface->look, number);
}

std::vector<FeltSurface> StudioCarrierMaker::placed() const {
  const std::scoped_lock lock(mutex_);
  std::vector<FeltSurface> placed;
  if (!scene_ || !plan_ || !plan_->carriers) return placed;
  for (const auto& made : made_)
    if (made->key == plan_->carriers->key)
      for (const StudioCarriers::Rectangle& rectangle : made->rectangles)
        placed.push_back({rectangle.surface, rectangle.world});
  return placed;
}

void add_carrier_routes(StudioRoutes& routes, StudioCarrierMaker& carriers) {
  routes.get["/carriers"] = [&carriers](const Query& query) {
    return bytes_answer("application/octet-stream", carriers.bytes(required(query, "id")));
  };
  routes.get["/carrier-picture"] = [&carriers](const Query& query) {
    return carriers.picture(required(query, "id"), number_of(query, "rectangle"), number_of(query, "image"));
  };
}

}  // namespace papilla::app
