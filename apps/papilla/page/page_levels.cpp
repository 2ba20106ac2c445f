// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_levels.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "json/json.hpp"
#include "papilla/io/gltf_levels.hpp"

namespace papilla::app {
namespace {

using Parents = std::vector<std::optional<std::uint32_t>>;

Parents parents_of(const Scene& scene) {
  Parents parents(scene.nodes.size());
  for (std::uint32_t i = 0; i < scene.nodes.size(); ++i)
    for (const std::uint32_t child : scene.nodes[i].children) parents[child] = i;
  return parents;
}

bool is_above(const Parents& parents, std::uint32_t node, std::uint32_t below) {
  for (std::optional<std::uint32_t> at = below; at; at = parents[*at])
    if (*at == node) return true;
  return false;
}

/// MSFT_screencoverage of a node, without which the extension leaves the choice to the reader: halves.
std::vector<double> coverages_of(const Node& node, std::size_t levels) {
  std::vector<double> coverages;
  const Json extras = Json::parse(node.extras_json, nullptr, false);
  if (extras.is_object() && extras.contains("MSFT_screencoverage"))
    for (const Json& value : extras["MSFT_screencoverage"])
      if (value.is_number()) coverages.push_back(std::clamp(value.get<double>(), 0.0, 1.0));
  for (double next = 0.5; coverages.size() < levels; next /= 2)
    coverages.push_back(coverages.size() + 1 < levels ? std::min(next, coverages.empty() ? next : coverages.back())
                                                      : 0);
  coverages.resize(levels);
  return coverages;
}

/// Puts nodes of coarser levels beside the node that lists them, which is what the extension means.
void stand_beside(Scene& scene, Parents& parents, std::uint32_t finest, std::uint32_t level) {
  const bool stands = parents[level] || std::count(scene.roots.begin(), scene.roots.end(), level) > 0;
  if (stands || is_above(parents, level, finest)) return;
  (parents[finest] ? scene.nodes[*parents[finest]].children : scene.roots).push_back(level);
  parents[level] = parents[finest];
}

}  // namespace

Scene read_for_page(const std::filesystem::path& file, const ReadOptions& options, std::vector<PageLevels>& levels) {
  std::vector<GltfLevels> chains;
  Scene scene = read_gltf_levels(file, {.tags = options.tags, .tag_channel = true}, chains);
  scene.up = options.up.value_or(scene.up);
  Parents parents = parents_of(scene);
  for (const GltfLevels& chain : chains) {
    PageLevels place;
    place.nodes = {chain.node};
    for (const std::uint32_t level : chain.levels) {
      stand_beside(scene, parents, chain.node, level);
      place.nodes.push_back(level);
    }
    place.coverages = coverages_of(scene.nodes[chain.node], place.nodes.size());
    levels.push_back(std::move(place));
  }
  return scene;
}

std::vector<std::optional<PageLevel>> levels_of(const Scene& scene, std::span<const Instance> instances,
                                                std::span<const PageLevels> levels) {
  std::vector<std::optional<PageLevel>> of_node(scene.nodes.size()), result;
  for (std::size_t place = 0; place < levels.size(); ++place)
    for (std::size_t number = 0; number < levels[place].nodes.size(); ++number)
      of_node[levels[place].nodes[number]] = {place, number};
  const Parents parents = parents_of(scene);
  for (const Instance& use : instances) {
    std::optional<std::uint32_t> at = use.node;
    while (at && !of_node[*at]) at = parents[*at];
    result.push_back(at ? of_node[*at] : std::nullopt);
  }
  return result;
}

}  // namespace papilla::app
