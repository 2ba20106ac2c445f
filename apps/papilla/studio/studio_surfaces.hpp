// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "papilla/cache/stage_cache.hpp"
#include "studio/studio_desk.hpp"
#include "studio/studio_http.hpp"
#include "studio/studio_worker.hpp"

namespace papilla::app {

/// Surfaces as pages ask for them: those that were made by "id", those as they were read by "part" and "slot".
class StudioSurfaces {
 public:
  /// @param cache  of levels of detail; may be null.
  StudioSurfaces(const StudioDesk& desk, const StudioWorker& worker, const StageCache* cache)
      : desk_(desk), worker_(worker), cache_(cache) {}

  PageAnswer surface(const Query& query) const;
  /// Levels of detail of a surface that was made, by the code of the bake and with its cache; none of one that is gone.
  PageAnswer levels(const Query& query) const;
  PageAnswer height(const Query& query) const;
  PageAnswer picture(const Query& query) const;

  /// Levels that are being made are given up.
  void cancel() noexcept { is_cancelled_ = true; }

 private:
  /// @throws InvalidInput when there is none.
  std::shared_ptr<const StudioSurface> asked(const Query& query) const;

  const StudioDesk& desk_;
  const StudioWorker& worker_;
  const StageCache* cache_;
  std::atomic<bool> is_cancelled_{false};
  mutable std::mutex levels_mutex_;  ///< One after the other: each uses all processors.
};

/// GET /surface, /levels, /height, /picture.
void add_surface_routes(StudioRoutes& routes, const StudioSurfaces& surfaces);

}  // namespace papilla::app
