// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/scene_json.hpp"

namespace papilla::app {

Json sides_json(const SceneSides& sides, const SceneSideOptions& options) {
  if (options.keep) return nullptr;
  const bool has_eye = sides.viewpoint == Viewpoint::inside || sides.viewpoint == Viewpoint::room;
  Json json{{"seen_from", to_string(sides.viewpoint)},
            {"eye_mm", has_eye ? Json{sides.eye.x, sides.eye.y, sides.eye.z} : Json(nullptr)},
            {"enclosure", sides.viewpoint == Viewpoint::room ? Json(sides.enclosure) : Json(nullptr)},
            {"open_components", sides.open_components},
            {"facing_away", sides.facing_away},
            {"ambiguous", sides.ambiguous},
            {"skipped", sides.skipped.empty() ? Json(nullptr) : Json(sides.skipped)},
            {"parts", Json::array()}};
  for (const PartSides& part : sides.parts) {
    Json reasons = Json::array();
    for (const SideReason reason : part.reasons) reasons.push_back(to_string(reason));
    json["parts"].push_back({{"part", part.part},
                             {"open_components", part.open_components},
                             {"facing_away", part.facing_away},
                             {"ambiguous", part.ambiguous},
                             {"turned_triangles", part.turned_triangles},
                             {"left_facing_away", part.left_facing_away},
                             {"left_ambiguous", part.left_ambiguous},
                             {"reasons", std::move(reasons)}});
  }
  return json;
}

}  // namespace papilla::app
