// SPDX-License-Identifier: MIT
#include "gltf_levels.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "papilla/core/error.hpp"

namespace papilla::gltf {
namespace {

constexpr const char* k_extension = "MSFT_lod";

/// The nodes that node `number` lists as its lower levels.
std::vector<std::uint32_t> lower_levels(const Document& document, std::size_t number) {
  const tinygltf::Node& node = document.model.nodes[number];
  const auto extension = node.extensions.find(k_extension);
  std::vector<std::uint32_t> levels;
  if (extension == node.extensions.end() || !extension->second.Has("ids")) return levels;
  const tinygltf::Value& ids = extension->second.Get("ids");
  for (std::size_t i = 0; i < ids.ArrayLen(); ++i) {
    const tinygltf::Value& id = ids.Get(static_cast<int>(i));
    const int value = id.IsInt() ? id.Get<int>() : -1;
    if (value < 0 || static_cast<std::size_t>(value) >= document.model.nodes.size() ||
        static_cast<std::size_t>(value) == number)
      throw InvalidInput(document.file + ": node " + std::to_string(number) + ": " + k_extension + ".ids[" +
                         std::to_string(i) + "] names no other node");
    levels.push_back(static_cast<std::uint32_t>(value));
  }
  return levels;
}

/// Flags the nodes and everything below them; the nodes are a forest.
void flag_below(const Scene& scene, std::vector<std::uint32_t> open, std::vector<bool>& flags) {
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    if (flags[node]) continue;
    flags[node] = true;
    open.insert(open.end(), scene.nodes[node].children.begin(), scene.nodes[node].children.end());
  }
}

/// New numbers of what stays.
std::vector<std::uint32_t> numbers_of_kept(const std::vector<bool>& dropped) {
  std::vector<std::uint32_t> numbers(dropped.size());
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i) numbers[i] = dropped[i] ? next : next++;
  return numbers;
}

template <class T>
void drop(std::vector<T>& values, const std::vector<bool>& dropped) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (dropped[i]) continue;
    if (to != i) values[to] = std::move(values[i]);
    ++to;
  }
  values.resize(to);
}

void renumber(std::vector<std::uint32_t>& nodes, const std::vector<bool>& dropped,
              const std::vector<std::uint32_t>& numbers) {
  std::erase_if(nodes, [&](std::uint32_t node) { return dropped[node]; });
  for (std::uint32_t& node : nodes) node = numbers[node];
}

void drop_nodes(Scene& scene, const std::vector<bool>& dropped) {
  const std::vector<std::uint32_t> numbers = numbers_of_kept(dropped);
  drop(scene.nodes, dropped);
  for (Node& node : scene.nodes) renumber(node.children, dropped, numbers);
  renumber(scene.roots, dropped, numbers);
}

void drop_parts(Scene& scene, const std::vector<bool>& dropped) {
  const std::vector<std::uint32_t> numbers = numbers_of_kept(dropped);
  drop(scene.parts, dropped);
  for (Node& node : scene.nodes)
    if (node.part) node.part = numbers[*node.part];
}

void drop_coverages(Node& node) {
  nlohmann::ordered_json extras = nlohmann::ordered_json::parse(node.extras_json, nullptr, false);
  if (!extras.is_object() || extras.erase("MSFT_screencoverage") == 0) return;
  node.extras_json = extras.empty() ? "" : extras.dump();
}

}  // namespace

void keep_finest_levels(const Document& document, Scene& scene) {
  std::vector<bool> lower(scene.nodes.size(), false);
  std::size_t levels = 0;
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {  // the scene may have more: instances
    const std::vector<std::uint32_t> ids = lower_levels(document, i);
    if (ids.empty()) continue;
    levels += ids.size();
    drop_coverages(scene.nodes[i]);
    flag_below(scene, ids, lower);
  }
  if (levels == 0) return;
  std::vector<bool> only_lower(scene.parts.size(), false);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].part && lower[i]) only_lower[*scene.nodes[i].part] = true;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].part && !lower[i]) only_lower[*scene.nodes[i].part] = false;
  drop_nodes(scene, lower);
  drop_parts(scene, only_lower);
  scene.losses.push_back(std::to_string(levels) + " coarser levels of detail (" + k_extension + ")");
}

}  // namespace papilla::gltf
