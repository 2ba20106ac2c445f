// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "papilla/pipeline/studio/recipe_atlas.hpp"
#include "papilla/pipeline/studio/studio_scene.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

/// The surfaces of a material laid out for a recipe that reads them: each once, in a thread of its own, and kept for
/// the looks that follow.
class StudioAtlases {
 public:
  struct Laid {
    std::uint32_t part = 0, slot = 0, use = 0;  ///< StudioWish, its first use.
    std::string name;                           ///< For bytes().
    std::shared_ptr<const RecipeAtlas> atlas;   ///< Null: under way, or nothing to be painted.
    bool is_under_way = false;                  ///< With an atlas: that one has another side.
    std::string problem;                        ///< Why it could not be made; empty.
  };

  /// @param made  called from the thread when another atlas is there.
  explicit StudioAtlases(std::function<void()> made);
  ~StudioAtlases();  ///< Gives up what runs.
  StudioAtlases(const StudioAtlases&) = delete;
  StudioAtlases& operator=(const StudioAtlases&) = delete;

  /// Another scene, or a document for it. The newest wins.
  void want(std::shared_ptr<StudioScene> scene, std::shared_ptr<const StudioPlan> plan);

  /// The surfaces of a material, as far as they are laid out; those that are not are made next. They share side x side
  /// texels by their areas, in steps of 32 texels of their sides, at least 64.
  /// @param texture  of the recipe, not seamless.
  std::vector<Laid> ask(const std::string& material, const ProceduralTexture& texture, int side);

  /// `RecipeAtlas::mesh` as a surface's arrays. @throws InvalidInput when it is gone.
  SharedText bytes(const std::string& name) const;

 private:
  static constexpr std::size_t k_most_kept = 64;  ///< Beside those that were asked for last.
  struct Job {
    std::shared_ptr<const StudioPlan> plan;
    const StudioWish* wish = nullptr;  ///< Of the plan.
    ProceduralTexture texture;
    int side = 0;
    std::string name, any_side;  ///< Short names of recipe_atlas_key(), and of that without the side.
  };
  struct Entry {
    std::string name, any_side;
    std::shared_ptr<const RecipeAtlas> atlas;
    std::string problem;
  };

  void run();
  Entry make(StudioScene& scene, const Job& job);
  /// @pre locked.
  double area_mm2(const StudioWish& wish);
  /// Used now. @pre locked. @return null: there is none.
  const Entry* find(const std::function<bool(const Entry&)>& is);

  std::function<void()> told_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false;
  std::shared_ptr<StudioScene> scene_;
  std::shared_ptr<const StudioPlan> plan_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> areas_mm2_;  ///< By part and slot.
  std::deque<Job> jobs_;                                                 ///< That were asked for last.
  std::list<Entry> made_;                                                ///< Used last, first.
  std::thread thread_;
};

/// GET /recipe-atlas?id=NAME.
void add_atlas_routes(StudioRoutes& routes, StudioAtlases& atlases);

}  // namespace papilla::app
