// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "json/json.hpp"
#include "papilla/pipeline/studio/felt_scene.hpp"
#include "studio/studio_http.hpp"
#include "studio/studio_worker.hpp"

namespace papilla::app {

/// The decals of a document, each made when it is asked for and its surfaces are there.
class StudioDecals {
 public:
  explicit StudioDecals(const StudioWorker& worker) : worker_(worker) {}

  /// Another scene, or a document for it.
  void want(std::shared_ptr<const StudioScene> scene, std::shared_ptr<const StudioPlan> plan);
  /// A document that is only tried, for the scene of want(). The newest wins.
  void try_also(std::shared_ptr<const StudioPlan> plan);

  /// [{"number", "name", "surfaces": names of those that it may lie on, "problem"}] of a plan's decals.
  static Json list(const StudioPlan& plan);
  /// Those of `plan` that are not among `shown`.
  static Json changed(const StudioPlan& plan, const StudioPlan& shown);

  /// decal_bytes(). @param name as in list(). @throws InvalidInput when nothing wants it or a surface is not there yet;
  /// as StudioScene::decal().
  SharedText bytes(const std::string& name);
  /// A picture of its look.
  PageAnswer picture(const std::string& name, std::size_t number);
  /// Of the document, those that were made.
  std::vector<FeltSurface> placed() const;

 private:
  static constexpr std::size_t k_most_made = 64;

  std::shared_ptr<const StudioDecal> decal(const std::string& name);

  const StudioWorker& worker_;
  mutable std::mutex mutex_;
  std::mutex making_mutex_;  ///< One after the other.
  std::shared_ptr<const StudioScene> scene_;
  std::shared_ptr<const StudioPlan> plan_, tried_;
  std::list<std::shared_ptr<const StudioDecal>> made_;  ///< Used last, first.
};

/// GET /decal?id=NAME, /decal-picture?id=NAME&image=N.
void add_decal_routes(StudioRoutes& routes, StudioDecals& decals);

}  // namespace papilla::app
