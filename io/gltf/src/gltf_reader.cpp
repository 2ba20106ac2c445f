// SPDX-License-Identifier: MIT
#include "papilla/io/gltf_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "gltf_document.hpp"
#include "json_text.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/gltf_levels.hpp"
#include "papilla/io/gltf_triangles.hpp"
#include "papilla/io/scene.hpp"
#include "papilla/io/tag_manifest.hpp"
#include "surface_groups.hpp"

namespace papilla {
namespace {

using gltf::AccessorReader;
using gltf::Document;
using gltf::Json, gltf::json_of, gltf::text_of;

constexpr const char* k_xmp = "KHR_xmp_json_ld";

/// Translation · rotation · scale.
/// @param rotation  a quaternion x, y, z, w of any length but zero.
/// @param where     begins messages.
/// @throws InvalidInput when the quaternion is zero.
Transform transform_from_trs(Vec3 t, const std::array<double, 4>& q, Vec3 s, const std::string& where) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0)) throw InvalidInput(where + ": rotation is the zero quaternion");
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  return {s.x * (1 - 2 * (y * y + z * z)),
          s.y * 2 * (x * y - z * w),
          s.z * 2 * (x * z + y * w),
          t.x,
          s.x * 2 * (x * y + z * w),
          s.y * (1 - 2 * (x * x + z * z)),
          s.z * 2 * (y * z - x * w),
          t.y,
          s.x * 2 * (x * z - y * w),
          s.y * 2 * (y * z + x * w),
          s.z * (1 - 2 * (x * x + y * y)),
          t.z,
          0,
          0,
          0,
          1};
}

/// A node costs as much memory as this many elements of an accessor.
constexpr std::size_t k_elements_per_node = 16;

class InstanceReader {
 public:
  InstanceReader(const Document& document, AccessorReader& reader) : file_(document.file), reader_(reader) {}

  /// The places of all instances, in metres.
  std::vector<Transform> read(const tinygltf::Value& attributes, const std::string& where) {
    const auto translations = numbers(attributes, "TRANSLATION", 3, where);
    const auto rotations = numbers(attributes, "ROTATION", 4, where);
    const auto scales = numbers(attributes, "SCALE", 3, where);
    const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
    const auto fits = [&](const std::vector<double>& n, std::size_t width) {
      return n.empty() || n.size() == width * count;
    };
    if (!fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3))
      throw InvalidInput(file_ + ": " + where + ": the instances' attributes differ in number");
    reader_.spend(k_elements_per_node * count, where);
    std::vector<Transform> places;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 t = translations.empty() ? Vec3{} : gltf::vec3_at(translations, i);
      const Vec3 s = scales.empty() ? Vec3{1, 1, 1} : gltf::vec3_at(scales, i);
      std::array<double, 4> q = {0, 0, 0, 1};
      if (!rotations.empty()) std::copy_n(rotations.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, q.begin());
      places.push_back(transform_from_trs(t, q, s, file_ + ": " + where + ", instance " + std::to_string(i)));
    }
    return places;
  }

 private:
  std::vector<double> numbers(const tinygltf::Value& attributes, const char* name, int components,
                              const std::string& where) {
    if (!attributes.Has(name)) return {};
    return reader_.numbers(gltf::index_in(attributes, name), components, where + ", " + name);
  }

  const std::string& file_;
  AccessorReader& reader_;
};

void add_children(std::vector<Transform> places, std::uint32_t number, const std::string& where, Scene& scene,
                  GltfOrigin& origin) {
  const auto part = scene.nodes[number].part;
  scene.nodes[number].part.reset();
  for (Transform& place : places) {
    for (const std::size_t i : {3U, 7U, 11U}) place[i] *= k_mm_per_metre;
    if (!std::all_of(place.begin(), place.end(), [](double x) { return std::isfinite(x); }))
      throw InvalidInput(where + ": an instance's transform is not finite");
    Node child;
    child.part = part;
    child.local = place;
    scene.nodes[number].children.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    scene.nodes.push_back(std::move(child));
    origin.nodes.push_back(number);
  }
}

/// EXT_mesh_gpu_instancing: a node that shows its mesh at many places gets a child for every place, and shows nothing
/// itself. Attributes of the instances other than their places are losses.
/// @pre scene.nodes are the document's, in the same order.
/// @throws InvalidInput when the attributes differ in number, or a place is not finite.
void expand_instances(const Document& document, AccessorReader& reader, Scene& scene, GltfOrigin& origin) {
  InstanceReader instances(document, reader);
  std::set<std::string> lost;
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
    const auto& extensions = document.model.nodes[i].extensions;
    const auto extension = extensions.find("EXT_mesh_gpu_instancing");
    if (extension == extensions.end() || !scene.nodes[i].part) continue;
    const std::string where = "node " + std::to_string(i) + ", EXT_mesh_gpu_instancing";
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    if (!attributes.IsObject()) throw InvalidInput(document.file + ": " + where + ": attributes are missing");
    add_children(instances.read(attributes, where), static_cast<std::uint32_t>(i), document.file + ": " + where, scene,
                 origin);
    for (const std::string& name : attributes.Keys())
      if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE") lost.insert("instances' attribute " + name);
  }
  scene.losses.insert(scene.losses.end(), lost.begin(), lost.end());
}

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

/// Flags the nodes and all their descendants; the nodes are a forest.
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
  Json extras = json_of(node.extras_json);
  if (!extras.is_object() || extras.erase("MSFT_screencoverage") == 0) return;
  node.extras_json = extras.empty() ? "" : text_of(extras);
}

/// The parts that flagged nodes show and no others do.
std::vector<bool> parts_of_only(const Scene& scene, const std::vector<bool>& flagged) {
  std::vector<bool> only(scene.parts.size(), false);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].part && flagged[i]) only[*scene.nodes[i].part] = true;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].part && !flagged[i]) only[*scene.nodes[i].part] = false;
  return only;
}

/// Nodes below these, and themselves, that show a part; ascending.
std::vector<std::uint32_t> uses_below(const Scene& scene, std::vector<std::uint32_t> nodes) {
  std::vector<bool> below(scene.nodes.size(), false);
  flag_below(scene, std::move(nodes), below);
  std::vector<std::uint32_t> uses;
  for (std::uint32_t i = 0; i < scene.nodes.size(); ++i)
    if (below[i] && scene.nodes[i].part) uses.push_back(i);
  return uses;
}

/// Gives the parts of coarser levels the name of the part whose levels they are, where it is one, and lists their uses.
/// @param lower  flags of the nodes that are coarser levels.
/// @param only_lower  flags of the parts that no finest level shows.
void link_coarser_parts(const Document& document, const std::vector<bool>& lower, const std::vector<bool>& only_lower,
                        Scene& scene, GltfOrigin& origin) {
  std::set<std::uint32_t> linked;
  for (std::uint32_t i = 0; i < document.model.nodes.size(); ++i) {
    const std::vector<std::uint32_t> ids = lower_levels(document, i);
    if (ids.empty() || lower[i]) continue;
    std::vector<std::uint32_t> finest = uses_below(scene, {i});
    std::erase_if(finest, [&](std::uint32_t node) { return lower[node]; });
    const auto is_first = [&](std::uint32_t node) { return scene.nodes[node].part == scene.nodes[finest[0]].part; };
    if (finest.empty() || !std::all_of(finest.begin(), finest.end(), is_first)) continue;
    for (const std::uint32_t node : uses_below(scene, ids)) {
      const std::uint32_t part = *scene.nodes[node].part;
      if (!only_lower[part] || !linked.insert(origin.nodes[node]).second) continue;
      scene.parts[part].name = scene.parts[*scene.nodes[finest[0]].part].name;
      origin.levels.push_back({origin.nodes[node], part, finest[0]});
    }
  }
}

/// Leaves out the coarser levels of detail (MSFT_lod): the nodes that a node lists as its lower levels, what stands
/// below them, the parts that only they show, and the screen coverages in the node's extras. Noted in Scene::losses.
/// @param keep_parts  GltfReadOptions::coarser_parts.
/// @param kept  when given, gets the levels, and nothing is left out.
/// @throws InvalidInput when a list names its own node or one that does not exist.
void keep_finest_levels(const Document& document, bool keep_parts, std::vector<GltfLevels>* kept, Scene& scene,
                        GltfOrigin& origin) {
  std::vector<bool> lower(scene.nodes.size(), false);
  std::size_t levels = 0;
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {  // the scene may have more: instances
    const std::vector<std::uint32_t> ids = lower_levels(document, i);
    if (ids.empty()) continue;
    if (kept != nullptr) {
      kept->push_back({static_cast<std::uint32_t>(i), ids});
      continue;
    }
    levels += ids.size();
    drop_coverages(scene.nodes[i]);
    flag_below(scene, ids, lower);
  }
  if (levels == 0) return;
  const std::vector<bool> only_lower = parts_of_only(scene, lower);
  if (keep_parts) link_coarser_parts(document, lower, only_lower, scene, origin);
  const std::vector<std::uint32_t> numbers = numbers_of_kept(lower);
  for (GltfOrigin::Level& level : origin.levels) level.finest = numbers[level.finest];
  drop_nodes(scene, lower);
  drop(origin.nodes, lower);
  if (!keep_parts) {
    drop_parts(scene, only_lower);
    drop(origin.parts, only_lower);
  }
  scene.losses.push_back(std::to_string(levels) + " coarser levels of detail (" + k_extension + ")");
}

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
  return transform_from_trs({t[0], t[1], t[2]}, {q[0], q[1], q[2], q[3]}, {s[0], s[1], s[2]}, where);
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

/// The nodes that are no child of another one.
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

/// What write_glb() states itself, anew for each file.
constexpr std::array k_own_asset_extras = {"sourceFormat", "sourceUnit", "millimetresPerUnit"};

void read_asset(const Document& document, Scene& scene) {
  const tinygltf::Asset& source = document.model.asset;
  AssetInfo& asset = scene.asset;
  asset.copyright = source.copyright;
  Json extras = json_of(source.extras_json_string);
  if (extras.is_object()) {
    if (const auto list = extras.find("generators"); list != extras.end() && list->is_array()) {
      for (const Json& generator : *list)
        if (generator.is_string()) asset.generators.push_back(generator.get<std::string>());
      extras.erase("generators");
    }
    for (const char* own : k_own_asset_extras) extras.erase(own);
    if (!extras.empty()) asset.extras_json = text_of(extras);
  } else if (!source.extras_json_string.empty()) {
    scene.losses.push_back("extras of the asset, which are no object");
  }
  if (!source.generator.empty() && (asset.generators.empty() || asset.generators.back() != source.generator))
    asset.generators.push_back(source.generator);
  const auto member = [](const std::string& extensions, const char* name) {
    const Json json = json_of(extensions);
    const auto found = json.is_object() ? json.find(name) : json.end();
    return found == json.end() ? "" : text_of(*found);
  };
  asset.xmp_packets_json = member(document.model.extensions_json_string, k_xmp);
  asset.xmp_reference_json = member(source.extensions_json_string, k_xmp);
}

/// The triangles of a file, read when they are asked for. @pre `file` outlives the result.
PartTriangles triangles_of(GltfTriangles& file) {
  return [&file](std::uint32_t part, const UseTriangle& use) {
    for (const GltfTriangles::Primitive& primitive : file.primitives(part)) {
      const GltfPrimitive found = file.read(part, primitive, std::nullopt, false);
      const auto corner = [&](Index v) {
        const auto& p = found.positions[v];
        return k_mm_per_metre * Vec3{double{p[0]}, double{p[1]}, double{p[2]}};
      };
      for (const Triangle& t : found.triangles) use(primitive.slot, {corner(t[0]), corner(t[1]), corner(t[2])});
    }
  };
}

/// Looks for tags that got lost since the file, or the one that `tags` names, had them.
void find_missing_tags(const std::filesystem::path& tags, const PartTriangles& triangles, Scene& scene) {
  std::optional<TagManifest> manifest = take_tag_manifest(scene);
  if (!tags.empty()) {
    GltfTriangles other(tags);
    complete_tag_pictures(other.scene);
    manifest = tag_manifest(other.scene, triangles_of(other));
    if (manifest->materials.empty()) throw InvalidInput(tags.string() + ": has no haptic tag");
  }
  if (!manifest) return;
  scene.tags = restore_tags(scene, *manifest, triangles);
  if (const std::string sentence = survival_sentence(scene.tags); !sentence.empty()) scene.warnings.push_back(sentence);
}

bool has_whole_positions(const tinygltf::Model& model, const tinygltf::Mesh& mesh) {
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    const auto found = primitive.attributes.find("POSITION");
    if (found == primitive.attributes.end()) continue;
    const auto number = static_cast<std::size_t>(found->second);
    if (number < model.accessors.size() && model.accessors[number].componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
      return true;
  }
  return false;
}

/// Positions of whole numbers have no unit: the scale of the first node that shows them is theirs. Where meshes are not
/// read the nodes keep it.
void scale_whole_positions(const Document& document, Scene& scene) {
  std::vector<double> scale(scene.parts.size(), 0);
  for (Node& node : scene.nodes) {
    if (!node.part || scene.parts[*node.part].mesh.positions.empty() || *node.part >= document.model.meshes.size() ||
        !has_whole_positions(document.model, document.model.meshes[*node.part]))
      continue;
    double& s = scale[*node.part];
    if (s == 0) {
      s = std::cbrt(std::abs(determinant(node.local)));
      if (!(s > 0)) s = 1;
      for (Vec3& p : scene.parts[*node.part].mesh.positions) p = s * p;
    }
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 3; ++column) node.local[4 * row + column] /= s;
    for (const std::uint32_t child : node.children)
      for (std::size_t i = 0; i < 12; ++i) scene.nodes[child].local[i] *= s;
  }
}

/// Lists the content of the document that a scene can't hold.
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
  std::set<std::string> extensions;
  for (const tinygltf::Node& node : model.nodes)
    for (const auto& [name, value] : node.extensions)
      if (name != "EXT_mesh_gpu_instancing" && name != "MSFT_lod") extensions.insert(name + " of nodes");
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const auto& [name, value] : mesh.extensions) extensions.insert(name + " of meshes");
  for (const auto& [name, value] : model.extensions)
    if (name != k_xmp) extensions.insert(name + " of the file");
  scene.losses.insert(scene.losses.end(), extensions.begin(), extensions.end());
}

/// Gives the channel of the tag the number 1, and that one its number.
void move_tag_channel(Material& material) {
  const int channel = material.haptic ? tex_coord_of(*material.haptic).value_or(0) : 0;
  if (channel <= 1) return;
  for (PlacedPicture* picture : pictures_of(*material.haptic)) picture->tex_coord = 1;
  for (auto* reference : {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
                          &material.occlusion_texture, &material.emissive_texture}) {
    if (!*reference) continue;
    int& own = (*reference)->tex_coord;
    own = own == channel ? 1 : own == 1 ? channel : own;
  }
}

/// All but materials and parts, which are there already.
/// @param triangles  of the scene, for finding tags.
void read_rest(Document& document, AccessorReader& reader, const GltfReadOptions& options,
               std::vector<GltfLevels>* levels, const PartTriangles& triangles, Scene& scene, GltfOrigin& origin) {
  read_nodes(document, scene);
  origin.nodes.resize(scene.nodes.size());
  std::iota(origin.nodes.begin(), origin.nodes.end(), 0U);
  read_roots(document, scene);
  expand_instances(document, reader, scene, origin);  // appends nodes: those of the file keep their numbers
  scale_whole_positions(document, scene);
  keep_finest_levels(document, options.coarser_parts, levels, scene, origin);
  note_losses(document, scene);
  read_asset(document, scene);
  try {
    assign_part_ids(scene);
  } catch (const InvalidInput& error) {
    throw InvalidInput(document.file + ": " + error.what());
  }
  find_missing_tags(options.tags, triangles, scene);
  // Names, addresses and keys come from the file.
  for (std::vector<std::string>* lines : {&scene.losses, &scene.warnings})
    for (std::string& line : *lines) line = one_line(line);
}

Scene empty_scene(Document& document) {
  Scene scene;
  scene.format = "glTF";
  scene.unit = "m";
  scene.millimetres_per_unit = k_mm_per_metre;
  scene.up = UpAxis::y;
  scene.warnings = std::move(document.warnings);
  return scene;
}

Scene read_scene(const std::filesystem::path& path, const GltfReadOptions& options, std::vector<GltfLevels>* levels,
                 GltfOrigin* origin_of) {
  Document document = gltf::load_document(path);
  Scene scene = empty_scene(document);
  AccessorReader reader(document);
  gltf::read_materials(document, reader, scene);
  GltfOrigin origin;
  origin.parts = gltf::read_parts(document, reader, options.tag_channel, options.cad_uv, scene);
  if (options.tag_channel)
    for (Material& material : scene.materials) move_tag_channel(material);
  read_rest(document, reader, options, levels, mesh_triangles(scene), scene, origin);
  if (origin_of != nullptr) *origin_of = std::move(origin);
  return scene;
}

}  // namespace

Scene read_gltf(const std::filesystem::path& path, const GltfReadOptions& options, GltfOrigin* origin_of) {
  return read_scene(path, options, nullptr, origin_of);
}

Scene read_gltf_levels(const std::filesystem::path& path, const GltfReadOptions& options,
                       std::vector<GltfLevels>& levels) {
  return read_scene(path, options, &levels, nullptr);
}

struct GltfTriangles::File {
  Document document;
  AccessorReader reader;
  GltfOrigin origin;

  explicit File(const std::filesystem::path& path) : document(gltf::load_document(path)), reader(document) {}
};

GltfTriangles::GltfTriangles(const std::filesystem::path& path, const std::filesystem::path& tags)
    : file_(std::make_unique<File>(path)) {
  auto& [document, reader, origin] = *file_;
  scene = empty_scene(document);
  gltf::read_materials(document, reader, scene);
  origin.parts = gltf::list_parts(document, reader, scene);
  read_rest(document, reader, {.tags = tags}, nullptr, triangles_of(*this), scene, origin);
}
GltfTriangles::~GltfTriangles() = default;
GltfTriangles::GltfTriangles(GltfTriangles&&) noexcept = default;

std::vector<GltfTriangles::Primitive> GltfTriangles::primitives(std::uint32_t part) const {
  const GltfOrigin::Part& origin = file_->origin.parts.at(part);
  std::vector<Primitive> result;
  for (const GltfOrigin::Primitive& listed : origin.primitives) {
    const std::string where = "mesh " + std::to_string(origin.mesh);
    const tinygltf::Primitive& primitive = file_->document.model.meshes.at(origin.mesh).primitives.at(listed.number);
    const std::size_t vertices = file_->reader.accessor(primitive.attributes.at("POSITION"), where).count;
    const std::size_t corners =
        primitive.indices >= 0 ? file_->reader.accessor(primitive.indices, where).count : vertices;
    result.push_back(
        {listed.number, listed.slot, vertices, primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners});
  }
  return result;
}

GltfPrimitive GltfTriangles::read(std::uint32_t part, const Primitive& primitive, std::optional<int> channel,
                                  bool normals) {
  return gltf::read_primitive(file_->document, file_->reader, file_->origin.parts.at(part).mesh, primitive.number,
                              channel, normals, scene);
}

}  // namespace papilla
