// SPDX-License-Identifier: MIT
#include "surface/atlas_uv.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/node_places.hpp"

namespace papilla {
namespace {

/// One instance's changes without the instance: parts with the same ones can be shared.
using Variant = std::vector<std::pair<std::size_t, std::array<std::pair<double, double>, 3>>>;

Variant variant_of(std::span<const NewUv> changes) {
  Variant variant;
  for (const NewUv& c : changes) {
    variant.push_back({c.triangle, {}});
    for (std::size_t k = 0; k < 3; ++k) variant.back().second[k] = {c.uv[k].x, c.uv[k].y};
  }
  return variant;
}

void change(TriangleMesh& mesh, const Variant& variant) {
  if (mesh.uv1.empty()) mesh.uv1 = mesh.uv;
  if (mesh.uv.empty()) mesh.uv.indices.assign(mesh.triangles.size(), {k_no_value, k_no_value, k_no_value});
  std::map<std::pair<double, double>, Index> known;
  for (const auto& [triangle, corners] : variant)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [it, is_new] = known.try_emplace(corners[k], static_cast<Index>(mesh.uv.values.size()));
      if (is_new) mesh.uv.values.push_back({corners[k].first, corners[k].second});
      mesh.uv.indices[triangle][k] = it->second;
    }
}

void move_to_second_channel(Material& material, bool keeps_relief) {
  if (keeps_relief && material.normal_texture && material.normal_texture->tex_coord == 0)
    material.normal_texture->tex_coord = 1;
  for (std::optional<TextureReference>* reference : {&material.occlusion_texture, &material.emissive_texture})
    if (*reference && (*reference)->tex_coord == 0) (*reference)->tex_coord = 1;
  if (!material.haptic) return;
  for (PlacedPicture* picture : pictures_of(*material.haptic)) picture->tex_coord = 1;
}

}  // namespace

void set_atlas_uv(Scene& scene, std::span<const Instance> all, std::vector<NewUv> changes,
                  std::span<const AtlasMaterial> materials) {
  std::stable_sort(changes.begin(), changes.end(), [](const NewUv& a, const NewUv& b) {
    return std::pair(a.instance, a.triangle) < std::pair(b.instance, b.triangle);
  });
  std::map<std::uint32_t, TriangleMesh> original;
  std::map<std::uint32_t, std::map<Variant, std::uint32_t>> written;
  for (auto first = changes.begin(); first != changes.end();) {
    const auto last = std::find_if(first, changes.end(), [&](const NewUv& c) { return c.instance != first->instance; });
    const Instance& instance = all[first->instance];
    const Variant variant = variant_of({first, last});
    first = last;
    auto& variants = written[instance.part];
    if (const auto known = variants.find(variant); known != variants.end()) {
      scene.nodes[instance.node].part = known->second;
      continue;
    }
    std::uint32_t part = instance.part;
    if (variants.empty()) {
      const TriangleMesh& mesh = scene.parts[part].mesh;
      original.emplace(part, mesh);
      if (!mesh.uv1.empty())
        scene.losses.push_back("part '" + shown_name(scene.parts[part]) +
                               "': the coordinates of what the atlas replaced, for the second ones were taken");
      if (!scene.parts[part].levels.empty())
        scene.losses.push_back("part '" + shown_name(scene.parts[part]) +
                               "': its levels of detail, which the atlas does not fit");
      scene.parts[part].levels.clear();
    } else {
      part = static_cast<std::uint32_t>(scene.parts.size());
      scene.parts.push_back(scene.parts[instance.part]);
      scene.parts[part].mesh = original.at(instance.part);
      scene.parts[part].id += "~" + std::to_string(variants.size() + 1);
    }
    change(scene.parts[part].mesh, variant);
    scene.nodes[instance.node].part = part;
    variants.emplace(variant, part);
  }
  for (const AtlasMaterial& m : materials) move_to_second_channel(scene.materials[m.material], m.keeps_relief);
}

}  // namespace papilla
