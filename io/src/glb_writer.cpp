// SPDX-License-Identifier: MIT
#include "papilla/io/glb_writer.hpp"

#include <fmt/core.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <exception>
#include <memory>
#include <ostream>
#include <set>
#include <sstream>

#include "glb_document.hpp"
#include "papilla/core/atomic_file.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/io/tag_manifest.hpp"
#include "scene_losses.hpp"
#include "trs.hpp"

namespace papilla {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are written in place");

using Json = GlbBuffer::Json;

/// @param extras_json  of the asset: what the scene carries on, and the list of its haptic tags.
Json asset_of(const Scene& scene, const std::string& extras_json) {
  const std::string generator = std::string("papilla ") + version();
  Json asset = {{"version", "2.0"}, {"generator", generator}};
  if (!scene.asset.copyright.empty()) asset["copyright"] = scene.asset.copyright;
  Json& extras = asset["extras"];
  extras = extras_json.empty() ? Json::object() : parse_scene_json(extras_json, "asset.extras");
  if (!extras.is_object()) throw InvalidInput("write_glb: asset.extras are no JSON object");
  std::vector<std::string> generators = scene.asset.generators;
  if (!generators.empty() && generators.back() != generator) generators.push_back(generator);
  if (generators.size() > 1) extras["generators"] = generators;
  extras["sourceFormat"] = scene.format;
  extras["sourceUnit"] = scene.unit;
  extras["millimetresPerUnit"] = scene.millimetres_per_unit;
  if (!scene.asset.xmp_reference_json.empty())
    asset["extensions"]["KHR_xmp_json_ld"] = parse_scene_json(scene.asset.xmp_reference_json, "asset.extensions");
  return asset;
}

/// Adds translation, rotation and scale where they are not neutral.
void add_transform(const Transform& local, const std::string& where, Json& node) {
  if (!std::all_of(local.begin(), local.end(), [](double x) { return std::isfinite(x); }))
    throw InvalidInput(where + ": the transform is not finite");
  const auto trs = decompose(local);
  if (!trs) throw InvalidInput(where + ": the transform shears, which glTF cannot hold");
  const Vec3 t = k_metres_per_mm * trs->translation;
  if (!(t == Vec3{})) node["translation"] = {t.x, t.y, t.z};
  if (trs->rotation != std::array<double, 4>{0, 0, 0, 1}) node["rotation"] = trs->rotation;
  if (!(trs->scale == Vec3{1, 1, 1})) node["scale"] = {trs->scale.x, trs->scale.y, trs->scale.z};
}

/// Writes the meshes and nodes that can be reached from the roots.
class NodeWriter {
 public:
  NodeWriter(const Scene& scene, const GlbWriteOptions& options, const std::vector<MaterialNeeds>& needs,
             GlbBuffer& buffer, Json& gltf)
      : scene_(scene), options_(options), needs_(needs), buffer_(buffer), gltf_(gltf) {
    for (const Node& node : scene.nodes) node_extras_.push_back(node.extras_json);
  }

  /// @param asset_extras_json  gets the list of the haptic tags.
  void write(std::string& asset_extras_json) {
    const std::vector<Instance> used = instances(scene_);
    mesh_of_part_.resize(scene_.parts.size());
    levels_of_part_.resize(scene_.parts.size());
    std::set<std::uint32_t> parts;
    for (const Instance& instance : used) parts.insert(instance.part);
    write_meshes({parts.begin(), parts.end()});
    for (const std::uint32_t part : parts) write_levels(part);
    add_tag_manifest(scene_, asset_extras_json, node_extras_);
    number_nodes();
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i)
      if (node_number_[i]) gltf_["nodes"].push_back(node(i));
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i)
      if (node_number_[i]) add_level_nodes(i);
    write_scene();
  }

 private:
  /// Parts at once, and one behind the other into the buffer.
  void write_meshes(const std::vector<std::uint32_t>& parts) {
    using oneapi::tbb::filter_mode;
    using oneapi::tbb::make_filter;
    struct Made {
      std::uint32_t part = 0;
      std::shared_ptr<GlbPrimitives> primitives = {};
      std::exception_ptr failure = {};
    };
    auto next = parts.begin();
    const auto take = [&](oneapi::tbb::flow_control& control) {
      if (next != parts.end()) return *next++;
      control.stop();
      return std::uint32_t{0};
    };
    const auto make = [&](std::uint32_t part) {
      Made made{part};
      try {
        made.primitives = glb_primitives(scene_.parts[part], needs_, options_);
      } catch (...) {
        made.failure = std::current_exception();
      }
      return made;
    };
    const auto write = [&](Made made) {
      if (made.failure) std::rethrow_exception(made.failure);
      mesh_of_part_[made.part] = write_mesh(scene_.parts[made.part], std::move(made.primitives));
    };
    const auto at_once = static_cast<std::size_t>(oneapi::tbb::this_task_arena::max_concurrency()) + 2;
    oneapi::tbb::parallel_pipeline(at_once, make_filter<void, std::uint32_t>(filter_mode::serial_in_order, take) &
                                                make_filter<std::uint32_t, Made>(filter_mode::parallel, make) &
                                                make_filter<Made, void>(filter_mode::serial_in_order, write));
  }

  std::optional<std::size_t> write_mesh(const Part& part, std::shared_ptr<GlbPrimitives> primitives) {
    GlbMesh mesh = glb_mesh(part, std::move(primitives), options_.meshes, buffer_);
    if (mesh.json.is_null()) return std::nullopt;
    gltf_["meshes"].push_back(std::move(mesh.json));
    positions_of_mesh_.push_back(mesh.positions);
    return gltf_["meshes"].size() - 1;
  }

  /// A level without triangles ends the chain: there is nothing to show from there on.
  void write_levels(std::uint32_t number) {
    const Part& part = scene_.parts[number];
    if (!mesh_of_part_[number]) return;
    double coverage = 1;
    for (const PartLevel& source : part.levels) {
      if (!(source.screen_coverage >= 0 && source.screen_coverage <= coverage))
        throw InvalidInput(
            fmt::format("write_glb: part '{}': level {} has a screen coverage of {}, which is not in [0, {}]",
                        part.name, levels_of_part_[number].size() + 1, source.screen_coverage, coverage));
      coverage = source.screen_coverage;
      Part level;
      level.name = level_name(part.name, levels_of_part_[number].size() + 1);
      level.mesh = source.mesh;
      level.materials = part.materials;
      const auto mesh = write_mesh(level, glb_primitives(level, needs_, options_));
      if (!mesh) return;
      levels_of_part_[number].push_back(*mesh);
    }
  }

  static std::string level_name(const std::string& name, std::size_t level) {
    return name.empty() ? name : fmt::format("{}_LOD{}", name, level);
  }

  /// The nodes of the coarser levels have the transform of the node that lists them.
  void add_level_nodes(std::size_t number) {
    const Node& source = scene_.nodes[number];
    if (!source.part || levels_of_part_[*source.part].empty()) return;
    const std::vector<std::size_t>& meshes = levels_of_part_[*source.part];
    std::size_t shown = *node_number_[number];
    const bool on_leaf = shows_on_leaf(number);
    if (on_leaf) {
      gltf_["nodes"][shown]["children"].push_back(gltf_["nodes"].size());
      Json leaf = {{"mesh", gltf_["nodes"][shown]["mesh"]}};
      if (!source.name.empty()) leaf["name"] = level_name(source.name, 0);
      add_transform(positions_of(*mesh_of_part_[*source.part]), "write_glb", leaf);
      gltf_["nodes"][shown].erase("mesh");
      shown = gltf_["nodes"].size();
      gltf_["nodes"].push_back(std::move(leaf));
    }
    Json ids = Json::array(), coverages = Json::array();
    for (std::size_t level = 0; level < meshes.size(); ++level) {
      ids.push_back(gltf_["nodes"].size());
      coverages.push_back(scene_.parts[*source.part].levels[level].screen_coverage);
      Json node = Json::object();
      add_transform(multiply(on_leaf ? k_identity : source.local, positions_of(meshes[level])), "write_glb", node);
      if (!source.name.empty()) node["name"] = level_name(source.name, level + 1);
      node["mesh"] = meshes[level];
      gltf_["nodes"].push_back(std::move(node));
    }
    coverages.push_back(0);  // the coarsest level never vanishes
    gltf_["nodes"][shown]["extensions"]["MSFT_lod"]["ids"] = std::move(ids);
    gltf_["nodes"][shown]["extras"]["MSFT_screencoverage"] = std::move(coverages);
  }

  /// Whether a child of its own shows the node's part: one with levels of detail has no other children.
  bool shows_on_leaf(std::size_t number) const {
    const Node& node = scene_.nodes[number];
    return node.part && !levels_of_part_[*node.part].empty() && !node.children.empty();
  }

  /// What a mesh does to the node that shows it: millimetres from the positions that are written.
  Transform positions_of(std::size_t mesh) const {
    const auto& positions = positions_of_mesh_[mesh];
    if (!positions) return k_identity;
    const double s = positions->scale;
    const Vec3 t = positions->offset_mm;
    return {s, 0, 0, t.x, 0, s, 0, t.y, 0, 0, s, t.z, 0, 0, 0, 1};
  }

  /// The inverse, for what stands below such a node.
  Transform undone_positions_of(std::size_t mesh) const {
    const auto& positions = positions_of_mesh_[mesh];
    if (!positions) return k_identity;
    const double s = 1 / positions->scale;
    const Vec3 t = -s * positions->offset_mm;
    return {s, 0, 0, t.x, 0, s, 0, t.y, 0, 0, s, t.z, 0, 0, 0, 1};
  }

  /// The mesh whose positions the node itself scales.
  std::optional<std::size_t> own_mesh(std::size_t number) const {
    const Node& node = scene_.nodes[number];
    if (!node.part || shows_on_leaf(number)) return std::nullopt;
    return mesh_of_part_[*node.part];
  }

  void number_nodes() {
    node_number_.resize(scene_.nodes.size());
    parent_mesh_.resize(scene_.nodes.size());
    std::vector<std::uint32_t> open = scene_.roots;
    while (!open.empty()) {
      const std::uint32_t number = open.back();
      open.pop_back();
      node_number_[number] = 0;
      for (const std::uint32_t child : scene_.nodes[number].children) parent_mesh_[child] = own_mesh(number);
      open.insert(open.end(), scene_.nodes[number].children.begin(), scene_.nodes[number].children.end());
    }
    std::size_t next = 0;
    for (auto& number : node_number_)
      if (number) number = next++;
  }

  Json node(std::size_t number) const {
    const Node& source = scene_.nodes[number];
    const std::string where = fmt::format("write_glb: node {} '{}'", number, source.name);
    Json json = Json::object();
    if (!source.name.empty()) json["name"] = source.name;
    Transform local = source.local;
    if (parent_mesh_[number]) local = multiply(undone_positions_of(*parent_mesh_[number]), local);
    if (const auto mesh = own_mesh(number)) local = multiply(local, positions_of(*mesh));
    add_transform(local, where, json);
    if (source.part && mesh_of_part_[*source.part]) json["mesh"] = *mesh_of_part_[*source.part];
    for (const std::uint32_t child : source.children) json["children"].push_back(*node_number_[child]);
    if (!node_extras_[number].empty()) json["extras"] = parse_scene_json(node_extras_[number], where + ".extras");
    return json;
  }

  void write_scene() {
    Json roots = Json::array();
    for (const std::uint32_t root : scene_.roots) roots.push_back(*node_number_[root]);
    if (scene_.up != UpAxis::y && !roots.empty()) {
      Json turn = {{"name", k_turn_node_name}};
      add_transform(to_y_up(scene_.up), "write_glb", turn);
      turn["children"] = std::move(roots);
      roots = Json::array({gltf_["nodes"].size()});
      gltf_["nodes"].push_back(std::move(turn));
    }
    Json scene = Json::object();
    if (!roots.empty()) scene["nodes"] = std::move(roots);
    if (!scene_.extras_json.empty()) scene["extras"] = parse_scene_json(scene_.extras_json, "scene.extras");
    gltf_["scene"] = 0;
    gltf_["scenes"] = Json::array({std::move(scene)});
  }

  const Scene& scene_;
  const GlbWriteOptions& options_;
  const std::vector<MaterialNeeds>& needs_;
  std::vector<std::string> node_extras_;  ///< JSON or empty.
  GlbBuffer& buffer_;
  Json& gltf_;
  std::vector<std::optional<std::size_t>> mesh_of_part_, node_number_;
  std::vector<std::optional<std::size_t>> parent_mesh_;  ///< own_mesh() of the node above.
  std::vector<std::optional<Dequantization>> positions_of_mesh_;
  std::vector<std::vector<std::size_t>> levels_of_part_;
};

/// The names below any "extensions" of the document. Extras are not searched: what they hold is not glTF.
void collect_extensions(const Json& json, std::set<std::string>& names) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      if (key == "extras") continue;
      if (key == "extensions" && value.is_object())
        for (const auto& [name, content] : value.items()) names.insert(name);
      collect_extensions(value, names);
    }
  } else if (json.is_array()) {
    for (const Json& value : json) collect_extensions(value, names);
  }
}

/// What a reader must know to show the meshes.
std::set<std::string> required_of_meshes(const Json& gltf, MeshCoding coding) {
  if (!gltf.contains("meshes")) return {};
  switch (coding) {
    case MeshCoding::none: return {};
    case MeshCoding::meshopt: return {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    case MeshCoding::draco: return {"KHR_draco_mesh_compression"};
    case MeshCoding::quantize: break;
  }
  return {"KHR_mesh_quantization"};
}

/// A scene as a glTF document.
struct GltfDocument {
  Json json;
  GlbBuffer buffer;
  std::vector<std::string> losses;

  GltfDocument(const Scene& scene, const GlbWriteOptions& options, GltfSideFiles* files, GlbSizes* sizes)
      : json{{"asset", Json()}}, buffer(files != nullptr ? options.largest_buffer : SIZE_MAX) {
    MaterialWriter materials(scene, options, buffer, files);
    materials.write(json);
    std::string asset_extras = scene.asset.extras_json;
    NodeWriter(scene, options, materials.needs(), buffer, json).write(asset_extras);
    json["asset"] = asset_of(scene, asset_extras);
    if (!scene.asset.xmp_packets_json.empty())
      json["extensions"]["KHR_xmp_json_ld"] = parse_scene_json(scene.asset.xmp_packets_json, "extensions");
    std::vector<std::string> not_mirrored;
    if (options.mirror_mpeg_haptics) not_mirrored = mirror_mpeg_haptics(json, buffer);
    if (options.mirror_khr_physics) mirror_khr_physics(json, not_mirrored);
    buffer.describe(json);
    std::set<std::string> extensions, required = required_of_meshes(json, options.meshes);
    required.insert(materials.required().begin(), materials.required().end());
    collect_extensions(json, extensions);
    extensions.insert(required.begin(), required.end());
    if (!extensions.empty()) json["extensionsUsed"] = extensions;
    if (!required.empty()) json["extensionsRequired"] = required;
    FormatKeeps keeps;
    keeps.parts = keeps.nodes = keeps.materials = keeps.all_of_materials = keeps.extras = true;
    keeps.normals = keeps.uv = keeps.uv1 = keeps.colors = true;
    keeps.cad_uv = options.cad_uv;
    losses = scene_losses(scene, keeps);
    losses.insert(losses.end(), not_mirrored.begin(), not_mirrored.end());
    if (sizes == nullptr) return;
    const TagPictures tags = tag_pictures_in(json.value("materials", Json()));
    *sizes = {.meshes = buffer.mesh_bytes(),
              .meshes_uncompressed = buffer.uncompressed_mesh_bytes(),
              .pictures = materials.picture_bytes(),
              .pictures_uncompressed = materials.uncompressed_picture_bytes(),
              .tag_pictures = tags};
  }
};

}  // namespace

std::vector<std::string> write_glb(const Scene& scene, const std::filesystem::path& path,
                                   const GlbWriteOptions& options, GlbSizes* sizes) {
  GltfDocument document(scene, options, nullptr, sizes);
  const std::string json = document.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::size_t size = document.buffer.sizes().empty() ? 0 : document.buffer.sizes().front();
  write_glb_container(path, json, size, [&](std::ostream& binary) { document.buffer.write(0, binary); });
  return std::move(document.losses);
}

std::vector<std::string> write_gltf(const Scene& scene, const std::filesystem::path& path,
                                    const GlbWriteOptions& options, GlbSizes* sizes) {
  GltfSideFiles files(path);
  GltfDocument document(scene, options, &files, sizes);
  for (std::size_t i = 0; i < document.buffer.sizes().size(); ++i) {
    std::ostringstream binary;
    document.buffer.write(i, binary);
    document.json["buffers"][i]["uri"] = files.add_binary(std::move(binary).str());
  }
  files.write();
  write_atomically(path, document.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return std::move(document.losses);
}

}  // namespace papilla
