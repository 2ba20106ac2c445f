// SPDX-License-Identifier: MIT
#include "papilla/pipeline/surface_selector.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "papilla/core/glob.hpp"
#include "papilla/core/near_name.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/pipeline/hex_colour.hpp"

namespace papilla {
namespace {

constexpr std::array<SelectorKey, 9> k_keys = {{
    {"part", &SurfaceSelector::part, &SurfacePlace::parts, SelectorKey::Kind::glob},
    {"mesh", &SurfaceSelector::mesh, &SurfacePlace::meshes, SelectorKey::Kind::glob},
    {"node", &SurfaceSelector::node, &SurfacePlace::nodes, SelectorKey::Kind::path_glob},
    {"instance", &SurfaceSelector::instance, &SurfacePlace::instances, SelectorKey::Kind::glob},
    {"assembly", &SurfaceSelector::assembly, &SurfacePlace::assemblies, SelectorKey::Kind::glob},
    {"layer", &SurfaceSelector::layer, &SurfacePlace::layers, SelectorKey::Kind::glob},
    {"cad_material", &SurfaceSelector::cad_material, &SurfacePlace::cad_materials, SelectorKey::Kind::glob},
    {"cad_colour", &SurfaceSelector::cad_colour, &SurfacePlace::colours, SelectorKey::Kind::colour},
    {"gltf_material", &SurfaceSelector::gltf_material, &SurfacePlace::materials, SelectorKey::Kind::glob},
}};

bool fits_name(SelectorKey::Kind kind, const std::string& pattern, const std::string& name) {
  switch (kind) {
    case SelectorKey::Kind::glob: break;
    case SelectorKey::Kind::path_glob: return matches_path_glob(pattern, name);
    case SelectorKey::Kind::colour: return pattern == name;
  }
  return matches_glob(pattern, name);
}

bool fits_key(const SelectorKey& key, const std::string& pattern, const SurfacePlace& place) {
  const std::vector<std::string>& names = place.*key.names;
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return fits_name(key.kind, pattern, name); });
}

/// Whether all keys fit; exceptions are not looked at.
bool fits_keys(const SurfaceSelector& selector, const SurfacePlace& place) {
  return std::all_of(k_keys.begin(), k_keys.end(), [&](const SelectorKey& key) {
    const auto& pattern = selector.*key.pattern;
    return !pattern || fits_key(key, *pattern, place);
  });
}

/// Adds what the extras of a CAD file's part or node say of layers and of the physical material.
void add_cad_names(const std::string& extras_json, SurfacePlace& place) {
  if (extras_json.find("\"layers\"") == std::string::npos && extras_json.find("\"cad_material\"") == std::string::npos)
    return;
  const auto extras = nlohmann::json::parse(extras_json, nullptr, false);
  if (!extras.is_object()) return;
  if (const auto layers = extras.find("layers"); layers != extras.end() && layers->is_array())
    for (const auto& layer : *layers)
      if (layer.is_string()) place.layers.push_back(layer.get<std::string>());
  if (const auto material = extras.find("cad_material"); material != extras.end() && material->is_object())
    if (const auto name = material->find("name"); name != material->end() && name->is_string())
      place.cad_materials.push_back(name->get<std::string>());
}

std::vector<std::uint32_t> used_slots(const TriangleMesh& mesh) {
  if (mesh.material.empty()) return {0};
  std::vector<std::uint8_t> used;
  for (const std::uint32_t slot : mesh.material) {
    if (slot >= used.size()) used.resize(slot + std::size_t{1}, 0);
    used[slot] = 1;
  }
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < used.size(); ++slot)
    if (used[slot] != 0) slots.push_back(slot);
  return slots;
}

std::vector<std::string> steps_of(std::string_view path) {
  std::vector<std::string> steps;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    steps.emplace_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return steps;
}

/// "; did you mean ..." of the first name in a path's pattern that no path has.
std::string near_step(const std::string& pattern, const std::set<std::string_view>& paths) {
  std::set<std::string> known;
  for (const std::string_view path : paths)
    for (std::string& step : steps_of(path)) known.insert(std::move(step));
  for (const std::string& step : steps_of(pattern))
    if (step != "**" &&
        std::none_of(known.begin(), known.end(), [&](const std::string& name) { return matches_glob(step, name); }))
      return did_you_mean(step, {known.begin(), known.end()});
  return "";
}

/// "; did you mean ..." of the names that a key is compared with.
std::string near_name(const SelectorKey& key, const std::string& pattern, const std::vector<SurfacePlace>& places) {
  std::set<std::string_view> names;
  for (const SurfacePlace& place : places) names.insert((place.*key.names).begin(), (place.*key.names).end());
  if (key.kind == SelectorKey::Kind::path_glob) {
    const std::string anywhere = "**/" + pattern;
    if (std::any_of(names.begin(), names.end(),
                    [&](std::string_view name) { return matches_path_glob(anywhere, std::string(name)); }))
      return "; did you mean '" + shown(anywhere) + "'?";
  }
  if (names.empty()) return "; the scene has none";
  std::string near = did_you_mean(pattern, {names.begin(), names.end()});
  if (near.empty() && key.kind == SelectorKey::Kind::path_glob) near = near_step(pattern, names);
  return near;
}

std::string quoted_key(const SelectorKey& key, const std::string& pattern) {
  return std::string(key.name) + " '" + shown(pattern) + "'";
}

}  // namespace

std::span<const SelectorKey> selector_keys() noexcept { return k_keys; }

bool SurfaceSelector::is_empty() const {
  return except.empty() && std::none_of(k_keys.begin(), k_keys.end(),
                                        [&](const SelectorKey& key) { return (this->*key.pattern).has_value(); });
}

std::vector<SurfacePlace> surface_places(const Scene& scene, std::span<const GltfOrigin::Level> levels) {
  const std::vector<NodePlace> nodes = node_places(scene);
  std::vector<std::vector<std::uint32_t>> slots;
  for (const Part& part : scene.parts) slots.push_back(used_slots(part.mesh));
  std::vector<SurfacePlace> places;
  // @param named  the part that gives the names.
  const auto add = [&](SurfacePlace place, std::uint32_t named) {
    const Part& part = scene.parts[place.part];
    const std::string& mesh = scene.parts[named].name;
    place.parts = {shown_name(scene.parts[named])};
    if (!mesh.empty()) place.meshes = {mesh};
    add_cad_names(part.extras_json, place);
    for (const std::uint32_t slot : slots[place.part]) {
      SurfacePlace& surface = places.emplace_back(place);
      surface.slot = slot;
      if (slot >= part.materials.size()) continue;
      const Material& material = scene.materials[part.materials[slot]];
      surface.colours = {hex_colour(material.base_color)};
      surface.materials = {material.name};
    }
  };
  const auto place_at = [&](std::uint32_t node) {
    SurfacePlace place;
    place.nodes = {nodes[node].path};
    place.instances = {nodes[node].name};
    for (std::optional<std::uint32_t> n = node; n; n = nodes[*n].parent) {
      if (*n != node) place.assemblies.push_back(nodes[*n].name);
      add_cad_names(scene.nodes[*n].extras_json, place);
    }
    return place;
  };
  std::vector<std::uint8_t> is_shown(scene.parts.size(), 0);
  for (const Instance& use : instances(scene)) {
    SurfacePlace place = place_at(use.node);
    place.part = use.part;
    place.node = use.node;
    is_shown[use.part] = 1;
    add(std::move(place), use.part);
  }
  for (std::uint32_t i = 0; i < levels.size(); ++i) {
    SurfacePlace place = place_at(levels[i].finest);
    place.part = levels[i].part;
    place.level = i;
    is_shown[place.part] = 1;
    add(std::move(place), scene.nodes[levels[i].finest].part.value());
  }
  for (std::uint32_t p = 0; p < scene.parts.size(); ++p) {
    SurfacePlace place;
    place.part = p;
    if (is_shown[p] == 0) add(std::move(place), p);
  }
  return places;
}

bool fits(const SurfaceSelector& selector, const SurfacePlace& place) {
  return fits_keys(selector, place) && std::none_of(selector.except.begin(), selector.except.end(),
                                                    [&](const SurfaceSelector& other) { return fits(other, place); });
}

std::string text_of(const SurfaceSelector& selector) {
  std::string text;
  for (const SelectorKey& key : k_keys)
    if (const auto& pattern = selector.*key.pattern) text += (text.empty() ? "" : ", ") + quoted_key(key, *pattern);
  for (const SurfaceSelector& other : selector.except) text += (text.empty() ? "not " : ", not ") + text_of(other);
  return text;
}

std::string reason_for_nothing(const SurfaceSelector& selector, const std::vector<SurfacePlace>& places) {
  for (const SelectorKey& key : k_keys) {
    const auto& pattern = selector.*key.pattern;
    if (!pattern || std::any_of(places.begin(), places.end(),
                                [&](const SurfacePlace& place) { return fits_key(key, *pattern, place); }))
      continue;
    return quoted_key(key, *pattern) + " matches nothing" + near_name(key, *pattern, places);
  }
  const bool are_excepted =
      std::any_of(places.begin(), places.end(), [&](const SurfacePlace& place) { return fits_keys(selector, place); });
  return text_of(selector) + (are_excepted ? " leaves nothing" : " matches nothing together");
}

std::vector<std::string> problems_of(const std::vector<RuleUse>& uses, const std::string& what,
                                     const std::string& pointer) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (!uses[i].problem.empty())
      problems.push_back(what + " " + std::to_string(i + 1) + " (" + pointer + "/" + std::to_string(i) +
                         "): " + uses[i].problem);
  return problems;
}

LabelledParts split_by_label(Scene& scene, const std::vector<SurfacePlace>& places,
                             const std::vector<std::uint32_t>& label, std::span<GltfOrigin::Level> levels) {
  LabelledParts result;
  result.labels.resize(scene.parts.size());
  using Labels = std::vector<std::uint32_t>;
  std::map<std::pair<std::uint32_t, Labels>, std::uint32_t> made;
  std::set<std::string> ids;
  for (const Part& part : scene.parts) ids.insert(part.id);
  std::vector<std::uint8_t> is_taken(scene.parts.size(), 0);
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    const SurfacePlace& first = places[begin];
    Labels labels(std::max<std::size_t>(scene.parts[first.part].materials.size(), 1), 0);
    const auto is_same_use = [&](const SurfacePlace& place) {
      return place.part == first.part && place.node == first.node && place.level == first.level;
    };
    for (end = begin; end < places.size() && is_same_use(places[end]); ++end) {
      if (places[end].slot >= labels.size()) labels.resize(places[end].slot + std::size_t{1}, 0);
      labels[places[end].slot] = label[end];
    }
    const auto [it, is_new] = made.try_emplace({first.part, labels}, first.part);
    if (is_new && is_taken[first.part] != 0) {
      it->second = static_cast<std::uint32_t>(scene.parts.size());
      Part copy = scene.parts[first.part];
      copy.id = first.nodes.front();
      while (!ids.insert(copy.id).second) copy.id += "~";
      scene.parts.push_back(std::move(copy));
      result.labels.emplace_back();
      result.split.push_back({it->second, first.part});
    }
    is_taken[first.part] = 1;
    if (first.node) scene.nodes[*first.node].part = it->second;
    if (first.level) levels[*first.level].part = it->second;
    result.labels[it->second] = std::move(labels);
  }
  return result;
}

}  // namespace papilla
