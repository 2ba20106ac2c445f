// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "papilla/core/one_line.hpp"
#include "papilla/io/tag_manifest.hpp"
#include "surface_groups.hpp"

namespace papilla {
namespace {

constexpr double k_area_tolerance = 0.02;  // Quantized positions and mild simplification stay within.
constexpr double k_box_tolerance = 0.005;  // Of the box's diagonal.
constexpr double k_merged = 1.05;          // A material of more than this times its surfaces' area is several ones.

bool same_box(const Bounds3& a, const Bounds3& b) {
  const double most = k_box_tolerance * std::max(a.diagonal(), b.diagonal());
  return norm(a.low - b.low) <= most && norm(a.high - b.high) <= most;
}

class TagRestorer {
 public:
  TagRestorer(Scene& scene, const TagManifest& manifest, const PartTriangles& triangles)
      : scene_(scene), manifest_(manifest), triangles_(triangles) {
    by_.resize(manifest.materials.size());
    for (std::uint32_t e = 0; e < by_.size(); ++e)
      if (!is_kept(manifest.materials[e])) missing_.insert(e);
  }

  TagSurvival run() {
    TagSurvival result;
    result.expected = manifest_.materials.size();
    for (const std::uint32_t e : missing_) restore_by_name(e);
    const bool all_found = std::all_of(missing_.begin(), missing_.end(), [&](auto e) { return !by_[e].empty(); });
    const bool all_known = std::none_of(scene_.materials.begin(), scene_.materials.end(),
                                        [&](const Material& m) { return m.haptic && entries_named(m.name) == 0; });
    if (!all_found || !all_known) restore_surfaces();
    for (const std::uint32_t e : missing_) result.missing.push_back({manifest_.materials[e].name, by_[e]});
    return result;
  }

 private:
  bool is_kept(const TagManifest::Entry& entry) const {
    return std::any_of(scene_.materials.begin(), scene_.materials.end(), [&](const Material& m) {
      return m.haptic && (m.name == entry.name || same_feel(*m.haptic, entry.tag));
    });
  }

  std::size_t entries_named(const std::string& name) const {
    const auto& all = manifest_.materials;
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [&](const auto& e) { return e.name == name; }));
  }

  void give(Material& material, std::uint32_t e, const std::string& by) {
    const TagManifest::Entry& entry = manifest_.materials[e];
    by_[e] = by;
    material.name = entry.name;
    material.haptic = entry.tag;
    std::string message = "the tag was missing and is found again by the " + by;
    for (PlacedPicture* picture : pictures_of(*material.haptic))
      if (picture->uri.empty() && !find_picture(*picture))
        message += material.haptic->height && picture == &*material.haptic->height ? ", without its height map"
                                                                                   : ", without its maps";
    material.haptic_warnings.push_back({"tag_restored", message});
  }

  /// A picture of the same bytes, within another tag.
  bool find_picture(PlacedPicture& picture) {
    if (!picture.image.empty()) return true;  // By its name, as ever.
    if (const std::string* uri = tag_picture(scene_, picture.sha256)) {
      picture.uri = *uri;
      return true;
    }
    return false;
  }

  void restore_by_name(std::uint32_t e) {
    const std::string& name = manifest_.materials[e].name;
    if (name.empty() || entries_named(name) != 1) return;
    for (Material& material : scene_.materials)
      if (material.name == name && !material.haptic) give(material, e, "material name");
  }

  void restore_surfaces() {
    const std::vector<SurfaceGroup> groups = surface_groups(scene_, triangles_);
    const std::set<std::uint32_t> merged = merged_materials(groups);
    for (const SurfaceGroup& group : groups) {
      const bool doubtful = merged.contains(group.material);
      if (scene_.materials[group.material].haptic && !doubtful) continue;
      std::string by;
      const auto entry = entry_of(group, by);
      if (entry || doubtful) scene_.parts[group.part].materials[group.slot] = material_for(group.material, entry, by);
    }
  }

  /// Materials that carry the tag of one entry and are not named as any, on much more surface than it had.
  std::set<std::uint32_t> merged_materials(const std::vector<SurfaceGroup>& groups) const {
    std::map<std::uint32_t, double> area, wanted;
    for (const SurfaceGroup& group : groups) area[group.material] += group.area_m2;
    for (const TagManifest::Surface& surface : manifest_.surfaces)
      if (surface.material) wanted[*surface.material] += surface.area_m2;
    std::set<std::uint32_t> merged;
    for (const auto& [m, there] : area) {
      const Material& material = scene_.materials[m];
      if (!material.haptic || entries_named(material.name) > 0) continue;
      for (std::uint32_t e = 0; e < manifest_.materials.size(); ++e)
        if (same_feel(*material.haptic, manifest_.materials[e].tag) && there > k_merged * wanted[e]) merged.insert(m);
    }
    return merged;
  }

  /// The entry whose surface the group is; nothing when it is that of several, or of none.
  std::optional<std::uint32_t> entry_of(const SurfaceGroup& group, std::string& by) const {
    const std::string& part = scene_.parts[group.part].name;
    const std::string& node = scene_.nodes[group.node].name;
    std::vector<const TagManifest::Surface*> named, placed;
    for (const TagManifest::Surface& surface : manifest_.surfaces) {
      if (std::abs(surface.area_m2 - group.area_m2) > k_area_tolerance * surface.area_m2) continue;
      const bool same_part = !part.empty() && surface.part == part, same_node = !node.empty() && surface.node == node;
      if (same_part || same_node) named.push_back(&surface);
      if (surface.box_m && same_box(*surface.box_m, group.box_m)) placed.push_back(&surface);
    }
    const auto only = [](const std::vector<const TagManifest::Surface*>& all) {
      const bool one = !all.empty() && std::all_of(all.begin(), all.end(),
                                                   [&](const auto* s) { return s->material == all.front()->material; });
      return one ? all.front()->material : std::nullopt;
    };
    by = "part";
    if (const auto entry = only(named)) return entry;
    by = "place";
    return only(placed);
  }

  /// A material that looks as `source` and has the tag of an entry, or none.
  std::uint32_t material_for(std::uint32_t source, std::optional<std::uint32_t> entry, const std::string& by) {
    const auto [known, is_new] =
        made_.try_emplace({source, entry}, static_cast<std::uint32_t>(scene_.materials.size()));
    if (!is_new) return known->second;
    Material material = scene_.materials[source];
    material.haptic.reset();
    material.haptic_warnings.clear();
    if (entry) give(material, *entry, by);
    scene_.materials.push_back(std::move(material));
    return known->second;
  }

  Scene& scene_;
  const TagManifest& manifest_;
  const PartTriangles& triangles_;
  std::set<std::uint32_t> missing_;
  std::vector<std::string> by_;  ///< How each entry was restored.
  std::map<std::pair<std::uint32_t, std::optional<std::uint32_t>>, std::uint32_t> made_;
};

}  // namespace

bool same_feel(MaterialTag a, MaterialTag b) {
  for (MaterialTag* tag : {&a, &b})
    for (PlacedPicture* picture : pictures_of(*tag)) picture->uri.clear(), picture->image.clear();
  return a == b;
}

const std::string* tag_picture(const Scene& scene, const std::string& sha256) {
  for (const Material& material : scene.materials) {
    if (!material.haptic) continue;
    const std::optional<HeightTag>& height = material.haptic->height;
    const std::optional<MapsTag>& maps = material.haptic->maps;
    if (height && height->sha256 == sha256 && !height->uri.empty()) return &height->uri;
    if (maps && maps->sha256 == sha256 && !maps->uri.empty()) return &maps->uri;
  }
  return nullptr;
}

void complete_tag_pictures(Scene& scene) {
  for (Material& material : scene.materials) {
    if (!material.haptic) continue;
    for (PlacedPicture* picture : pictures_of(*material.haptic))
      if (picture->uri.empty() && picture->image.empty())
        if (const std::string* uri = tag_picture(scene, picture->sha256)) picture->uri = *uri;
  }
}

TagSurvival restore_tags(Scene& scene, const TagManifest& manifest) {
  return restore_tags(scene, manifest, mesh_triangles(scene));
}

TagSurvival restore_tags(Scene& scene, const TagManifest& manifest, const PartTriangles& triangles) {
  return TagRestorer(scene, manifest, triangles).run();
}

std::string survival_sentence(const TagSurvival& tags) {
  if (tags.missing.empty()) return "";
  std::map<std::string, std::size_t> by;
  std::string lost;
  std::size_t lost_count = 0;
  for (const MissingTag& tag : tags.missing) {
    ++by[tag.restored_by];
    if (!tag.restored_by.empty()) continue;
    ++lost_count;
    lost += (lost.empty() ? ": " : ", ") + one_line(tag.material);
  }
  std::string sentence =
      std::to_string(tags.missing.size()) + " of " + std::to_string(tags.expected) + " haptic tags were missing: ";
  for (const auto& [how, count] : by)
    if (!how.empty()) sentence += std::to_string(count) + " found again by " + how + ", ";
  return sentence + std::to_string(lost_count) + " lost" + lost;
}

}  // namespace papilla
