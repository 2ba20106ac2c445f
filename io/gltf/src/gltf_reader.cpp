// SPDX-License-Identifier: MIT
#include "papilla/io/gltf_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "gltf_instancing.hpp"
#include "gltf_levels.hpp"
#include "gltf_material.hpp"
#include "gltf_mesh.hpp"
#include "gltf_transform.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"

namespace papilla {
namespace {

using gltf::Document;

std::vector<double> numbers_or(const std::vector<double>& given, std::vector<double> fallback, const char* name,
                               const std::string& where) {
  if (given.empty()) return fallback;
  if (given.size() != fallback.size())
    throw InvalidInput(where + ": " + name + " has " + std::to_string(given.size()) + " numbers, not " +
                       std::to_string(fallback.size()));
  return given;
}

/// glTF stores columns.
Transform from_matrix(const std::vector<double>& m, const std::string& where) {
  if (m.size() != 16) throw InvalidInput(where + ": matrix has " + std::to_string(m.size()) + " numbers, not 16");
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) throw InvalidInput(where + ": matrix is not affine");
  Transform transform{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column) transform[4 * row + column] = m[4 * column + row];
  return transform;
}

/// Translation still in metres.
Transform from_trs(const tinygltf::Node& node, const std::string& where) {
  const auto t = numbers_or(node.translation, {0, 0, 0}, "translation", where);
  const auto q = numbers_or(node.rotation, {0, 0, 0, 1}, "rotation", where);
  const auto s = numbers_or(node.scale, {1, 1, 1}, "scale", where);
  return gltf::transform_from_trs({t[0], t[1], t[2]}, {q[0], q[1], q[2], q[3]}, {s[0], s[1], s[2]}, where);
}

Transform local_transform(const tinygltf::Node& node, const std::string& where) {
  Transform local = node.matrix.empty() ? from_trs(node, where) : from_matrix(node.matrix, where);
  for (const std::size_t i : {3U, 7U, 11U}) local[i] *= k_mm_per_metre;
  if (!std::all_of(local.begin(), local.end(), [](double x) { return std::isfinite(x); }))
    throw InvalidInput(where + ": the transform is not finite");
  return local;
}

std::vector<std::uint32_t> node_numbers(const std::vector<int>& numbers, const Document& document,
                                        const std::string& where) {
  std::vector<std::uint32_t> result;
  for (const int number : numbers) {
    if (number < 0 || static_cast<std::size_t>(number) >= document.model.nodes.size())
      throw InvalidInput(where + " names node " + std::to_string(number) + ", which does not exist");
    result.push_back(static_cast<std::uint32_t>(number));
  }
  return result;
}

void read_nodes(const Document& document, Scene& scene) {
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
    const tinygltf::Node& source = document.model.nodes[i];
    const std::string where = document.file + ": node " + std::to_string(i);
    if (source.mesh >= static_cast<int>(scene.parts.size()))
      throw InvalidInput(where + " names mesh " + std::to_string(source.mesh) + ", which does not exist");
    Node node;
    node.name = source.name;
    node.local = local_transform(source, where);
    node.children = node_numbers(source.children, document, where);
    if (source.mesh >= 0) node.part = static_cast<std::uint32_t>(source.mesh);
    node.extras_json = source.extras_json_string;
    scene.nodes.push_back(std::move(node));
  }
}

/// The nodes that nobody has as a child.
/// @throws InvalidInput when the nodes are no forest, whether the scene uses them or not.
std::vector<std::uint32_t> nodes_without_parent(const Document& document, const Scene& scene) {
  std::vector<bool> is_child(scene.nodes.size(), false);
  for (const Node& node : scene.nodes)
    for (const std::uint32_t child : node.children) {
      if (is_child[child]) throw InvalidInput(document.file + ": node " + std::to_string(child) + " has two parents");
      is_child[child] = true;
    }
  std::vector<std::uint32_t> roots, open;
  for (std::uint32_t i = 0; i < scene.nodes.size(); ++i)
    if (!is_child[i]) roots.push_back(i);
  std::size_t reached = 0;
  for (open = roots; !open.empty(); ++reached) {
    const std::vector<std::uint32_t>& children = scene.nodes[open.back()].children;
    open.pop_back();
    open.insert(open.end(), children.begin(), children.end());
  }
  if (reached != scene.nodes.size()) throw InvalidInput(document.file + ": the nodes form a cycle");
  return roots;
}

void read_roots(const Document& document, Scene& scene) {
  const tinygltf::Model& model = document.model;
  scene.extras_json = model.extras.Type() == tinygltf::NULL_TYPE ? "" : model.extras_json_string;
  std::vector<std::uint32_t> free_nodes = nodes_without_parent(document, scene);
  if (model.scenes.empty() && model.defaultScene < 0) {
    scene.roots = std::move(free_nodes);
    return;
  }
  const std::size_t number = model.defaultScene < 0 ? 0 : static_cast<std::size_t>(model.defaultScene);
  if (number >= model.scenes.size())
    throw InvalidInput(document.file + ": scene " + std::to_string(number) + " does not exist");
  const tinygltf::Scene& source = model.scenes[number];
  scene.roots = node_numbers(source.nodes, document, document.file + ": scene " + std::to_string(number));
  if (!source.extras_json_string.empty()) {
    if (!scene.extras_json.empty()) scene.losses.push_back("extras of the file (those of its scene are kept)");
    scene.extras_json = source.extras_json_string;
  }
}

/// Everything the scene has no place for.
void note_losses(const Document& document, Scene& scene) {
  const tinygltf::Model& model = document.model;
  const auto count = [&](std::size_t n, const std::string& what) {
    if (n > 0) scene.losses.push_back(std::to_string(n) + " " + what);
  };
  count(model.animations.size(), "animations");
  count(model.skins.size(), "skins: their meshes stand in the pose of the file");
  count(model.cameras.size(), "cameras");
  count(model.lights.size(), "lights");
  if (model.scenes.size() > 1) count(model.scenes.size() - 1, "further scenes");
  if (!model.asset.copyright.empty()) scene.losses.push_back("copyright notice: " + model.asset.copyright);
  std::set<std::string> extensions;
  for (const tinygltf::Node& node : model.nodes)
    for (const auto& [name, value] : node.extensions)
      if (name != "EXT_mesh_gpu_instancing" && name != "MSFT_lod") extensions.insert(name + " of nodes");
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const auto& [name, value] : mesh.extensions) extensions.insert(name + " of meshes");
  for (const auto& [name, value] : model.extensions) extensions.insert(name + " of the file");
  scene.losses.insert(scene.losses.end(), extensions.begin(), extensions.end());
}

}  // namespace

Scene read_gltf(const std::filesystem::path& path) {
  Document document = gltf::load_document(path);
  Scene scene;
  scene.format = "glTF";
  scene.unit = "m";
  scene.millimetres_per_unit = k_mm_per_metre;
  scene.up = UpAxis::y;
  scene.warnings = std::move(document.warnings);
  gltf::AccessorReader reader(document);
  gltf::read_materials(document, reader, scene);
  gltf::read_parts(document, reader, scene);
  read_nodes(document, scene);
  read_roots(document, scene);
  gltf::expand_instances(document, reader, scene);  // appends nodes: those of the file keep their numbers
  gltf::keep_finest_levels(document, scene);
  note_losses(document, scene);
  try {
    assign_part_ids(scene);
  } catch (const InvalidInput& error) {
    throw InvalidInput(document.file + ": " + error.what());
  }
  // Names, addresses and keys come from the file.
  for (std::vector<std::string>* lines : {&scene.losses, &scene.warnings})
    for (std::string& line : *lines) line = one_line(line);
  return scene;
}

}  // namespace papilla
