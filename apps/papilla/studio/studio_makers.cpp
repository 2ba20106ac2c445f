// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_makers.hpp"

#include "studio/studio_feel.hpp"
#include "studio/studio_surface.hpp"

namespace papilla::app {
namespace {

StudioWorker::Handlers handlers_telling(StudioEvents& events) {
  return {
      [&events](const StudioSurface& surface, const std::string& name) {
        events.tell({{"event", "ready"}, {"surface", name}, {"label", surface.label}, {"seconds", surface.seconds}});
      },
      [&events](const std::string& label, const std::string& name, const std::string& problem) {
        events.tell({{"event", "failed"}, {"label", label}, {"surface", name}, {"problem", problem}});
      },
      [&events](std::size_t left, const std::string& label) {
        events.tell({{"event", "working"}, {"left", left}, {"label", label}});
      }};
}

}  // namespace

StudioMakers::StudioMakers(StudioEvents& events)
    : worker_(handlers_telling(events)), decals_(worker_), carriers_(worker_), atlases_([&events] {
        events.tell({{"event", "recipe-atlas"}});
      }) {}

void StudioMakers::want(const std::shared_ptr<StudioScene>& scene, const std::shared_ptr<const StudioPlan>& plan) {
  worker_.want(scene, plan);
  decals_.want(scene, plan);
  carriers_.want(scene, plan);
  atlases_.want(scene, plan);
}

void StudioMakers::try_also(const std::shared_ptr<const StudioPlan>& plan) {
  worker_.try_also(plan);
  decals_.try_also(plan);
}

std::vector<FeltSurface> StudioMakers::placed(const StudioScene& scene, const StudioPlan& plan) const {
  std::vector<FeltSurface> placed = placed_surfaces(scene, plan, worker_);
  for (const std::vector<FeltSurface>& more : {decals_.placed(), carriers_.placed()})
    placed.insert(placed.end(), more.begin(), more.end());
  return placed;
}

Json StudioMakers::surfaces_json(const StudioPlan& plan) const {
  Json list = Json::array();
  for (const StudioWish& wish : plan.wishes) {
    const std::string name = short_name(wish.key);
    const auto made = worker_.find(name);
    list.push_back({{"part", wish.part},
                    {"slot", wish.slot},
                    {"uses", wish.uses},
                    {"label", wish.label},
                    {"material", wish.material.empty() ? Json(nullptr) : Json(wish.material)},
                    {"name", name},
                    {"ready", made != nullptr},
                    {"problem", worker_.problem_of(name)}});
  }
  return list;
}

}  // namespace papilla::app
