// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_report.hpp"

#include "page/card_photo.hpp"
#include "page/page_file.hpp"

namespace papilla::app {

void write_report_page(const std::filesystem::path& glb, Json report, const std::map<std::string, Grain>& grains,
                       const std::filesystem::path& page, const PageSceneOptions& options,
                       const ProgressCallback& progress) {
  for (Json& material : report["materials"]) {
    const ColorImage& photograph = grains.at(material["name"].get<std::string>()).photograph;
    material["photo"] = card_photo(photograph);
  }
  PageSceneOptions shown = options;
  const Scene scene = read_for_page(glb, {}, shown.levels);
  write_page({glb.filename().string(), page_scene(scene, glb, shown, progress).json, std::move(report)}, page);
}

}  // namespace papilla::app
