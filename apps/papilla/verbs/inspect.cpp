// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "papilla/pipeline/perception.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/scene_file.hpp"
#include "papilla/pipeline/pictures/scene_render.hpp"
#include "papilla/pipeline/simplify_scene.hpp"
#include "scene_options.hpp"
#include "scene_output.hpp"
#include "verb.hpp"
#include "verbs.hpp"

namespace papilla::app {
namespace {

struct InspectOptions {
  std::string file, picture;
  LeaveOutOptions perception;
  SceneOptions read;
};

std::string material_names(const Scene& scene, const Part& part) {
  std::set<std::uint32_t> used;
  for (const std::uint32_t m : part.materials)
    if (m < scene.materials.size()) used.insert(m);
  std::string names;
  for (const std::uint32_t m : used) names += (names.empty() ? "" : ", ") + scene.materials[m].name;
  return names;
}

Json parts_json(const Scene& scene, const std::vector<MeshStatistics>& statistics) {
  std::vector<std::size_t> uses(scene.parts.size(), 0);
  for (const Instance& instance : instances(scene)) ++uses[instance.part];
  Json parts = Json::array();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const MeshStatistics& s = statistics[i];
    Json part{{"name", scene.parts[i].name}};
    part.update(counters_json(s));
    part["material"] = material_names(scene, scene.parts[i]);
    part["instances"] = uses[i];
    part["bbox_mm"] = {s.high.x - s.low.x, s.high.y - s.low.y, s.high.z - s.low.z};
    part["area_mm2"] = s.area_mm2;
    part["volume_mm3"] = s.volume_mm3 ? Json(*s.volume_mm3) : Json(nullptr);
    parts.push_back(std::move(part));
  }
  return parts;
}

Json textures_json(const Scene& scene, const Material& material) {
  Json textures = Json::object();
  const auto add = [&](const char* use, const std::optional<TextureReference>& reference) {
    if (!reference || reference->texture >= scene.textures.size()) return;
    const Texture& texture = scene.textures[reference->texture];
    std::string name = texture.name;
    if (texture.image && *texture.image < scene.images.size()) {
      const EncodedImage& image = scene.images[*texture.image];
      name = !image.uri.empty() ? image.uri : !image.name.empty() ? image.name : name;
    }
    textures[use] = name.empty() ? fmt::format("texture {}", reference->texture) : name;
  };
  add("base_color", material.base_color_texture);
  add("metallic_roughness", material.metallic_roughness_texture);
  add("normal", material.normal_texture);
  add("occlusion", material.occlusion_texture);
  add("emissive", material.emissive_texture);
  return textures;
}

/// Edges of the box around all instances, along the file's axes.
Json size_mm(const Scene& scene) {
  Bounds3 bounds;
  for (const Instance& use : instances(scene))
    for (const Vec3& p : scene.parts[use.part].mesh.positions) bounds.add(transform_point(use.world, p));
  const Vec3 size = bounds.size();
  return {size.x, size.y, size.z};
}

Json materials_json(const Scene& scene) {
  Json materials = Json::array();
  for (const Material& m : scene.materials)
    materials.push_back({{"name", m.name},
                         {"base_color", m.base_color},
                         {"double_sided", m.double_sided},
                         {"textures", textures_json(scene, m)},
                         {"haptic", m.extras_json.find("\"haptic\"") != std::string::npos}});
  return materials;
}

void print_perception(const Console& console, const Json& parts) {
  console.print(fmt::format("\n{:>9} {:>8} {:>7} {:>9}  part\n", "instances", "in reach", "seen", "area seen"));
  for (const Json& part : parts) {
    const auto cell = [&](const char* key) { return part[key].is_null() ? std::string("-") : part[key].dump(); };
    const Json& share = part["visible_fraction"];
    console.print(fmt::format(
        "{:>9} {:>8} {:>7} {:>9}  {}\n", cell("instances"), cell("instances_in_reach"), cell("instances_seen"),
        share.is_null() ? "-" : fmt::format("{:.1f} %", 100 * share.get<double>()), part["part"].get<std::string>()));
  }
}

void print_for_people(const Console& console, const Json& result, const Scene& scene,
                      const std::vector<MeshStatistics>& statistics) {
  const Json& size = result["size_mm"];
  console.print(fmt::format("{}, units {}, {} parts, {:.4g} x {:.4g} x {:.4g} mm\n\n", scene.format, scene.unit,
                            scene.parts.size(), size[0].get<double>(), size[1].get<double>(), size[2].get<double>()));
  console.print(header_row());
  for (std::size_t i = 0; i < statistics.size(); ++i) console.print(counters_row(scene.parts[i].name, statistics[i]));
  if (statistics.size() > 1) console.print(counters_row("all parts", total_statistics(statistics)));
  if (!scene.materials.empty()) console.print(fmt::format("\n{} materials\n", scene.materials.size()));
  for (const Json& material : result["materials"]) {
    std::string line = "  " + material["name"].get<std::string>() + "  base colour";
    for (const double value : material["base_color"]) line += fmt::format(" {:.3g}", value);
    for (const auto& [use, name] : material["textures"].items())
      line += fmt::format("  {}: {}", use, name.get<std::string>());
    console.print(line + "\n");
  }
  if (result.contains("perception")) print_perception(console, result["perception"]);
  print_notes(scene, console);
}

Json inspect(VerbContext& context, const InspectOptions& options) {
  const Scene scene = read_scene(options.file, options.read.read_options(), context.progress);
  const std::vector<MeshStatistics> statistics = part_statistics(scene, context.progress);
  Json result{{"file", options.file}, {"format", scene.format}, {"units", scene.unit}};
  result["millimetres_per_unit"] = scene.millimetres_per_unit;
  result["size_mm"] = size_mm(scene);
  result["parts"] = parts_json(scene, statistics);
  result["totals"] = counters_json(total_statistics(statistics));
  result["materials"] = materials_json(scene);
  result["warnings"] = scene.warnings;
  result["losses"] = scene.losses;
  if (options.perception.asked())
    result["perception"] = perception_json(scene, measure_perception(scene, options.perception, context.progress));
  result["totals"]["drawn_triangles"] = drawn_triangles(scene);
  print_for_people(context.console, result, scene, statistics);
  if (!options.picture.empty()) {
    write_color_image(options.picture, render_scene(scene, {.mode = RenderMode::triangles}));
    result["picture"] = options.picture;
    context.console.print("written " + options.picture + "\n");
  }
  return result;
}

}  // namespace

void add_inspect(CLI::App& program) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* verb = add_verb(program,
                            {"inspect", "Show what a file holds: parts, materials, and what is wrong with the meshes.",
                             "papilla inspect seat.obj --json -"},
                            [options](VerbContext& context) { return inspect(context, *options); });
  verb->add_option("file", options->file, "STL, OBJ, PLY, OFF, GLB or glTF file")->type_name("FILE")->required();
  verb->add_option("--picture", options->picture, "Picture of the scene with its triangles; red: edges of one triangle")
      ->type_name("PNG");
  options->perception.add_to(*verb, false);
  options->read.add_to(*verb);
}

}  // namespace papilla::app
