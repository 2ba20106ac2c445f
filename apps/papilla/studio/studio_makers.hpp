// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "papilla/pipeline/studio/felt_scene.hpp"
#include "studio/studio_atlases.hpp"
#include "studio/studio_carriers.hpp"
#include "studio/studio_decals.hpp"
#include "studio/studio_events.hpp"
#include "studio/studio_worker.hpp"

namespace papilla::app {

/// All that is made of a scene and a document: surfaces, what lies on them and stands for them, atlases of recipes.
class StudioMakers {
 public:
  /// @param events  told of what is there.
  explicit StudioMakers(StudioEvents& events);

  StudioWorker& worker() noexcept { return worker_; }
  const StudioWorker& worker() const noexcept { return worker_; }
  StudioDecals& decals() noexcept { return decals_; }
  StudioCarrierMaker& carriers() noexcept { return carriers_; }
  StudioAtlases& atlases() noexcept { return atlases_; }

  /// Another scene, or a document for it.
  void want(const std::shared_ptr<StudioScene>& scene, const std::shared_ptr<const StudioPlan>& plan);
  /// What a document would have, for the scene of want().
  void try_also(const std::shared_ptr<const StudioPlan>& plan);

  /// What can be felt: that was made of a document.
  std::vector<FeltSurface> placed(const StudioScene& scene, const StudioPlan& plan) const;
  /// [{"part", "slot", "uses", "label", "material", "name", "ready", "problem"}] of a plan's surfaces.
  Json surfaces_json(const StudioPlan& plan) const;

 private:
  StudioWorker worker_;
  StudioDecals decals_;
  StudioCarrierMaker carriers_;
  StudioAtlases atlases_;
};

}  // namespace papilla::app
