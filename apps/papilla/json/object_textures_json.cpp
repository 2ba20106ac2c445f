// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/scene_json.hpp"

namespace papilla::app {

Json object_textures_json(const ObjectTextures& made, const ObjectTexturePlaces& places) {
  Json json = {{"decals", Json::array()}, {"replace", Json::array()}};
  for (std::size_t i = 0; i < made.decals.size(); ++i) {
    const DecalReport& decal = made.decals[i];
    json["decals"].push_back({{"name", decal.name},
                              {"for", places.decal_uses.at(i).selector},
                              {"surfaces", decal.surfaces},
                              {"triangles", decal.triangles},
                              {"turned_off", decal.turned_off},
                              {"area_mm2", decal.area_mm2},
                              {"offset_mm", decal.offset_mm},
                              {"relief_mm", decal.relief_mm}});
  }
  for (std::size_t i = 0; i < made.carriers.size(); ++i) {
    const CarrierReport& carrier = made.carriers[i];
    json["replace"].push_back({{"name", carrier.name},
                               {"for", places.carrier_uses.at(i).selector},
                               {"carriers", carrier.carriers},
                               {"triangles_before", carrier.triangles},
                               {"triangles_after", 2 * carrier.carriers},
                               {"saved", carrier.saved()},
                               {"relief_mm", carrier.relief_mm}});
  }
  return json;
}

}  // namespace papilla::app
