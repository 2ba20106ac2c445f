// SPDX-License-Identifier: MIT
#include "papilla/io/tag_manifest.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "json_text.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"
#include "papilla/core/units.hpp"
#include "surface_groups.hpp"

namespace papilla {
namespace {

using gltf::Json, gltf::json_of, gltf::text_of;

constexpr int k_version = 1;

double to_micrometre(double metres) { return std::round(1e6 * metres) / 1e6; }

/// Six digits: enough for a tolerance of a percent. Below 1e-300 the unit of the last one is no number any more.
double rounded(double value) {
  if (!(value > 1e-300)) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 5);
  return std::round(value / unit) * unit;
}

Json tag_json(MaterialTag tag) {
  for (PlacedPicture* picture : pictures_of(tag))
    if (picture->is_embedded()) picture->uri.clear();
  return json_of(to_json(tag));
}

/// What a node repeats: the constants.
Json constants_json(const MaterialTag& tag) {
  MaterialTag constants = tag;
  constants.height.reset(), constants.maps.reset(), constants.roughness.reset(), constants.force_model.reset();
  constants.symmetry.reset(), constants.provenance.reset();
  constants.other_json.clear();
  return json_of(to_json(constants));
}

Json surface_json(const TagManifest::Surface& surface) {
  Json json = Json::object();
  if (!surface.part.empty()) json["part"] = surface.part;
  if (!surface.node.empty()) json["node"] = surface.node;
  json["material"] = surface.material ? Json(*surface.material) : Json();
  json["area"] = rounded(surface.area_m2);
  if (surface.box_m) {
    const auto& [low, high] = *surface.box_m;
    json["box"] = Json::array();
    for (const double x : {low.x, low.y, low.z, high.x, high.y, high.z}) json["box"].push_back(to_micrometre(x));
  }
  return json;
}

/// @throws Json::exception, InvalidInput when the text is no manifest.
TagManifest manifest_of(const Json& json, std::vector<HapticWarning>& warnings) {
  if (json.at("version") != k_version) throw InvalidInput("version " + json.at("version").dump() + ", expected 1");
  TagManifest manifest;
  for (const Json& entry : json.at("materials"))
    manifest.materials.push_back(
        {entry.at("name").get<std::string>(), parse_material_tag(text_of(entry.at("tag")), warnings)});
  for (const Json& entry : json.at("surfaces")) {
    TagManifest::Surface surface;
    surface.part = entry.value("part", "");
    surface.node = entry.value("node", "");
    if (const Json& material = entry.at("material"); !material.is_null()) {
      if (!material.is_number_unsigned() || material.get<std::uint64_t>() >= manifest.materials.size())
        throw InvalidInput("a surface names material " + material.dump());
      surface.material = material.get<std::uint32_t>();
    }
    surface.area_m2 = entry.at("area").get<double>();
    if (entry.contains("box")) {
      const auto box = entry.at("box").get<std::array<double, 6>>();
      surface.box_m = Bounds3{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    }
    manifest.surfaces.push_back(std::move(surface));
  }
  return manifest;
}

/// Adds the tags that a node repeats.
void add_node_tags(const Json& json, const std::string& node, TagManifest& manifest) {
  std::vector<HapticWarning> ignored;
  for (const Json& entry : json) {
    TagManifest::Entry material{entry.at("material").get<std::string>(),
                                parse_material_tag(text_of(entry.at("tag")), ignored)};
    auto& known = manifest.materials;
    const auto found = std::find_if(known.begin(), known.end(), [&](const TagManifest::Entry& e) {
      return e.name == material.name && e.tag == material.tag;
    });
    TagManifest::Surface surface;
    surface.node = node;
    surface.material = static_cast<std::uint32_t>(found - known.begin());
    surface.area_m2 = entry.at("area").get<double>();
    if (found == known.end()) known.push_back(std::move(material));
    manifest.surfaces.push_back(std::move(surface));
  }
}

/// Takes a member out of extras; null when there is none.
Json take_member(std::string& extras_json, const char* name) {
  if (extras_json.find(name) == std::string::npos) return nullptr;
  Json extras = json_of(extras_json);
  if (!extras.is_object() || !extras.contains(name)) return nullptr;
  Json member = std::move(extras[name]);
  extras.erase(name);
  extras_json = extras.empty() ? "" : text_of(extras);
  return member;
}

/// Area of a mesh as it stands, by slot: exact for transforms that keep angles.
std::map<std::uint32_t, double> areas_by_slot(const TriangleMesh& mesh) {
  std::map<std::uint32_t, double> areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    areas[mesh.material.empty() ? 0 : mesh.material[t]] +=
        0.5 * norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  return areas;
}

double area_scale(const Transform& t) {
  return std::pow(std::abs(determinant(t)), 2.0 / 3) * k_metres_per_mm * k_metres_per_mm;
}

}  // namespace

PartTriangles mesh_triangles(const Scene& scene) {
  return [&scene](std::uint32_t part, const UseTriangle& use) {
    const TriangleMesh& mesh = scene.parts[part].mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      use(mesh.material.empty() ? 0 : mesh.material[t], {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  };
}

std::vector<SurfaceGroup> surface_groups(const Scene& scene, const PartTriangles& triangles) {
  std::vector<SurfaceGroup> groups;
  std::set<std::uint32_t> known;
  for (const Instance& instance : instances(scene)) {
    if (!known.insert(instance.part).second) continue;
    const Part& part = scene.parts[instance.part];
    const Transform place = multiply(to_y_up(scene.up), instance.world);
    std::map<std::uint32_t, SurfaceGroup> by_slot;
    triangles(instance.part, [&](std::uint32_t slot, const std::array<Vec3, 3>& corners) {
      if (slot >= part.materials.size()) return;
      SurfaceGroup& group = by_slot[slot];
      std::array<Vec3, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = k_metres_per_mm * transform_point(place, corners[k]);
        group.box_m.add(corner[k]);
      }
      group.area_m2 += 0.5 * norm(cross(corner[1] - corner[0], corner[2] - corner[0]));
    });
    for (auto& [slot, group] : by_slot) {
      group.part = instance.part, group.node = instance.node, group.slot = slot;
      group.material = part.materials[slot];
      groups.push_back(group);
    }
  }
  return groups;
}

TagManifest tag_manifest(const Scene& scene) { return tag_manifest(scene, mesh_triangles(scene)); }

TagManifest tag_manifest(const Scene& scene, const PartTriangles& triangles) {
  TagManifest manifest;
  const std::vector<SurfaceGroup> groups = surface_groups(scene, triangles);
  std::map<std::uint32_t, std::uint32_t> number;  // of a scene's material in the manifest
  std::set<std::uint32_t> tagged_parts;
  for (const SurfaceGroup& group : groups) {
    const Material& material = scene.materials[group.material];
    if (!material.haptic) continue;
    tagged_parts.insert(group.part);
    if (number.try_emplace(group.material, manifest.materials.size()).second)
      manifest.materials.push_back({material.name, *material.haptic});
  }
  for (const SurfaceGroup& group : groups) {
    if (!tagged_parts.contains(group.part)) continue;
    const auto found = number.find(group.material);
    manifest.surfaces.push_back({scene.parts[group.part].name, scene.nodes[group.node].name,
                                 found == number.end() ? std::nullopt : std::optional(found->second), group.area_m2,
                                 group.box_m});
  }
  return manifest;
}

std::string to_json(const TagManifest& manifest) {
  Json json = {{"version", k_version}, {"materials", Json::array()}, {"surfaces", Json::array()}};
  for (const TagManifest::Entry& entry : manifest.materials)
    json["materials"].push_back({{"name", entry.name}, {"tag", tag_json(entry.tag)}});
  for (const TagManifest::Surface& surface : manifest.surfaces) json["surfaces"].push_back(surface_json(surface));
  return text_of(json);
}

void add_tag_manifest(const Scene& scene, std::string& asset_extras_json, std::vector<std::string>& node_extras_json) {
  const TagManifest manifest = tag_manifest(scene);
  if (manifest.materials.empty()) return;
  const auto add = [](std::string& extras, const char* name, Json member) {
    Json json = extras.empty() ? Json::object() : json_of(extras);
    if (!json.is_object()) return;  // Extras may be anything; those of others stay as they are.
    json[name] = std::move(member);
    extras = text_of(json);
  };
  add(asset_extras_json, k_tag_manifest, json_of(to_json(manifest)));
  std::map<std::uint32_t, std::map<std::uint32_t, double>> areas;
  for (const Instance& instance : instances(scene)) {
    const Part& part = scene.parts[instance.part];
    const auto [known, is_new] = areas.try_emplace(instance.part);
    if (is_new) known->second = areas_by_slot(part.mesh);
    Json tags = Json::array();
    for (const auto& [slot, area] : known->second)
      if (slot < part.materials.size())
        if (const Material& material = scene.materials[part.materials[slot]]; material.haptic)
          tags.push_back({{"material", material.name},
                          {"area", rounded(area * area_scale(instance.world))},
                          {"tag", constants_json(*material.haptic)}});
    if (!tags.empty()) add(node_extras_json[instance.node], k_node_tags, std::move(tags));
  }
}

std::optional<TagManifest> take_tag_manifest(Scene& scene) {
  const Json own = take_member(scene.asset.extras_json, k_tag_manifest);
  TagManifest of_nodes;
  for (Node& node : scene.nodes) try {
      if (const Json tags = take_member(node.extras_json, k_node_tags); !tags.is_null())
        add_node_tags(tags, node.name, of_nodes);
    } catch (const std::exception&) {
      scene.warnings.push_back("node '" + one_line(node.name) + "': its " + k_node_tags + " can't be read");
    }
  if (!own.is_null()) try {
      std::vector<HapticWarning> warnings;
      TagManifest manifest = manifest_of(own, warnings);
      for (const HapticWarning& warning : warnings)
        scene.warnings.push_back(std::string(k_tag_manifest) + ": " + warning.message);
      return manifest;
    } catch (const std::exception& error) {
      scene.warnings.push_back(std::string("asset.extras.") + k_tag_manifest +
                               ": can't be read: " + first_line(error.what()));
    }
  if (of_nodes.materials.empty()) return std::nullopt;
  return of_nodes;
}

}  // namespace papilla
