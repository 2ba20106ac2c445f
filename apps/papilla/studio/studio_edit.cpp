// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_edit.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "papilla/core/error.hpp"

namespace papilla::app {
namespace {

StudioEdit::Kind kind_of(const std::string& name) {
  using Kind = StudioEdit::Kind;
  static const std::map<std::string, Kind> kinds = {{"assign", Kind::assign},
                                                    {"vary", Kind::vary},
                                                    {"set", Kind::set},
                                                    {"add", Kind::add},
                                                    {"remove", Kind::remove},
                                                    {"add-decal", Kind::add_decal},
                                                    {"set-decal", Kind::set_decal},
                                                    {"remove-decal", Kind::remove_decal},
                                                    {"add-carrier", Kind::add_carrier},
                                                    {"set-carrier", Kind::set_carrier},
                                                    {"remove-carrier", Kind::remove_carrier}};
  const auto kind = kinds.find(name);
  if (kind == kinds.end()) throw InvalidInput("there is no such kind of change");
  return kind->second;
}

SurfaceSelector onto_of(const Json& onto, const StudioScene* scene) {
  if (onto.is_null()) return {};
  const auto use = onto.get<std::uint32_t>();
  if (scene == nullptr || use >= scene->uses().size()) throw InvalidInput("there is no such place of a part");
  return scene->selector_of_use(use);
}

}  // namespace

StudioEdit edit_of(const Json& json, const StudioScene* scene) {
  StudioEdit edit;
  edit.kind = kind_of(json.at("kind").get<std::string>());
  edit.material = json.value("material", std::string());
  edit.title = json.value("title", std::string());
  edit.number = json.value(json.contains("carrier") ? "carrier" : "decal", std::size_t{0});
  if (const auto onto = json.find("onto"); onto != json.end()) edit.onto = onto_of(*onto, scene);
  if (const auto values = json.find("values"); values != json.end())
    for (const auto& [pointer, value] : values->items()) edit.values[pointer] = value.dump();
  if (const auto surfaces = json.find("surfaces"); surfaces != json.end())
    for (const Json& surface : *surfaces) {
      const auto part = surface.at(0).get<std::uint32_t>(), slot = surface.at(1).get<std::uint32_t>();
      if (scene == nullptr || part >= scene->scene().parts.size()) throw InvalidInput("there is no such surface");
      for (SurfaceSelector& selector : scene->selectors(part, slot)) edit.surfaces.push_back(std::move(selector));
    }
  return edit;
}

}  // namespace papilla::app
