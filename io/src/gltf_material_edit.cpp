// SPDX-License-Identifier: MIT
#include "gltf_material_edit.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "glb_document.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/one_line.hpp"

namespace papilla {
namespace {

using Json = GltfFile::Json;

constexpr const char *k_variants = "KHR_materials_variants", *k_transform = "KHR_texture_transform";
constexpr int k_most_channels = 8;  ///< A tag names one of 0..7.
constexpr int k_triangles = 4;      ///< primitive.mode; strips and fans are 5 and 6.

/// TEXCOORD attributes; they are numbered without gaps.
int channels_of(const Json& primitive) {
  int count = 0;
  for (const auto& [name, accessor] : primitive["attributes"].items()) count += name.starts_with("TEXCOORD_");
  return count;
}

/// The list of variants of a primitive, or null.
Json* mappings_of(Json& primitive) {
  if (!primitive.contains("extensions") || !primitive["extensions"].contains(k_variants)) return nullptr;
  Json& variants = primitive["extensions"][k_variants];
  return variants.contains("mappings") ? &variants["mappings"] : nullptr;
}

/// The numbers of a material's coarser levels, or null.
Json* levels_of(Json& material) {
  static const Json::json_pointer ids("/extensions/MSFT_lod/ids");
  return material.contains(ids) ? &material[ids] : nullptr;
}

/// Whether both make the same of a material. Edits of one rule differ in the scale of kept uv at most.
bool same_material(const GltfSurfaceEdit& a, const GltfSurfaceEdit& b) {
  return a.rule == b.rule && a.transform == b.transform && a.uv.empty() == b.uv.empty() &&
         a.double_sided == b.double_sided && a.tag.has_value() == b.tag.has_value() &&
         (!a.rule.empty() || a.tag == b.tag);
}

bool is_only_tag(const GltfSurfaceEdit& edit) {
  return edit.normal_map == nullptr && edit.picture == nullptr && !edit.base_color && !edit.roughness &&
         !edit.metallic && !edit.double_sided && edit.environment_json.empty();
}

class MaterialEditor {
 public:
  MaterialEditor(GltfFile& file, std::vector<std::string>& notes) : file_(file), notes_(notes) {
    if (!file.json.contains("nodes")) return;
    for (const Json& node : file.json["nodes"])
      if (node.contains("mesh")) shown_meshes_.insert(node["mesh"].get<std::uint32_t>());
  }

  std::vector<EditedMaterial> run(const WantedEdits& wanted) {
    collect(wanted);
    choose_channels();
    std::set<std::size_t> taken;
    for (EditedMaterial& material : materials_) write(material, taken);
    for (const EditedMaterial& material : materials_) {
      link_levels(material);
      if (material.original && *material.original != material.number)
        file_.copy_animations("materials", *material.original, material.number);
    }
    return std::move(materials_);
  }

 private:
  Json& primitive(PrimitiveNumber number) { return file_.json["meshes"][number.first]["primitives"][number.second]; }

  void collect(const WantedEdits& wanted) {
    if (!file_.json.contains("meshes")) return;
    for (std::uint32_t m = 0; m < file_.json["meshes"].size(); ++m)
      for (std::uint32_t p = 0; p < file_.json["meshes"][m]["primitives"].size(); ++p) {
        Json& json = primitive({m, p});
        const auto found = wanted.find({m, p});
        const GltfSurfaceEdit* edit = found == wanted.end() ? nullptr : found->second;
        add_uses({{m, p}, std::nullopt}, json, edit);
        const Json* mappings = mappings_of(json);
        for (std::size_t i = 0; mappings != nullptr && i < mappings->size(); ++i)
          add_uses({{m, p}, i}, (*mappings)[i], edit);
      }
  }

  /// @param owner  has the member "material".
  void add_uses(MaterialUse use, const Json& owner, const GltfSurfaceEdit* edit) {
    if (!owner.contains("material")) return add_use(use, std::nullopt, edit);
    const auto number = owner["material"].get<std::size_t>();
    add_use(use, number, edit);
    const Json* levels = levels_of(file_.json["materials"].at(number));
    use.is_level = true;
    for (std::size_t i = 0; levels != nullptr && i < levels->size(); ++i)
      add_use(use, (*levels)[i].get<std::size_t>(), edit);
  }

  void add_use(const MaterialUse& use, std::optional<std::size_t> original, const GltfSurfaceEdit* edit) {
    if (edit == nullptr || edit->keeps_material) {
      if (!original) return;
      other_uses_.insert(*original);
      // What draws no triangles, or is not shown, can't be touched: a tag alone does not matter there.
      const bool is_shown = shown_meshes_.contains(use.primitive.first);
      if (is_shown && primitive(use.primitive).value("mode", k_triangles) >= k_triangles)
        other_surfaces_.insert(*original);
      return;
    }
    const auto known = std::find_if(materials_.begin(), materials_.end(), [&](const EditedMaterial& m) {
      return m.original == original && same_material(*m.edit, *edit);
    });
    if (known == materials_.end())
      materials_.push_back({original, edit, {use}, 0, 0, false});
    else
      known->uses.push_back(use);
  }

  /// A primitive has one channel for all of its variants, a material one for all of its primitives.
  void choose_channels() {
    std::map<PrimitiveNumber, int> of_primitive;
    for (bool changed = true; changed;) {
      changed = false;
      for (EditedMaterial& material : materials_) {
        if (material.edit->uv.empty()) continue;
        int channel = std::max(material.channel, free_channel(material));
        for (const MaterialUse& use : material.uses) channel = std::max(channel, of_primitive[use.primitive]);
        if (channel >= k_most_channels)
          throw InvalidInput("mesh " + std::to_string(material.uses.front().primitive.first) +
                             ": no channel of texture coordinates below 8 is free");
        changed = changed || channel != material.channel;
        material.channel = channel;
        for (const MaterialUse& use : material.uses) {
          changed = changed || of_primitive[use.primitive] != channel;
          of_primitive[use.primitive] = channel;
        }
      }
    }
  }

  int free_channel(const EditedMaterial& material) {
    int most = 0, least = k_most_channels;
    for (const MaterialUse& use : material.uses) {
      const int channels = channels_of(primitive(use.primitive));
      most = std::max(most, channels), least = std::min(least, channels);
    }
    if (!material.original) return most;
    Json json = file_.json["materials"].at(*material.original);
    const int earlier = earlier_channel(json);
    remove_own_pictures(*material.edit, json);
    const int named = largest_tex_coord(json);
    if (earlier > 0 && earlier == most - 1 && least == most && named < earlier) return earlier;
    return least < most || most == 0 ? std::max(most, named + 1) : most;
  }

  /// The channel that an earlier run added, or −1.
  static int earlier_channel(const Json& material) {
    const Json::json_pointer own("/extras/papilla"), channel("/extras/haptic/height/texCoord");
    if (!material.contains(own) || !material.contains(channel) || !material[channel].is_number_unsigned()) return -1;
    return material[channel].get<int>();
  }

  bool is_own(const Json& owner, const char* member, const EncodedImage* picture) const {
    if (!owner.contains(member) || picture == nullptr) return false;
    const Json& texture = file_.json["textures"][owner[member]["index"].get<std::size_t>()];
    return texture.value("name", "") == picture->name;
  }

  /// Those that an earlier run gave the material.
  void remove_own_pictures(const GltfSurfaceEdit& edit, Json& material) const {
    if (!material.contains("extras") || !material["extras"].is_object() || !material["extras"].contains("papilla"))
      return;
    if (is_own(material, "normalTexture", edit.normal_map)) material.erase("normalTexture");
    if (!material.contains("pbrMetallicRoughness")) return;
    Json& pbr = material["pbrMetallicRoughness"];
    if (is_own(pbr, "baseColorTexture", edit.picture)) pbr.erase("baseColorTexture");
    if (is_own(pbr, "metallicRoughnessTexture", edit.shine)) pbr.erase("metallicRoughnessTexture");
  }

  void write(EditedMaterial& material, std::set<std::size_t>& taken) {
    const auto& original = material.original;
    Json& list = file_.json["materials"];
    const auto& others = is_only_tag(*material.edit) ? other_surfaces_ : other_uses_;
    if (original && !others.contains(*original) && taken.insert(*original).second) {
      material.number = *original;
    } else {
      material.number = list.size();
      list.push_back(original ? Json(list.at(*original)) : Json::object());
      name_copy(material.edit->rule, original.has_value(), list.back());
      for (const MaterialUse& use : material.uses) {
        if (use.is_level) continue;
        Json& owner = primitive(use.primitive);
        (use.mapping ? (*mappings_of(owner))[*use.mapping] : owner)["material"] = material.number;
      }
    }
    Json json = list.at(material.number);
    edit(material, json);
    file_.json["materials"][material.number] = std::move(json);
  }

  /// The coarser levels of an edited material are those that were edited with it.
  void link_levels(const EditedMaterial& material) {
    if (!material.original) return;
    Json* levels = levels_of(file_.json["materials"][material.number]);
    for (std::size_t i = 0; levels != nullptr && i < levels->size(); ++i) {
      Json& number = (*levels)[i];
      const auto level = std::find_if(materials_.begin(), materials_.end(), [&](const EditedMaterial& m) {
        return m.original == number.get<std::size_t>() && same_material(*m.edit, *material.edit);
      });
      if (level != materials_.end()) number = level->number;
    }
  }

  /// Another name than any other material has, so that the tag can be found again by it.
  void name_copy(const std::string& rule, bool is_copy, Json& material) const {
    const std::string own = material.value("name", "");
    const std::string name = own.empty() ? rule : is_copy && !rule.empty() ? own + " " + rule : own;
    if (name.empty()) return;
    material["name"] = name;
    const auto is_taken = [&](const Json& wanted) {
      const Json& all = file_.json["materials"];
      return std::count_if(all.begin(), all.end(), [&](const Json& m) {
               return m.value("name", "") == wanted.get_ref<const std::string&>();
             }) > 1;
    };
    for (int i = 2; is_taken(material["name"]); ++i) material["name"] = name + " " + std::to_string(i);
  }

  void edit(EditedMaterial& material, Json& json) {
    const GltfSurfaceEdit& edit = *material.edit;
    edit_extras(material, json);
    if (!edit.rule.empty()) remove_own_pictures(edit, json);
    if (edit.base_color) json["pbrMetallicRoughness"]["baseColorFactor"] = *edit.base_color;
    if (edit.roughness) json["pbrMetallicRoughness"]["roughnessFactor"] = *edit.roughness;
    if (edit.metallic) json["pbrMetallicRoughness"]["metallicFactor"] = *edit.metallic;
    if (edit.double_sided) json["doubleSided"] = true;
    if (edit.picture != nullptr && !has_base_picture(json)) {
      Json& pbr = json["pbrMetallicRoughness"];
      pbr["baseColorTexture"] = reference(*edit.picture, material);
      const Json alpha = pbr.contains("baseColorFactor") ? pbr["baseColorFactor"][3] : Json(1);
      pbr["baseColorFactor"] = {1, 1, 1, alpha};
      if (edit.picture_roughness) edit_shine(material, pbr);
    }
    if (edit.normal_map == nullptr) return;
    const std::string reason = why_no_normal_map(material, json);
    material.has_normal_map = reason.empty();
    if (reason.empty())
      json["normalTexture"] = reference(*edit.normal_map, material);
    else
      notes_.push_back("material '" + one_line(json.value("name", "")) + "': " + reason +
                       ", so that the grain is felt and its normal map is not shown");
  }

  void edit_shine(const EditedMaterial& material, Json& pbr) {
    const GltfSurfaceEdit& edit = *material.edit;
    pbr["roughnessFactor"] = *edit.picture_roughness;
    pbr["metallicFactor"] = *edit.picture_metallic;
    pbr.erase("metallicRoughnessTexture");
    if (edit.shine != nullptr) pbr["metallicRoughnessTexture"] = reference(*edit.shine, material);
  }

  static bool has_base_picture(const Json& material) {
    return material.contains(Json::json_pointer("/pbrMetallicRoughness/baseColorTexture")) ||
           material.contains(Json::json_pointer("/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture"));
  }

  /// Tangents belong to one map.
  std::string why_no_normal_map(const EditedMaterial& material, const Json& json) {
    if (json.contains("normalTexture")) return "it keeps its own normal map";
    for (const char* other : {"KHR_materials_anisotropy", "KHR_materials_clearcoat"})
      if (json.contains("extensions") && json["extensions"].contains(other) &&
          (std::string_view(other).ends_with("anisotropy") ||
           json["extensions"][other].contains("clearcoatNormalTexture")))
        return std::string("its tangents are those of ") + other;
    for (const MaterialUse& use : material.uses) {
      const Json& json_primitive = primitive(use.primitive);
      if (!json_primitive.contains("targets")) continue;
      for (const Json& target : json_primitive["targets"])
        if (target.contains("TANGENT")) return "its tangents have morph targets";
    }
    return {};
  }

  void edit_extras(const EditedMaterial& material, Json& json) const {
    const GltfSurfaceEdit& edit = *material.edit;
    if (json.contains("extras") && !json["extras"].is_object()) {
      if (!edit.tag) return;
      throw InvalidInput("material " + std::to_string(material.number) + " '" + one_line(json.value("name", "")) +
                         "': extras that hold a haptic tag must be an object");
    }
    if (edit.tag) {
      MaterialTag tag = *edit.tag;
      if (!edit.uv.empty())
        for (PlacedPicture* picture : pictures_of(tag)) picture->tex_coord = material.channel;
      json["extras"]["haptic"] = haptic_json(tag);
    } else if (json.contains("extras")) {
      json["extras"].erase("haptic");
    }
    if (!edit.rule.empty()) {
      Json& own = json["extras"]["papilla"];
      own["material"] = edit.rule;
      if (edit.environment_json.empty())
        own.erase("environment");
      else
        own["environment"] = Json::parse(edit.environment_json);
    }
    if (json.contains("extras") && json["extras"].empty()) json.erase("extras");
  }

  Json reference(const EncodedImage& image, const EditedMaterial& material) {
    Json json = {{"index", texture_of(image)}};
    if (material.channel != 0) json["texCoord"] = material.channel;
    if (material.edit->transform) {
      json["extensions"][k_transform] = texture_transform_json(*material.edit->transform);
      file_.use_extension(k_transform);
    }
    return json;
  }

  std::size_t texture_of(const EncodedImage& image) {
    const std::size_t source = file_.add_picture(image);
    const std::size_t sampler = file_.add("samplers", {{"magFilter", 9729}, {"minFilter", 9987}});
    return file_.add("textures", {{"sampler", sampler}, {"source", source}, {"name", image.name}});
  }

  GltfFile& file_;
  std::vector<std::string>& notes_;
  std::set<std::uint32_t> shown_meshes_;
  std::set<std::size_t> other_uses_, other_surfaces_;  ///< Materials that what has no edit shows.
  std::vector<EditedMaterial> materials_;
};

}  // namespace

std::vector<EditedMaterial> edit_materials(GltfFile& file, const WantedEdits& wanted, std::vector<std::string>& notes) {
  return MaterialEditor(file, notes).run(wanted);
}

}  // namespace papilla
