// SPDX-License-Identifier: GPL-3.0-or-later
#include "studio/studio_surface.hpp"

#include <bit>
#include <cstring>
#include <set>
#include <utility>

#include "json/json.hpp"
#include "json/scene_json.hpp"
#include "page/page_material.hpp"
#include "papilla/cache/digest.hpp"
#include "papilla/core/error.hpp"
#include "papilla/haptic/material_tag.hpp"
#include "papilla/io/height_source.hpp"
#include "studio/studio_answers.hpp"

namespace papilla::app {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are sent as they are");

std::string short_name(const void* data, std::size_t size) {
  constexpr std::size_t k_digits = 16;
  return to_hex(sha256(data, size)).substr(0, k_digits);
}

Json pair(Vec2 v) { return {v.x, v.y}; }

/// The first material of the look; pictures have a name by which the page keeps them, and are null where they lie on
/// the second texture coordinates. height_bytes() has the height of its tag.
Json studio_look_json(const Scene& look) {
  const Material material = look.materials.empty() ? Material{} : look.materials.front();
  Json json = look_json(look, material);
  for (const char* key : {"base_map", "normal_map", "shine_map"}) {
    Json& map = json[key];
    if (map.is_null()) continue;
    const EncodedImage& image = look.images[map["image"].get<std::size_t>()];
    if (map["tex_coord"] == 0)
      map["name"] = short_name(image.bytes.data(), image.bytes.size());
    else
      map = nullptr;
  }
  json["haptic"] = material.haptic ? tag_json(*material.haptic) : Json(nullptr);
  return json;
}

class Arrays {
 public:
  template <class T>
  void add(const char* name, const std::vector<T>& values) {
    json[name] = {{"at", bytes.size()}, {"count", values.size()}};
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T) * values.size());
    if (!values.empty()) std::memcpy(bytes.data() + at, values.data(), sizeof(T) * values.size());
  }
  Json take() { return std::exchange(json, Json::object()); }
  std::string bytes;

 private:
  Json json = Json::object();
};

/// Pages have v down the rows of pictures.
std::vector<float> uv_downwards(std::vector<float> uv) {
  for (std::size_t i = 1; i < uv.size(); i += 2) uv[i] = 1 - uv[i];
  return uv;
}

void add_vertices(const ShownMesh& mesh, Arrays& arrays) {
  arrays.add("positions", mesh.positions);
  arrays.add("normals", mesh.normals);
  arrays.add("uv", uv_downwards(mesh.uv));
  if (!mesh.uv1.empty()) arrays.add("uv1", uv_downwards(mesh.uv1));
  arrays.add("indices", mesh.indices);
}

/// @param arrays get those of the surface.
Json surface_json(const StudioSurface& surface, Arrays& arrays) {
  const ShownMesh& mesh = surface.mesh;
  add_vertices(mesh, arrays);
  arrays.add("measured", mesh.measured);
  arrays.add("seams", mesh.seams);
  Json json = {{"part", surface.part},
               {"slot", surface.slot},
               {"label", surface.label},
               {"look", studio_look_json(*surface.look)},
               {"warnings", surface.warnings},
               {"seconds", surface.seconds},
               {"mm_per_uv", pair(surface.mm_per_uv)},
               {"report", nullptr}};
  if (!surface.report.method.empty())
    json["report"] = {{"method", surface.report.method}, {"reason", surface.report.reason},
                      {"charts", surface.report.charts}, {"seam_mm", surface.report.seam_mm},
                      {"notes", surface.report.notes},   {"distortion", distortion_json(surface.report.distortion)}};
  json["arrays"] = arrays.take();
  return json;
}

}  // namespace

std::string short_name(const std::string& text) { return short_name(text.data(), text.size()); }

SharedText surface_bytes(const StudioSurface& surface) {
  Arrays arrays;
  const Json json = surface_json(surface, arrays);
  return framed(json, arrays.bytes);
}

SharedText mesh_bytes(const ShownMesh& mesh) {
  Arrays arrays;
  add_vertices(mesh, arrays);
  return framed({{"arrays", arrays.take()}}, arrays.bytes);
}

SharedText level_bytes(const std::vector<ShownLevel>& levels) {
  Json list = Json::array();
  std::string bytes;
  for (const ShownLevel& level : levels) {
    list.push_back({{"coverage", level.screen_coverage}, {"at", bytes.size()}, {"count", level.indices.size()}});
    bytes.append(reinterpret_cast<const char*>(level.indices.data()), sizeof(std::uint32_t) * level.indices.size());
  }
  return framed({{"levels", list}}, bytes);
}

SharedText decal_bytes(const StudioDecal& decal) {
  Arrays arrays;
  Json patches = Json::array();
  for (const StudioDecal::Patch& patch : decal.patches) {
    patches.push_back(surface_json(*patch.surface, arrays));
    patches.back()["use"] = patch.use;
  }
  return framed({{"patches", patches},
                 {"area_mm2", decal.report.area_mm2},
                 {"triangles", decal.report.triangles},
                 {"relief_mm", decal.report.relief_mm},
                 {"turned_off", decal.report.turned_off},
                 {"warnings", decal.warnings}},
                arrays.bytes);
}

SharedText carrier_bytes(const StudioCarriers& carriers) {
  Arrays arrays;
  Json rectangles = Json::array(), entries = Json::array();
  for (const StudioCarriers::Rectangle& rectangle : carriers.rectangles) {
    rectangles.push_back(surface_json(*rectangle.surface, arrays));
    rectangles.back()["world"] = rectangle.world;
    rectangles.back()["use"] = rectangle.use ? Json(*rectangle.use) : Json(nullptr);
  }
  for (const CarrierReport& report : carriers.reports)
    entries.push_back({{"carriers", report.carriers},
                       {"triangles", report.triangles},
                       {"saved", report.saved()},
                       {"relief_mm", report.relief_mm}});
  return framed({{"rectangles", rectangles}, {"entries", entries}, {"warnings", carriers.warnings}}, arrays.bytes);
}

PageAnswer picture_answer(const Scene& look, std::size_t number) {
  if (number >= look.images.size()) throw InvalidInput("there is no such picture");
  const EncodedImage& image = look.images[number];
  static const std::set<std::string> types = {"image/png", "image/jpeg", "image/webp", "image/avif"};
  return bytes_answer(types.contains(image.mime_type) ? image.mime_type.c_str() : "application/octet-stream",
                      std::make_shared<const std::string>(text_of(image.bytes)));
}

SharedText height_bytes(const StudioSurface& surface, const std::filesystem::path& file) {
  const std::vector<Material>& materials = surface.look->materials;
  if (materials.empty() || !materials.front().haptic || !materials.front().haptic->height)
    throw InvalidInput(surface.label + " has no height map");
  std::vector<HapticWarning> warnings;
  const auto bytes = find_height_bytes(*materials.front().haptic->height, *surface.look, file, 0, warnings);
  if (!bytes)
    throw InvalidInput(surface.label + ": " + (warnings.empty() ? "no height map" : warnings.front().message));
  return std::make_shared<const std::string>(*bytes);
}

}  // namespace papilla::app
