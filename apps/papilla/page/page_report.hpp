// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "json/json.hpp"
#include "page/page_scene.hpp"
#include "papilla/core/progress.hpp"
#include "papilla/pipeline/grain.hpp"

namespace papilla::app {

/// Writes the page of a baked file: the scene as it was written, and the report of bake with small photographs of the
/// grains' pictures.
/// @throws IoError, InvalidInput as read_gltf() and write_page().
void write_report_page(const std::filesystem::path& glb, Json report, const std::map<std::string, Grain>& grains,
                       const std::filesystem::path& page, const PageSceneOptions& options,
                       const ProgressCallback& progress);

}  // namespace papilla::app
