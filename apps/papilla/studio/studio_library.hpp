// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include "json/json.hpp"
#include "papilla/cache/stage_cache.hpp"
#include "papilla/procedural/library.hpp"
#include "studio/studio_http.hpp"

namespace papilla::app {

/// The library of materials, with pictures.
class StudioLibrary {
 public:
  /// @param folder  of the library; empty: find_material_library(). @param cache  may be null.
  StudioLibrary(std::filesystem::path folder, const RecipeLibrary& recipes, const StageCache* cache)
      : folder_(std::move(folder)), recipes_(recipes), cache_(cache) {}

  /// [library_material_json()].
  Json list() const;
  /// A lit ball and the relief, as PNG. The grain is remembered, so that the material is there at once when it is used.
  SharedText picture(const std::string& id) const;

 private:
  std::filesystem::path folder() const;

  const std::filesystem::path folder_;
  const RecipeLibrary& recipes_;
  const StageCache* cache_;
  mutable std::mutex mutex_;  ///< One picture after the other: what is edited goes before.
};

/// GET /library, /library-picture?id=ID.
void add_library_routes(StudioRoutes& routes, const StudioLibrary& library);

}  // namespace papilla::app
