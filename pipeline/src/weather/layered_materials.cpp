// SPDX-License-Identifier: MIT
#include "weather/layered_materials.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "papilla/core/glob.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla {
namespace {

bool fits_material(const WeatherLayer& layer, const SurfacePlace& place) {
  return !place.materials.empty() &&
         std::any_of(layer.materials.begin(), layer.materials.end(),
                     [&](const std::string& pattern) { return matches_glob(pattern, place.materials.front()); });
}

std::string text_of(const WeatherLayer& layer) {
  std::string text;
  for (const std::string& pattern : layer.materials) text += (text.empty() ? "" : ", ") + ("'" + shown(pattern) + "'");
  const std::string where = text_of(layer.where);
  return "materials " + text + (where.empty() ? "" : ", " + where);
}

std::string reason_for_nothing(const WeatherLayer& layer, const std::vector<SurfacePlace>& places) {
  std::vector<SurfacePlace> of_material;
  std::set<std::string_view> names;
  for (const SurfacePlace& place : places) {
    if (fits_material(layer, place)) of_material.push_back(place);
    if (!place.materials.empty()) names.insert(place.materials.front());
  }
  if (names.empty()) return "no surface has a material";
  if (!of_material.empty()) return reason_for_nothing(layer.where, of_material);
  return text_of(layer) + " matches nothing" +
         (layer.materials.empty() ? "" : did_you_mean(layer.materials.front(), {names.begin(), names.end()}));
}

}  // namespace

LayeredScene layer_materials(const Scene& scene, const WeatherConfig& config) {
  const std::vector<SurfacePlace> places = surface_places(scene);
  using Layers = std::vector<std::uint32_t>;
  std::map<Layers, std::uint32_t> label_of{{{}, 0}};
  std::vector<Layers> layers_of_label{{}};
  std::vector<std::uint32_t> labels;
  std::vector<std::set<std::pair<std::uint32_t, std::uint32_t>>> surfaces(config.layers.size());
  LayeredScene result;
  result.uses.resize(config.layers.size());
  for (const SurfacePlace& place : places) {
    Layers layers;
    for (std::uint32_t l = 0; l < config.layers.size(); ++l) {
      if (!fits_material(config.layers[l], place) || !fits(config.layers[l].where, place)) continue;
      layers.push_back(l);
      surfaces[l].insert({place.part, place.slot});
      ++result.uses[l].uses;
    }
    const auto [it, is_new] = label_of.try_emplace(layers, static_cast<std::uint32_t>(layers_of_label.size()));
    if (is_new) layers_of_label.push_back(layers);
    labels.push_back(it->second);
  }
  for (std::size_t l = 0; l < config.layers.size(); ++l) {
    result.uses[l].selector = text_of(config.layers[l]);
    result.uses[l].surfaces = surfaces[l].size();
    if (surfaces[l].empty()) result.uses[l].problem = reason_for_nothing(config.layers[l], places);
  }

  result.layers.resize(scene.materials.size());
  // By material, then by label: the material that has those layers. The first label keeps the material.
  std::vector<std::map<std::uint32_t, std::uint32_t>> made(scene.materials.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::vector<std::uint32_t>& materials = scene.parts[places[i].part].materials;
    if (places[i].slot >= materials.size()) continue;
    const std::uint32_t material = materials[places[i].slot];
    if (made[material].empty()) result.layers[material] = layers_of_label[labels[i]];
    made[material].try_emplace(labels[i], material);
  }
  if (std::all_of(made.begin(), made.end(), [](const auto& materials) { return materials.size() < 2; })) return result;

  Scene& split = result.scene.emplace(scene);
  split_by_label(split, places, labels);
  std::set<std::string> names;
  for (const Material& material : split.materials) names.insert(material.name);
  std::vector<std::uint8_t> is_taken(scene.materials.size(), 0);
  for (auto& materials : made) materials.clear();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SurfacePlace& place = places[i];
    const std::vector<std::uint32_t>& before = scene.parts[place.part].materials;
    if (place.slot >= before.size()) continue;
    const std::uint32_t material = before[place.slot];
    const auto [it, is_new] = made[material].try_emplace(labels[i], material);
    if (is_new && std::exchange(is_taken[material], std::uint8_t{1}) != 0) {
      it->second = static_cast<std::uint32_t>(split.materials.size());
      Material copy = scene.materials[material];
      for (int n = 2; !names.insert(copy.name).second; ++n)
        copy.name = scene.materials[material].name + " " + std::to_string(n);
      split.materials.push_back(std::move(copy));
      result.layers.push_back(layers_of_label[labels[i]]);
    }
    const std::uint32_t part = place.node ? split.nodes[*place.node].part.value() : place.part;
    split.parts[part].materials[place.slot] = it->second;
  }
  return result;
}

}  // namespace papilla
