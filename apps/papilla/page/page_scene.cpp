// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/page_scene.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <optional>
#include <span>

#include "json/scene_json.hpp"
#include "page/page_material.hpp"
#include "page/page_mesh.hpp"
#include "papilla/core/base64.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/decode_grey16.hpp"
#include "papilla/io/height_source.hpp"
#include "papilla/io/node_places.hpp"

namespace papilla::app {
namespace {

constexpr CornerAttribute<Vec2> const* k_no_uv = nullptr;

Json pair(Vec2 v) { return {v.x, v.y}; }
Json triple(Vec3 v) { return {v.x, v.y, v.z}; }

Json mesh_json(const PageMesh& mesh, const Part& part) {
  return {{"material", mesh.slot < part.materials.size() ? Json(part.materials[mesh.slot]) : Json(nullptr)},
          {"triangles", mesh.triangles},
          {"shown", mesh.shown},
          {"vertices", mesh.vertices},
          {"error_mm", mesh.error_mm},
          {"uv", mesh.has_uv},
          {"low", triple(mesh.low)},
          {"high", triple(mesh.high)},
          {"uv_low", pair(mesh.uv_low)},
          {"uv_high", pair(mesh.uv_high)},
          {"uv1_low", pair(mesh.uv1_low)},
          {"uv1_high", pair(mesh.uv1_high)},
          {"vertex_stream", encode_base64(mesh.vertex_stream)},
          {"index_stream", encode_base64(mesh.index_stream)},
          {"uv1_stream", encode_base64(mesh.uv1_stream)},
          {"coarse", mesh.coarse},
          {"coarse_stream", encode_base64(mesh.coarse_stream)}};
}

/// Where nothing is tagged or pictured, channel 0 is what people made.
const CornerAttribute<Vec2>* shown_uv(const TriangleMesh& mesh) {
  if (!mesh.uv.empty()) return &mesh.uv;
  return mesh.uv1.empty() ? k_no_uv : &mesh.uv1;
}

struct ShownPart {
  std::vector<PageMesh> meshes;
  DistortionReport distortion;
};

/// The pictures of a material that the page shows.
std::array<const std::optional<TextureReference>*, 3> shown_maps(const Material& material) {
  return {&material.base_color_texture, &material.normal_texture, &material.metallic_roughness_texture};
}

/// Whether something that the page shows of a material lies on channel 1.
bool lies_on_uv1(const Material& material) {
  for (const auto* map : shown_maps(material))
    if (*map && (*map)->tex_coord == 1) return true;
  return material.haptic && tex_coord_of(*material.haptic) == 1;
}

ShownPart show_part(const Scene& scene, const Part& part, double keep) {
  static const CornerAttribute<Vec2> none;
  const CornerAttribute<Vec2>* uv = shown_uv(part.mesh);
  ShownPart shown;
  if (uv) shown.distortion = measure_distortion(part.mesh, *uv, {.texture_px = {1, 1}});
  std::vector<bool> needs_uv1;
  for (const std::uint32_t m : part.materials)
    needs_uv1.push_back(uv != &part.mesh.uv1 && m < scene.materials.size() && lies_on_uv1(scene.materials[m]));
  shown.meshes = page_meshes(part.mesh, uv ? *uv : none, needs_uv1, shown.distortion, keep);
  shown.distortion.per_triangle = std::vector<TriangleDistortion>();
  return shown;
}

std::vector<ShownPart> show_parts(const Scene& scene, double keep, const ProgressCallback& progress) {
  std::vector<ShownPart> shown(scene.parts.size());
  std::atomic<std::size_t> done = 0;
  oneapi::tbb::parallel_for(std::size_t{0}, scene.parts.size(), [&](std::size_t i) {
    try {
      shown[i] = show_part(scene, scene.parts[i], keep);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(scene.parts[i]) + "': " + error.what());
    }
    ++done;
  });
  report_progress(progress, "page", 1);
  return shown;
}

/// Environments, each once.
class PageEnvironments {
 public:
  Json number_of(const std::optional<EnvironmentPicture>& picture) {
    if (!picture) return nullptr;
    const auto known = std::find(pictures_.begin(), pictures_.end(), *picture);
    if (known != pictures_.end()) return known - pictures_.begin();
    pictures_.push_back(*picture);
    list.push_back({{"width", picture->width},
                    {"height", picture->height},
                    {"rgbe", encode_base64(std::as_bytes(std::span(picture->rgbe)))}});
    return pictures_.size() - 1;
  }

  Json list = Json::array();

 private:
  std::vector<EnvironmentPicture> pictures_;
};

/// Materials, and the height maps that their tags name.
class PageMaterials {
 public:
  PageMaterials(const Scene& scene, const std::filesystem::path& file, PageEnvironments& environments)
      : scene_(scene), file_(file), environments_(environments) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) add(scene.materials[i], i);
  }

  Json materials = Json::array(), heights = Json::array();

 private:
  void add(const Material& material, std::size_t number) {
    Json json = look_json(scene_, material);
    json["unlit"] = material.extensions_json.find("\"KHR_materials_unlit\"") != std::string::npos;
    json["environment"] = environments_.number_of(environment_of(material));
    json["haptic"] = nullptr;
    json["height"] = nullptr;
    std::vector<HapticWarning> warnings = material.haptic_warnings;
    if (const auto& tag = material.haptic) {
      if (tag->height) json["height"] = height(*tag->height, number, warnings);
      json["haptic"] = tag_json(*tag);
    }
    for (const auto* map : shown_maps(material))
      if (*map && texture_json(scene_, *map).is_null())
        warnings.push_back(
            {"picture_not_shown", "a picture of it is missing or in a format that browsers do not show"});
    json["warnings"] = Json::array();
    for (const HapticWarning& warning : warnings) json["warnings"].push_back(warning.code + ": " + warning.message);
    materials.push_back(std::move(json));
  }

  Json height(const HeightTag& tag, std::size_t material, std::vector<HapticWarning>& warnings) {
    const auto bytes = find_height_bytes(tag, scene_, file_, material, warnings);
    if (!bytes) return nullptr;
    const auto [place, added] = number_.try_emplace(*bytes, heights.size());
    if (!added) return place->second;
    const auto span = std::as_bytes(std::span(bytes->data(), bytes->size()));
    try {
      const Grey16 picture = decode_grey16(span, "height map");
      heights.push_back(
          {{"png", encode_base64(span)}, {"width", picture.width}, {"height", picture.height}, {"bits", picture.bits}});
      return place->second;
    } catch (const Error& error) {
      warnings.push_back({"height_image", error.what()});
      number_.erase(place);
      return nullptr;
    }
  }

  const Scene& scene_;
  std::filesystem::path file_;
  PageEnvironments& environments_;
  std::map<std::string, std::size_t> number_;
};

/// The pictures that materials show; null for the others, so that numbers stay.
Json images_json(const Scene& scene) {
  Json images = Json::array();
  for (std::size_t i = 0; i < scene.images.size(); ++i) images.push_back(nullptr);
  for (const Material& material : scene.materials)
    for (const auto* map : shown_maps(material)) {
      if (!*map || (*map)->texture >= scene.textures.size()) continue;
      const auto number = scene.textures[(*map)->texture].image;
      if (!number || *number >= scene.images.size() || !images[*number].is_null()) continue;
      const EncodedImage& image = scene.images[*number];
      if (!is_shown_by_browsers(image)) continue;
      images[*number] = {{"name", image.name}, {"type", image.mime_type}, {"bytes", encode_base64(image.bytes)}};
    }
  return images;
}

/// What nodes show: first the finest levels of detail, then the coarser ones.
struct ShownUses {
  std::vector<Instance> uses;
  std::vector<std::optional<PageLevel>> levels;  ///< Of each.
  std::size_t finest = 0;                        ///< So many.
};

ShownUses uses_of(const Scene& scene, const std::vector<PageLevels>& levels) {
  const std::vector<Instance> drawn = instances(scene);
  const std::vector<std::optional<PageLevel>> of_drawn = levels_of(scene, drawn, levels);
  ShownUses shown;
  for (const bool coarser : {false, true}) {
    if (coarser) shown.finest = shown.uses.size();
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      if ((of_drawn[i] && of_drawn[i]->number > 0) != coarser) continue;
      shown.uses.push_back(drawn[i]);
      shown.levels.push_back(of_drawn[i]);
    }
  }
  return shown;
}

Json use_json(const Scene& scene, const Instance& use, const std::optional<PageLevel>& level) {
  Json json = {{"part", use.part}, {"name", scene.nodes[use.node].name}, {"world", use.world}};
  if (level) json["level"] = {{"place", level->place}, {"number", level->number}};
  return json;
}

Json coverages_json(const std::vector<PageLevels>& levels) {
  Json json = Json::array();
  for (const PageLevels& place : levels) json.push_back(place.coverages);
  return json;
}

}  // namespace

PageScene page_scene(const Scene& scene, const std::filesystem::path& file, const PageSceneOptions& options,
                     const ProgressCallback& progress) {
  const ShownUses drawn = uses_of(scene, options.levels);
  const std::span finest(drawn.uses.data(), drawn.finest);
  std::size_t triangles = 0, triangles_shown = 0;
  double error_mm = 0;
  for (const Instance& use : finest) triangles += scene.parts[use.part].mesh.triangles.size();
  const double keep =
      std::min(1.0, static_cast<double>(options.triangles) / static_cast<double>(std::max<std::size_t>(triangles, 1)));
  const std::vector<ShownPart> shown = show_parts(scene, keep, progress);

  Json parts = Json::array(), uses = Json::array();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    Json meshes = Json::array();
    for (const PageMesh& mesh : shown[i].meshes) {
      meshes.push_back(mesh_json(mesh, scene.parts[i]));
      error_mm = std::max(error_mm, mesh.error_mm);
    }
    parts.push_back(
        {{"name", shown_name(scene.parts[i])},
         {"triangles", scene.parts[i].mesh.triangles.size()},
         {"meshes", std::move(meshes)},
         {"distortion", shown_uv(scene.parts[i].mesh) ? distortion_json(shown[i].distortion) : Json(nullptr)}});
  }
  for (std::size_t i = 0; i < drawn.uses.size(); ++i) uses.push_back(use_json(scene, drawn.uses[i], drawn.levels[i]));
  for (const Instance& use : finest)
    for (const PageMesh& mesh : shown[use.part].meshes) triangles_shown += mesh.shown;
  PageEnvironments environments;
  const Json environment = environments.number_of(options.environment);
  PageMaterials materials(scene, file, environments);
  Json json = {{"file", file.filename().string()},
               {"triangles", triangles},
               {"triangles_shown", triangles_shown},
               {"error_mm", error_mm},
               {"z_up", scene.up == UpAxis::z},
               {"parts", std::move(parts)},
               {"instances", std::move(uses)},
               {"finest_instances", drawn.finest},
               {"levels", coverages_json(options.levels)},
               {"materials", std::move(materials.materials)},
               {"heights", std::move(materials.heights)},
               {"images", images_json(scene)},
               {"environments", std::move(environments.list)},
               {"environment", environment},
               {"losses", scene.losses},
               {"warnings", scene.warnings}};
  return {std::move(json), triangles, triangles_shown, error_mm};
}

}  // namespace papilla::app
