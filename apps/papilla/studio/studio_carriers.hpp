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

/// The carriers of a document, made when they are asked for and their surfaces are there.
class StudioCarrierMaker {
 public:
  explicit StudioCarrierMaker(const StudioWorker& worker) : worker_(worker) {}

  /// Another scene, or a document for it.
  void want(std::shared_ptr<const StudioScene> scene, std::shared_ptr<const StudioPlan> plan);

  /// {"name", "surfaces": names of those of which they take something, "problems": one for each entry} of a plan's
  /// carriers; null when it has none.
  static Json wanted(const StudioPlan& plan);

  /// carrier_bytes(). @param name as in wanted(). @throws InvalidInput when nothing wants them or a surface is not
  /// there yet; as StudioScene::carriers().
  SharedText bytes(const std::string& name);
  /// A picture of the look of a rectangle.
  PageAnswer picture(const std::string& name, std::size_t rectangle, std::size_t number);
  /// Of the document, if they were made.
  std::vector<FeltSurface> placed() const;

 private:
  static constexpr std::size_t k_most_made = 8;

  std::shared_ptr<const StudioCarriers> carriers(const std::string& name);

  const StudioWorker& worker_;
  mutable std::mutex mutex_;
  std::mutex making_mutex_;  ///< One after the other.
  std::shared_ptr<const StudioScene> scene_;
  std::shared_ptr<const StudioPlan> plan_;
  std::list<std::shared_ptr<const StudioCarriers>> made_;  ///< Used last, first.
};

/// GET /carriers?id=NAME, /carrier-picture?id=NAME&rectangle=N&image=N.
void add_carrier_routes(StudioRoutes& routes, StudioCarrierMaker& carriers);

}  // namespace papilla::app
