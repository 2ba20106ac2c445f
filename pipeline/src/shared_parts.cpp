// SPDX-License-Identifier: MIT
#include "papilla/pipeline/shared_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/identical_parts.hpp"

namespace papilla {
namespace {

/// Numbers for what must agree beside the mesh.
std::vector<std::uint64_t> labels_of(const Scene& scene, const PartLabel& label) {
  using Key = std::tuple<std::vector<std::uint32_t>, std::string, std::uint64_t>;
  std::map<Key, std::uint64_t> numbers;
  std::vector<std::uint64_t> labels;
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    labels.push_back(
        numbers.try_emplace(Key{part.materials, part.extras_json, label ? label(i) : 0}, numbers.size()).first->second);
  }
  return labels;
}

std::vector<PartCopy> find_copies(const Scene& scene, const PartLabel& label) {
  const std::vector<std::uint64_t> labels = labels_of(scene, label);
  std::vector<ComparedPart> compared;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) compared.push_back({&scene.parts[i].mesh, labels[i]});
  try {
    return find_identical_parts(compared);
  } catch (const InvalidInput& error) {
    throw InvalidInput(std::string("identical parts: ") + error.what());
  }
}

/// A motion goes into a node's own transform only where that has no shear afterwards.
bool is_similarity(const Transform& t) {
  const Vec3 x{t[0], t[4], t[8]}, y{t[1], t[5], t[9]}, z{t[2], t[6], t[10]};
  const double scale = dot(x, x), slack = 1e-9 * scale;
  return scale > 0 && std::abs(dot(y, y) - scale) <= slack && std::abs(dot(z, z) - scale) <= slack &&
         std::abs(dot(x, y)) <= slack && std::abs(dot(y, z)) <= slack && std::abs(dot(z, x)) <= slack;
}

/// Lets a node that shows `copy` show its original.
void redirect(Scene& scene, std::uint32_t node_number, const Part& copy, const PartCopy& found) {
  Node& node = scene.nodes[node_number];
  const bool is_renamed = !copy.name.empty() && copy.name != scene.parts[found.original].name && copy.name != node.name;
  if (is_renamed && node.name.empty()) node.name = copy.name;
  const bool moves = found.motion != k_identity;
  const bool needs_child =
      (is_renamed && node.name != copy.name) || (moves && (!node.children.empty() || !is_similarity(node.local)));
  if (!needs_child) {
    if (moves) node.local = multiply(node.local, found.motion);
    node.part = found.original;
    return;
  }
  Node child;
  child.name = copy.name;
  child.local = found.motion;
  child.part = found.original;
  node.part.reset();
  node.children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
  scene.nodes.push_back(std::move(child));
}

/// Drops the copies; returns the new numbers of the others.
std::vector<std::uint32_t> drop_copies(Scene& scene, const std::vector<PartCopy>& copies) {
  std::vector<std::uint32_t> number(copies.size(), 0);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < copies.size(); ++i) {
    if (copies[i].original != i) continue;
    if (count != i) scene.parts[count] = std::move(scene.parts[i]);
    number[i] = count++;
  }
  scene.parts.resize(count);
  for (Node& node : scene.nodes)
    if (node.part) node.part = number[*node.part];
  return number;
}

}  // namespace

std::vector<SharedPart> share_identical_parts(Scene& scene, const PartLabel& label) {
  const std::vector<PartCopy> copies = find_copies(scene, label);
  std::vector<SharedPart> shared;
  for (std::uint32_t i = 0; i < copies.size(); ++i)
    if (copies[i].original != i)
      shared.push_back(
          {shown_name(scene.parts[i]), scene.parts[i].id, i, copies[i].original, copies[i].max_distance_mm});
  if (shared.empty()) return shared;
  const std::size_t nodes = scene.nodes.size();
  for (std::uint32_t n = 0; n < nodes; ++n) {
    const std::optional<std::uint32_t> part = scene.nodes[n].part;
    if (part && copies[*part].original != *part) redirect(scene, n, scene.parts[*part], copies[*part]);
  }
  const std::vector<std::uint32_t> number = drop_copies(scene, copies);
  for (SharedPart& part : shared) part.original = number[part.original];
  return shared;
}

}  // namespace papilla
