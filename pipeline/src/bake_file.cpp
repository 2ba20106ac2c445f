// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_file.hpp"

#include <algorithm>

#include "grain_source.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/progress_until.hpp"
#include "papilla/core/read_file.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/gltf_reader.hpp"
#include "papilla/pipeline/assignment.hpp"
#include "papilla/pipeline/hex_colour.hpp"
#include "prepared_bake.hpp"
#include "remembered_plan.hpp"

namespace papilla {
namespace {

/// What the scene can't hold stays in the file.
Scene read_for_edit(const std::filesystem::path& input, const ReadOptions& options, const ProgressCallback& progress,
                    GltfOrigin& origin) {
  require_file(input);
  report_progress(progress, "read", 0);
  Scene scene = read_gltf(input, {.tags = options.tags, .coarser_parts = true}, &origin);
  scene.losses.clear();
  report_progress(progress, "read", 1);
  return scene;
}

const BakedSurface* baked_surface(const BakeResult& result, const PartSurface& surface) {
  const auto found = std::find_if(result.surfaces.begin(), result.surfaces.end(), [&](const BakedSurface& s) {
    return s.part == surface.part && s.slot == surface.slot;
  });
  return found == result.surfaces.end() ? nullptr : &*found;
}

GltfSurfaceEdit turned_only(const PartSurface& surface) {
  GltfSurfaceEdit edit;
  edit.part = surface.part, edit.slot = surface.slot;
  edit.turned = surface.turned;
  edit.keeps_material = true;
  return edit;
}

/// What was split comes from one mesh.
void split_origin(const std::vector<SplitPart>& split, GltfOrigin& origin) {
  for (const SplitPart& part : split) origin.parts.push_back(GltfOrigin::Part(origin.parts[part.original]));
}

/// Turns the triangles of the origin that the plan turned in the scene.
void turn_origin(const std::vector<PartSurface>& surfaces, GltfOrigin& origin) {
  for (const PartSurface& surface : surfaces) {
    if (surface.turned.empty()) continue;
    std::size_t next = 0;  // Triangles of a surface are in the order of its primitives.
    for (GltfOrigin::Primitive& primitive : origin.parts[surface.part].primitives) {
      if (primitive.slot != surface.slot) continue;
      for (Triangle& corners : primitive.vertices)
        if (surface.turned[next++] != 0) std::swap(corners[1], corners[2]);
    }
  }
}

/// What shall be written of each surface that a rule is assigned to, or that is turned.
std::vector<GltfSurfaceEdit> surface_edits(const BakeResult& result, const Materials& rules) {
  std::vector<GltfSurfaceEdit> edits;
  for (const PartSurface& surface : result.plan.surfaces) {
    if (surface.material.empty()) {
      if (!surface.turned.empty()) edits.push_back(turned_only(surface));
      continue;
    }
    const MaterialRule& rule = rules.materials.at(surface.material);
    const BakedSurface* baked = baked_surface(result, surface);
    const Grain* grain = baked != nullptr ? &result.grains.at(rule.name) : nullptr;
    const double kept_mm_per_unit = baked != nullptr && baked->uv.empty() ? surface.uv_mm_per_unit : 0;
    GltfSurfaceEdit edit;
    edit.part = surface.part, edit.slot = surface.slot;
    edit.turned = surface.turned;
    edit.double_sided = surface.becomes_double_sided;
    edit.rule = rule.name;
    if (decision(surface.plan, Stage::tag).run) edit.tag = surface_tag(rule, grain, kept_mm_per_unit);
    if (rule.color) edit.base_color = linear_colour(*rule.color);
    edit.roughness = rule.roughness, edit.metallic = rule.metallic;
    if (const auto found = result.environments.find(rule.name); found != result.environments.end())
      edit.environment_json = found->second;
    if (grain != nullptr) {
      edit.normal_map = &grain->normal_png;
      if (grain->picture) edit.picture = &*grain->picture;
      if (grain->shine) edit.shine = &*grain->shine;
      edit.picture_roughness = grain->roughness_factor, edit.picture_metallic = grain->metallic_factor;
      if (kept_mm_per_unit > 0) edit.transform = transform_to_repeats(rule, *grain, kept_mm_per_unit);
      edit.uv = baked->uv;
    }
    edits.push_back(std::move(edit));
  }
  return edits;
}

/// The file as it is written, with the scale of each material's grain.
void read_again(const std::filesystem::path& output, BakeResult& result) {
  std::vector<std::string> warnings = std::move(result.scene.warnings);
  result.scene = read_gltf(output, {.tag_channel = true});
  result.scene.losses.clear();
  result.scene.warnings = std::move(warnings);
  result.mm_per_uv.clear();
  for (const Material& material : result.scene.materials)
    result.mm_per_uv.push_back(
        material.haptic && material.haptic->height ? k_mm_per_metre * material.haptic->height->metres_per_uv : Vec2{});
}

/// Why a scene that was read for an edit can't be edited.
constexpr const char* k_instances_apart =
    "the instances that one node lists (EXT_mesh_gpu_instancing) get different materials";

constexpr const char* k_reads_surface = "a recipe reads the surface, which gets an atlas of its own";

/// Whether a rule has such a recipe. Mistakes in recipes are found where they are used.
bool has_solid_recipe(const Materials& rules, const RecipeLibrary& library) {
  return std::any_of(rules.materials.begin(), rules.materials.end(), [&](const auto& entry) {
    try {
      const auto recipe = recipe_of(entry.second, library, true);
      return recipe && reads_surface(*recipe);
    } catch (const Error&) {
      return false;
    }
  });
}

/// @return false when the scene has to be written anew.
bool edit_file(const std::filesystem::path& input, const std::filesystem::path& output, const Materials& rules,
               const BakeFileOptions& options, const ProgressCallback& progress, BakeFileResult& result) {
  const Stopwatch total;
  GltfOrigin origin;
  Scene scene = read_for_edit(input, options.read, progress_until(progress, options.read_deadline), origin);
  if (assigns_groups_apart(scene, rules, origin.nodes)) return false;
  const double read_seconds = total.seconds();
  BakeOptions bake = options.bake;
  bake.plan.in_place = true;
  bake.plan.levels = origin.levels;
  static_cast<BakeResult&>(result) = bake_scene(std::move(scene), rules, bake, progress);
  result.seconds["read"] = read_seconds;
  split_origin(result.plan.split, origin);
  origin.levels = result.plan.levels;
  turn_origin(result.plan.surfaces, origin);
  const Stopwatch write_clock;
  GltfEditResult edited =
      write_edited_gltf(input, std::move(result.scene), origin, surface_edits(result, rules), output);
  result.seconds["write"] = write_clock.seconds();
  result.scene = std::move(edited.scene);
  result.changes = std::move(edited.changes);
  result.sizes.tag_pictures = edited.tag_pictures;
  for (std::string& note : edited.notes) result.scene.warnings.push_back(std::move(note));
  if (options.for_pictures) read_again(output, result);
  result.seconds["total"] = total.seconds();
  return true;
}

/// The scene as bake_file() has it before it plans, and how it will be written.
Scene read_for_bake(const std::filesystem::path& input, const Materials& rules, const BakeFileOptions& options,
                    BakeWay& way, BakePlanOptions& plan, const ProgressCallback& progress) {
  Scene scene;
  GltfOrigin origin;
  way = bake_way(input, options, rules);
  if (way.in_place) {
    scene = read_for_edit(input, options.read, progress, origin);
    if (assigns_groups_apart(scene, rules, origin.nodes)) way = {false, k_instances_apart};
  }
  if (!way.in_place) scene = read_scene(input, options.read, progress);
  plan.in_place = way.in_place;
  if (plan.in_place) plan.levels = std::move(origin.levels);
  return scene;
}

/// What the cache of the bake has for a plan.
RememberedPlan remembered_plan(const BakePlan& plan, const Materials& rules, const BakeOptions& options) {
  RememberedPlan remembered;
  const StageCache* cache = options.unwrap.method.cache;
  if (cache == nullptr) return remembered;
  std::map<std::string, Grain> grains;
  for (const std::string& name : grains_of(plan.surfaces)) try {
      if (auto grain = find_grain(rules.materials.at(name), options.library, *cache)) {
        remembered.grains.insert(name);
        grains.emplace(name, std::move(*grain));
      }
    } catch (const Error&) {  // The plan of the grain says what is wrong.
    }
  const PartContext context = unwrap_context(plan.scene, {});
  remembered.surfaces.assign(plan.surfaces.size(), 0);
  for (std::size_t i = 0; i < plan.surfaces.size(); ++i) {
    const PartSurface& surface = plan.surfaces[i];
    const auto grain = grains.find(surface.material);
    if (grain == grains.end() || !decision(surface.plan, Stage::unwrap).run) continue;
    const SurfaceInput input = surface_input(surface, rules.materials.at(surface.material),
                                             surface_mesh(plan.scene, surface), grain->second, context, options.unwrap);
    remembered.surfaces[i] = cache->store().contains("uv", uv_key(input.mesh, input.context, input.options));
  }
  return remembered;
}

}  // namespace

BakeWay bake_way(const std::filesystem::path& input, const BakeFileOptions& options, const Materials& rules) {
  if (!is_gltf_file(input)) return {false, "the input is no glTF file"};
  if (options.read.up && *options.read.up != UpAxis::y) return {false, "the scene is to be turned"};
  if (has_object_textures(rules)) return {false, "pictures are projected onto surfaces or stand for them"};
  if (options.bake.plan.budget) return {false, "triangles are to be reduced"};
  const PerceptionOptions& perception = options.bake.plan.perception;
  if (perception.leave_out_unreachable || perception.leave_out_unseen) return {false, "parts are to be left out"};
  if (options.write.mirror_mpeg_haptics || options.write.mirror_khr_physics)
    return {false, "tags are to be mirrored in extensions"};
  if (options.write.meshes != MeshCoding::none) return {false, "meshes are to be compressed"};
  if (options.write.pictures != PictureCoding::as_is) return {false, "pictures are to be stored in another format"};
  if (has_solid_recipe(rules, options.bake.library)) return {false, k_reads_surface};
  return {true, "only tags and what the grain needs are added"};
}

PreparedBake prepare_file(const std::filesystem::path& input, const Materials& rules, const BakeFileOptions& options,
                          BakeWay& way, const ProgressCallback& progress) {
  BakeOptions bake = options.bake;
  GrainMaker maker(rules, bake.library, bake.unwrap.method.deadline, bake.unwrap.method.cache);
  if (!bake_way(input, options, rules).in_place) maker.begin_ahead();
  Scene scene = read_for_bake(input, rules, options, way, bake.plan, progress);
  return prepare_bake(std::move(scene), rules, bake, maker, progress);
}

PlannedFile plan_file(const std::filesystem::path& input, const Materials& rules, const BakeFileOptions& options,
                      const ProgressCallback& progress) {
  PlannedFile result;
  BakePlanOptions plan = options.bake.plan;
  Scene scene = read_for_bake(input, rules, options, result.way, plan, progress);
  static_cast<BakePlan&>(result) = plan_bake(std::move(scene), rules, plan, progress);
  for (const std::string& name : grains_of(result.surfaces))
    result.grains.push_back(plan_grain(rules.materials.at(name), options.bake.library));
  result.remembered = remembered_plan(result, rules, options.bake);
  if (has_object_textures(rules)) {
    Scene made = result.scene;
    result.object_textures_made =
        apply_object_textures(made, rules, result.object_textures, {.pictures = false, .constants = {}});
    result.scene.warnings = std::move(made.warnings);
  }
  return result;
}

BakeFileResult bake_file(const std::filesystem::path& input, const std::filesystem::path& output,
                         const Materials& rules, const BakeFileOptions& options, const ProgressCallback& progress) {
  BakeFileResult result;
  result.way = bake_way(input, options, rules);
  if (result.way.in_place) {
    if (edit_file(input, output, rules, options, progress, result)) return result;
    result.way = {false, k_instances_apart};
  }
  const Stopwatch total;
  const MethodOptions& method = options.bake.unwrap.method;
  GrainMaker maker(rules, options.bake.library, method.deadline, method.cache);
  maker.begin_ahead();
  Scene scene = read_scene(input, options.read, progress_until(progress, options.read_deadline));
  const double read_seconds = total.seconds();
  static_cast<BakeResult&>(result) = bake_scene(std::move(scene), rules, options.bake, maker, progress);
  result.seconds["read"] = read_seconds;
  const Stopwatch write_clock;
  for (std::string& loss : write_scene(result.scene, output, options.write, &result.sizes))
    result.scene.losses.push_back(std::move(loss));
  result.seconds["write"] = write_clock.seconds();
  result.seconds["total"] = total.seconds();
  return result;
}

}  // namespace papilla
