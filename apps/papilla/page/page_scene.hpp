// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "page/page_levels.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/pipeline/environment.hpp"
#include "verb.hpp"

namespace papilla::app {

struct PageSceneOptions {
  std::size_t triangles = 250000;                      ///< That the page shows, about; more are simplified. At least 1.
  std::optional<EnvironmentPicture> environment = {};  ///< Lights the scene; nothing: a plain room does.
  std::vector<PageLevels> levels = {};                 ///< Of read_for_page().
};

/// A scene as data of the page.
struct PageScene {
  Json json;
  std::size_t triangles = 0, triangles_shown = 0;  ///< Of the finest levels of detail.
  double error_mm = 0;                             ///< Of the simplification.
};

/// A scene as the report page shows it: parts in compressed streams (PageMesh), instances, materials with their haptic
/// tags, pictures and environments, height maps (byte for byte, each once, checked against the tag's SHA-256) in
/// base64. Distortion is measured for every part with uv.
/// @param file the scene's own: height maps beside it are found from here.
/// @throws InvalidInput as instances() and measure_distortion().
PageScene page_scene(const Scene& scene, const std::filesystem::path& file, const PageSceneOptions& options,
                     const ProgressCallback& progress);

}  // namespace papilla::app
