// SPDX-License-Identifier: MIT
#include "papilla/io/gltf_edit.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "glb_document.hpp"
#include "gltf_file.hpp"
#include "gltf_material_edit.hpp"
#include "gltf_primitive_edit.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/io/tag_manifest.hpp"

namespace papilla {
namespace {

using Json = GltfFile::Json;

void compare(const Json& before, const Json& after, const Json::json_pointer& pointer,
             std::vector<GltfChange>& changes) {
  if (before.is_object() && after.is_object()) {
    for (const auto& [key, value] : before.items()) {
      const Json::json_pointer member = pointer / key;
      if (const auto found = after.find(key); found != after.end())
        compare(value, *found, member, changes);
      else
        changes.push_back({"removed", member.to_string()});
    }
    for (const auto& [key, value] : after.items())
      if (!before.contains(key)) changes.push_back({"added", (pointer / key).to_string()});
  } else if (before.is_array() && after.is_array()) {
    for (std::size_t i = 0; i < std::max(before.size(), after.size()); ++i) {
      const Json::json_pointer element = pointer / i;
      if (i < before.size() && i < after.size())
        compare(before[i], after[i], element, changes);
      else
        changes.push_back({i < before.size() ? "removed" : "added", element.to_string()});
    }
  } else if (before != after) {
    changes.push_back({"changed", pointer.to_string()});
  }
}

/// The tag that a material of the file has.
std::optional<MaterialTag> tag_in(const Json& material) {
  if (!material.contains("extras")) return std::nullopt;
  std::string extras = material["extras"].dump();
  std::vector<HapticWarning> ignored;
  return take_material_tag(extras, ignored);
}

/// Tags that restore_tags() gave back or took away are written, too.
void add_restored(const Json& json, const Scene& scene, const GltfOrigin& origin, std::vector<GltfSurfaceEdit>& edits) {
  if (scene.tags.expected == 0) return;
  std::set<std::pair<std::uint32_t, std::uint32_t>> known;
  for (const GltfSurfaceEdit& edit : edits) known.insert({edit.part, edit.slot});
  for (std::uint32_t p = 0; p < origin.parts.size(); ++p)
    for (std::uint32_t slot = 0; slot < origin.parts[p].materials.size(); ++slot) {
      if (known.contains({p, slot})) continue;
      const auto number = origin.parts[p].materials[slot];
      const std::optional<MaterialTag>& tag = scene.materials[scene.parts[p].materials[slot]].haptic;
      if (tag == (number ? tag_in(json["materials"][*number]) : std::nullopt)) continue;
      GltfSurfaceEdit edit;
      edit.part = p, edit.slot = slot;
      edit.tag = tag;
      edits.push_back(std::move(edit));
    }
}

/// Adds copies of the meshes that several parts are of, and lets the nodes show them.
/// @return the mesh of each part.
std::vector<std::uint32_t> copy_meshes(const Scene& scene, const GltfOrigin& origin, GltfFile& file) {
  std::vector<std::uint32_t> meshes;
  std::set<std::uint32_t> taken;
  for (const GltfOrigin::Part& part : origin.parts) {
    meshes.push_back(part.mesh);
    if (taken.insert(part.mesh).second) continue;
    Json& list = file.json["meshes"];
    meshes.back() = static_cast<std::uint32_t>(list.size());
    list.push_back(Json(list[part.mesh]));
    file.copy_animations("meshes", part.mesh, meshes.back());
  }
  const auto show = [&](std::uint32_t node, std::uint32_t part) {
    if (meshes[part] != origin.parts[part].mesh) file.json["nodes"][node]["mesh"] = meshes[part];
  };
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].part) show(origin.nodes[i], *scene.nodes[i].part);
  for (const GltfOrigin::Level& level : origin.levels) show(level.node, level.part);
  return meshes;
}

/// @param meshes  of the parts.
WantedEdits by_primitive(const GltfOrigin& origin, const std::vector<std::uint32_t>& meshes,
                         const std::vector<GltfSurfaceEdit>& edits) {
  WantedEdits wanted;
  for (const GltfSurfaceEdit& edit : edits) {
    const GltfOrigin::Part& part = origin.parts[edit.part];
    for (const GltfOrigin::Primitive& primitive : part.primitives)
      if (primitive.slot == edit.slot) wanted[{meshes[edit.part], primitive.number}] = &edit;
  }
  return wanted;
}

/// Gives the scene the materials of the file written.
/// @param meshes  of the parts.
void take_materials(const Json& json, const GltfOrigin& origin, const std::vector<std::uint32_t>& meshes,
                    Scene& scene) {
  scene.materials.clear();
  if (json.contains("materials"))
    for (const Json& source : json["materials"]) {
      Material material;
      material.name = source.value("name", "");
      material.haptic = tag_in(source);
      scene.materials.push_back(std::move(material));
    }
  const auto without = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.emplace_back();
  for (std::size_t p = 0; p < scene.parts.size(); ++p)
    for (const GltfOrigin::Primitive& primitive : origin.parts[p].primitives) {
      const Json& shown = json["meshes"][meshes[p]]["primitives"][primitive.number];
      scene.parts[p].materials[primitive.slot] = shown.value("material", without);
    }
}

bool can_hold(const Json& owner) { return !owner.contains("extras") || owner["extras"].is_object(); }

void set_extra(Json& owner, const char* name, const Json& value) {
  if (!can_hold(owner)) return;  // Extras may be anything; those of others stay as they are.
  if (!value.is_null())
    owner["extras"][name] = value;
  else if (owner.contains("extras") && owner["extras"].erase(name) > 0 && owner["extras"].empty())
    owner.erase("extras");
}

/// The list of tags, in place of an earlier one.
void write_manifest(const Scene& scene, const GltfOrigin& origin, Json& json) {
  std::string asset_extras;
  std::vector<std::string> node_extras(scene.nodes.size());
  add_tag_manifest(scene, asset_extras, node_extras);
  const auto member = [](const std::string& extras, const char* name) {
    return extras.empty() ? Json() : Json::parse(extras).value(name, Json());
  };
  set_extra(json["asset"], k_tag_manifest, member(asset_extras, k_tag_manifest));
  std::map<std::uint32_t, Json> tags;  // Of several instances that a node lists: the first's.
  for (std::size_t i = 0; i < node_extras.size(); ++i)
    if (Json own = member(node_extras[i], k_node_tags); !own.is_null())
      tags.try_emplace(origin.nodes[i], std::move(own));
  if (!json.contains("nodes")) return;
  for (std::uint32_t i = 0; i < json["nodes"].size(); ++i) {
    const auto found = tags.find(i);
    set_extra(json["nodes"][i], k_node_tags, found == tags.end() ? Json() : found->second);
  }
}

void edit_file(const std::filesystem::path& source, Scene& scene, const GltfOrigin& origin,
               std::vector<GltfSurfaceEdit> edits, const std::filesystem::path& output, GltfEditResult& result) {
  GltfFile file(source, output);
  if (file.drops_chunks())
    result.notes.emplace_back(
        "the file's chunks that glTF does not define are left out: a .gltf has no place for them");
  add_restored(file.json, scene, origin, edits);
  const std::map<std::string, std::string> tag_pictures = held_tag_pictures(file.json.value("materials", Json()));
  const std::vector<std::uint32_t> meshes = copy_meshes(scene, origin, file);
  const WantedEdits wanted = by_primitive(origin, meshes, edits);
  const std::vector<EditedMaterial> materials = edit_materials(file, wanted, result.notes);
  std::set<std::size_t> edited;
  for (const EditedMaterial& material : materials) edited.insert(material.number);
  if (file.json.contains("materials")) {
    share_tag_pictures(file.json["materials"], edited, tag_pictures);
    result.tag_pictures = tag_pictures_in(file.json["materials"]);
  }
  edit_primitives(file, {source, scene, origin}, wanted, materials, result.notes);
  take_materials(file.json, origin, meshes, scene);
  write_manifest(scene, origin, file.json);
  file.write();
  compare(file.original(), file.json, Json::json_pointer(), result.changes);
}

}  // namespace

GltfEditResult write_edited_gltf(const std::filesystem::path& source, Scene scene, const GltfOrigin& origin,
                                 std::vector<GltfSurfaceEdit> edits, const std::filesystem::path& output) {
  GltfEditResult result;
  try {
    edit_file(source, scene, origin, std::move(edits), output, result);
  } catch (const Json::exception& error) {  // What read_gltf() did not need may be damaged.
    throw InvalidInput(source.string() + ": is no valid glTF: " + first_line(error.what()));
  } catch (const std::out_of_range&) {
    throw InvalidInput(source.string() + ": is no valid glTF: a number names nothing");
  }
  result.scene = std::move(scene);
  return result;
}

}  // namespace papilla
