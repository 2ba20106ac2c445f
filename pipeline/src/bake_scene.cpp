// SPDX-License-Identifier: MIT
#include "papilla/pipeline/bake_scene.hpp"

#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "bake_solid.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/cold_arrays.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/trace.hpp"
#include "papilla/core/units.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/meshing/weld.hpp"
#include "papilla/param/measure.hpp"
#include "papilla/pipeline/hex_colour.hpp"
#include "prepared_bake.hpp"
#include "scene_textures.hpp"

namespace papilla {
namespace {

bool runs(const PartSurface& surface, Stage stage) { return decision(surface.plan, stage).run; }

/// Share of the seams that must turn the grain to be worth a warning.
constexpr double k_chevron_share = 0.1;

/// A sentence for people when the uv that a surface keeps turn its grain at their seams.
std::optional<std::string> chevron_warning(const BakedSurface& surface) {
  const SeamVisibility& seams = surface.seams;
  if (surface.method != "kept" || !(seams.turned_mm > k_chevron_share * seams.seam_mm)) return std::nullopt;
  return fmt::format(
      "part '{}': the grain jumps in direction at the seams of its own uv, on {:.0f} % of them or {:.4g} mm, by {:.0f} "
      "degrees on average over all of them",
      surface.label, 100 * seams.turned_mm / seams.seam_mm, seams.turned_mm, seams.mean_turn_deg);
}

/// Adds pictures and materials to the scene, each once.
class SceneMaterials {
 public:
  SceneMaterials(BakeResult& result, const Materials& rules)
      : result_(result), scene_(result.scene), rules_(rules), textures_(scene_) {
    result_.mm_per_uv.resize(scene_.materials.size());
  }

  /// The material that `surface` shall have, made on first use.
  /// @param both_sides It must be seen from both sides.
  std::uint32_t material_of(const PartSurface& surface, bool both_sides) {
    const Part& part = scene_.parts[surface.part];
    const bool has_original = surface.slot < part.materials.size();
    const std::uint32_t original = has_original ? part.materials[surface.slot] : k_none;
    const MaterialRule& rule = rules_.materials.at(surface.material);
    const bool grain = !rule.texture.empty();
    const bool kept = grain && !runs(surface, Stage::unwrap);
    const double mm_per_unit = kept ? surface.uv_mm_per_unit : 0;
    const bool felt = runs(surface, Stage::tag);
    const auto [it, is_new] = made_.try_emplace({original, surface.material, mm_per_unit, felt, both_sides}, 0);
    if (!is_new) return it->second;
    it->second = make(original, rule, grain, mm_per_unit, felt);
    if (both_sides) scene_.materials[it->second].double_sided = true;
    return it->second;
  }

  /// Gives the materials whose recipes read the surface a picture of it in place of the tile.
  void paint_solids(const RecipeLibrary& library, const ProgressCallback& progress) {
    const std::vector<SolidGrain> made = paint_solid(scene_, solids_, library, progress);
    for (std::size_t i = 0; i < made.size(); ++i) take_solid(solids_[i], kept_mm_of_solid_[i], made[i]);
  }

 private:
  static constexpr std::uint32_t k_none = 0xffffffffu;

  void take_solid(const SolidUse& use, double kept_mm_per_unit, const SolidGrain& solid) {
    Material& material = scene_.materials[use.material];
    const Grain& grain = solid.grain;
    for (const std::string& warning : grain.warnings) scene_.warnings.push_back(warning);
    const bool shows_tile = use.tile->picture && material.base_color_texture &&
                            scene_.textures[material.base_color_texture->texture].name == use.tile->picture->name;
    if (shows_tile) material.base_color_texture.reset(), material.metallic_roughness_texture.reset();
    const std::optional<UvTransform> transform = solid.repeats ? material.normal_texture->transform : std::nullopt;
    if (!solid.repeats)
      for (auto* own : {&material.base_color_texture, &material.metallic_roughness_texture, &material.occlusion_texture,
                        &material.emissive_texture})
        if (*own && (*own)->tex_coord == 0) (*own)->tex_coord = 1;
    attach_pictures(material, grain, transform);
    if (material.haptic) material.haptic = surface_tag(*use.rule, &grain, solid.repeats ? kept_mm_per_unit : 0);
    if (solid.repeats) return;
    result_.mm_per_uv[use.material] = {grain.size_mm[0], grain.size_mm[1]};
    const double mm_per_texel = grain.size_mm[0] / grain.relief.width,
                 wanted = use.tile->size_mm[0] / use.tile->relief.width;
    result_.atlases.push_back({material.name, grain.relief.width, grain.relief.height, solid.charts, mm_per_texel});
    if (mm_per_texel > 1.01 * wanted)
      scene_.warnings.push_back(fmt::format(
          "material '{}': its recipe reads the surface, whose atlas has a texel for every {:.2g} mm, not {:.2g}",
          material.name, mm_per_texel, wanted));
  }

  std::uint32_t make(std::uint32_t original, const MaterialRule& rule, bool grain, double kept_mm_per_unit, bool felt) {
    Material material = original == k_none ? Material{} : scene_.materials[original];
    const std::string original_name = material.name;
    material.name = new_name(original_name, rule);
    if (rule.color) material.base_color = linear_colour(*rule.color);
    if (rule.roughness) material.roughness = *rule.roughness;
    if (rule.metallic) material.metallic = *rule.metallic;

    const Grain* relief = grain ? &result_.grains.at(rule.name) : nullptr;
    if (relief != nullptr && kept_mm_per_unit > 0)
      attach_to_kept_uv(material, rule, *relief, kept_mm_per_unit);
    else if (relief != nullptr)
      attach_to_new_uv(material, *relief);
    material.haptic.reset();
    if (felt) material.haptic = surface_tag(rule, relief, kept_mm_per_unit);
    if (relief != nullptr && relief->solid)
      solids_.push_back({static_cast<std::uint32_t>(scene_.materials.size()), &rule, relief}),
          kept_mm_of_solid_.push_back(kept_mm_per_unit);
    const auto environment = result_.environments.find(rule.name);
    note_origin(material, rule, original_name,
                environment == result_.environments.end() ? std::string() : environment->second);
    scene_.materials.push_back(std::move(material));
    result_.mm_per_uv.resize(scene_.materials.size());
    if (relief != nullptr)
      result_.mm_per_uv.back() = kept_mm_per_unit > 0 ? Vec2{kept_mm_per_unit, kept_mm_per_unit}
                                                      : Vec2{relief->size_mm[0], relief->size_mm[1]};
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
  }

  /// Names from a file stay; colours, which stand for a name in CAD, tell variants of the rule's material apart.
  static std::string new_name(const std::string& original, const MaterialRule& rule) {
    if (original.empty()) return rule.name;
    return original.front() == '#' ? rule.name + " " + original : original;
  }

  /// New uv: one unit is one repeat. The old pictures no longer fit.
  void attach_to_new_uv(Material& material, const Grain& grain) {
    const auto drop = [&](std::optional<TextureReference>& reference, const char* what) {
      if (reference && reference->tex_coord == 0) {
        scene_.losses.push_back("material '" + material.name + "': its " + what +
                                " is left out, because its uv is new");
        reference.reset();
      }
    };
    drop(material.base_color_texture, "base colour picture");
    drop(material.metallic_roughness_texture, "metallic-roughness picture");
    drop(material.occlusion_texture, "occlusion picture");
    drop(material.emissive_texture, "emissive picture");
    drop(material.normal_texture, "normal map");
    attach_pictures(material, grain, std::nullopt);
  }

  /// Kept uv: a texture transform brings them to repeats of the grain.
  void attach_to_kept_uv(Material& material, const MaterialRule& rule, const Grain& grain, double mm_per_unit) {
    if (material.normal_texture)
      scene_.losses.push_back("material '" + material.name + "': its normal map is replaced by that of the grain");
    attach_pictures(material, grain, transform_to_repeats(rule, grain, mm_per_unit));
  }

  void attach_pictures(Material& material, const Grain& grain, std::optional<UvTransform> transform) {
    TextureReference normal;
    normal.texture = textures_.add(grain.normal_png);
    normal.transform = transform;
    material.normal_texture = normal;
    if (!grain.picture || material.base_color_texture) return;
    TextureReference picture;
    picture.texture = textures_.add(*grain.picture);
    picture.transform = transform;
    material.base_color_texture = picture;
    material.base_color = {1, 1, 1, material.base_color[3]};
    if (grain.roughness_factor) attach_shine(material, grain, transform);
  }

  /// What a recipe says of roughness and metallic, in place of the part's own.
  void attach_shine(Material& material, const Grain& grain, const std::optional<UvTransform>& transform) {
    material.roughness = *grain.roughness_factor, material.metallic = *grain.metallic_factor;
    material.metallic_roughness_texture.reset();
    if (!grain.shine) return;
    TextureReference& shine = material.metallic_roughness_texture.emplace();
    shine.texture = textures_.add(*grain.shine);
    shine.transform = transform;
  }

  static void note_origin(Material& material, const MaterialRule& rule, const std::string& original_name,
                          const std::string& environment) {
    using nlohmann::ordered_json;
    ordered_json extras = ordered_json::parse(material.extras_json.empty() ? "{}" : material.extras_json);
    if (!extras.is_object()) throw InvalidInput("material '" + material.name + "': its extras are no JSON object");
    extras["papilla"] = {{"material", rule.name}};
    if (!original_name.empty() && original_name != material.name) extras["papilla"]["original"] = original_name;
    if (!environment.empty()) extras["papilla"]["environment"] = ordered_json::parse(environment);
    material.extras_json = extras.dump();
  }

  BakeResult& result_;
  Scene& scene_;
  const Materials& rules_;
  SceneTextures textures_;
  std::vector<SolidUse> solids_;
  std::vector<double> kept_mm_of_solid_;  ///< Of each.
  std::map<std::tuple<std::uint32_t, std::string, double, bool, bool>, std::uint32_t> made_;
};

/// Leaves out the materials that no triangle uses any more, and renumbers the rest.
void drop_unused_materials(BakeResult& result) {
  Scene& scene = result.scene;
  std::vector<std::uint8_t> used(scene.materials.size(), 0);
  for (const Part& part : scene.parts)
    for (const std::uint32_t material : part.materials) used[material] = 1;
  std::vector<std::uint32_t> number(scene.materials.size());
  std::uint32_t count = 0;
  for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
    number[m] = count;
    if (!used[m]) continue;
    if (m != count) {
      scene.materials[count] = std::move(scene.materials[m]);
      result.mm_per_uv[count] = result.mm_per_uv[m];
    }
    ++count;
  }
  scene.materials.resize(count);
  result.mm_per_uv.resize(count);
  for (Part& part : scene.parts)
    for (std::uint32_t& material : part.materials) material = number[material];
}

/// Tells materials of one name apart, which may happen when only some uses of one were replaced.
void make_names_unique(std::vector<Material>& materials) {
  std::set<std::string> names;
  for (Material& material : materials) {
    const std::string name = material.name;
    for (int i = 2; !name.empty() && !names.insert(material.name).second; ++i)
      material.name = fmt::format("{} {}", name, i);
  }
}

/// Leaves out textures and pictures that nothing shows any more. Extensions name textures by number: where a material
/// has any, all stay.
void drop_unused_textures(Scene& scene) {
  const auto extended = [](const Material& m) { return !m.extensions_json.empty(); };
  if (std::any_of(scene.materials.begin(), scene.materials.end(), extended)) return;
  std::vector<std::optional<std::uint32_t>> new_texture(scene.textures.size()), new_image(scene.images.size());
  std::vector<Texture> textures;
  std::vector<EncodedImage> images;
  const auto moved_image = [&](std::uint32_t number) {
    auto& image = new_image[number];
    if (!image) {
      image = static_cast<std::uint32_t>(images.size());
      images.push_back(std::move(scene.images[number]));
    }
    return *image;
  };
  const auto move_texture = [&](std::optional<TextureReference>& reference) {
    if (!reference) return;
    auto& number = new_texture[reference->texture];
    if (!number) {
      Texture& texture = scene.textures[reference->texture];
      if (texture.image) texture.image = moved_image(*texture.image);
      for (OtherImage& other : texture.others) other.image = moved_image(other.image);
      number = static_cast<std::uint32_t>(textures.size());
      textures.push_back(std::move(texture));
    }
    reference->texture = *number;
  };
  for (Material& material : scene.materials)
    for (auto* reference : {&material.base_color_texture, &material.metallic_roughness_texture,
                            &material.normal_texture, &material.occlusion_texture, &material.emissive_texture})
      move_texture(*reference);
  scene.textures = std::move(textures);
  scene.images = std::move(images);
}

/// Makes the grains that the surfaces use, side by side.
std::map<std::string, Grain> make_grains(const BakePlan& plan, GrainMaker& maker, const ProgressCallback& progress) {
  const std::set<std::string> wanted = grains_of(plan.surfaces);
  const std::vector<std::string> names(wanted.begin(), wanted.end());
  std::vector<Grain> made(names.size());
  std::vector<std::exception_ptr> failures(names.size());
  SharedProgress done(progress, "grains", static_cast<double>(names.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, names.size(), [&](std::size_t i) {
    try {
      made[i] = maker.take(names[i]);
    } catch (const Error&) {
      failures[i] = std::current_exception();
    }
    done.add(1);
  });
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);  // The first in the order of names, whatever was first in time.
  std::map<std::string, Grain> grains;
  for (std::size_t i = 0; i < names.size(); ++i) grains.emplace(names[i], std::move(made[i]));
  return grains;
}

/// A part whose surfaces are baked one by one, and put together again.
struct PartWork {
  std::vector<const PartSurface*> surfaces;  ///< All of the part, in order.
  std::vector<SurfaceWork*> works;
  std::atomic<std::size_t> unfinished = 0;
};

std::map<std::uint32_t, PartWork> parts_of(const std::vector<PartSurface>& surfaces, std::vector<SurfaceWork>& works) {
  std::map<std::uint32_t, PartWork> parts;
  for (SurfaceWork& work : works) {
    PartWork& part = parts[work.surface->part];
    part.works.push_back(&work);
    ++part.unfinished;
  }
  for (const PartSurface& surface : surfaces)
    if (const auto part = parts.find(surface.part); part != parts.end()) part->second.surfaces.push_back(&surface);
  return parts;
}

/// Puts a part together again from its surfaces, if one has new uv.
void reassemble(Part& part, PartWork& parted) {
  const auto is_new = [](const SurfaceWork* work) { return runs(*work->surface, Stage::unwrap); };
  if (std::none_of(parted.works.begin(), parted.works.end(), is_new)) return;
  const ColdArrays waiting;
  TriangleMesh mesh;
  for (const PartSurface* surface : parted.surfaces) {
    const auto work = std::find_if(parted.works.begin(), parted.works.end(),
                                   [&](const SurfaceWork* w) { return w->surface == surface && is_new(w); });
    if (work == parted.works.end())
      append_mesh(mesh, extract_triangles(part.mesh, surface->triangles));
    else
      append_mesh(mesh, std::exchange((*work)->output.mesh, {}));
  }
  part.mesh = std::move(mesh);
}

/// Finds surfaces that get the same new uv, bit for bit.
void find_equal(const Scene& scene, std::vector<SurfaceWork>& works) {
  std::map<std::tuple<const MaterialRule*, std::size_t, double>, std::vector<const SurfaceWork*>> known;
  for (SurfaceWork& work : works) {
    if (!runs(*work.surface, Stage::unwrap)) continue;
    // Equal parts of different names may be meant to differ.
    if (work.rule->unwrap_options && !named_parts(*work.rule->unwrap_options).empty()) continue;
    const TriangleMesh mesh = surface_mesh(scene, *work.surface);
    double sum = 0;
    for (const Vec3& p : mesh.positions) sum += p.x + 2 * p.y + 3 * p.z;
    std::vector<const SurfaceWork*>& candidates = known[{work.rule, mesh.triangles.size(), sum}];
    const auto equal = std::find_if(candidates.begin(), candidates.end(), [&](const SurfaceWork* candidate) {
      const TriangleMesh other = surface_mesh(scene, *candidate->surface);
      return other.positions == mesh.positions && other.triangles == mesh.triangles;
    });
    if (equal == candidates.end())
      candidates.push_back(&work);
    else
      work.equal_to = *equal;
  }
}

/// Patterns of a material's unwrap that fit none of the parts that it gives new uv.
std::vector<std::string> warn_of_unmatched_parts(const std::vector<SurfaceWork>& works) {
  std::map<const MaterialRule*, std::vector<std::string>> labels;
  for (const SurfaceWork& work : works)
    if (runs(*work.surface, Stage::unwrap)) labels[work.rule].push_back(work.surface->label);
  std::set<std::string> warnings;  // in the order of names, not of addresses
  for (const auto& [rule, parts] : labels) {
    if (!rule->unwrap_options) continue;
    for (const std::string& pattern : named_parts(*rule->unwrap_options))
      if (std::none_of(parts.begin(), parts.end(), [&](const auto& part) { return is_for_part(pattern, part); }))
        warnings.insert(fmt::format("material '{}': its unwrap names part '{}', but it gives no such part new uv",
                                    rule->name, pattern));
  }
  return {warnings.begin(), warnings.end()};
}

void name_report(const PartSurface& surface, BakedSurface& report) {
  report.part = surface.part, report.slot = surface.slot;
  report.label = surface.label;
  report.material = surface.material;
}

void take_over(const SurfaceWork& source, SurfaceWork& work) {
  const PartSurface& surface = *work.surface;
  work.output.mesh = source.output.mesh;
  work.output.report = source.output.report;
  name_report(surface, work.output.report);
  work.output.report.same_as = source.surface->label;
}

void drop_maps(BakedSurface& report) {
  report.mesh = TriangleMesh();
  report.distortion.per_triangle = std::vector<TriangleDistortion>();
}

/// bake_surface() of all that have no equal. When written anew, a part whose surfaces are done takes them at once.
void bake_surfaces(PreparedBake& prepared, const BakeOptions& options, const ProgressCallback& progress) {
  std::vector<SurfaceWork>& works = prepared.works;
  std::map<std::uint32_t, PartWork> parts = parts_of(prepared.result.plan.surfaces, works);
  double triangles = 0;
  for (const SurfaceWork& work : works) triangles += static_cast<double>(work.surface->triangles.size());
  SharedProgress done(progress, "surfaces", triangles);
  oneapi::tbb::parallel_for(std::size_t{0}, works.size(), [&](std::size_t i) {
    SurfaceWork& work = works[i];
    WorkProgress worked(done, static_cast<double>(work.surface->triangles.size()));
    if (work.equal_to == nullptr) {
      SurfaceInput input = prepared.input_of(work);
      input.options.method.progress = worked.callback();
      work.output = bake_surface(std::move(input));
      if (!options.surface_maps) drop_maps(work.output.report);
    }
    name_report(*work.surface, work.output.report);
    PartWork& part = parts.at(work.surface->part);
    if (--part.unfinished == 0 && !options.plan.in_place)
      reassemble(prepared.result.scene.parts[work.surface->part], part);
    worked.reach(1);
  });
}

/// Leaves surfaces as they came.
void leave_without_grain(const std::set<PartSlot>& surfaces, BakeResult& result) {
  if (surfaces.empty()) return;
  for (PartSurface& surface : result.plan.surfaces) {
    if (!surfaces.contains({surface.part, surface.slot})) continue;
    surface.material.clear();
    surface.plan.fill({false, "it was to be left without grain"});
    result.scene.warnings.push_back("part '" + surface.label + "': left as it came, without grain");
  }
}

/// Adds up what the surfaces took.
void finish(std::vector<SurfaceWork>& works, BakeResult& result) {
  for (SurfaceWork& work : works) {
    result.seconds["repair"] += work.output.repair_seconds;
    result.seconds["charts"] += work.output.charts_seconds;
    result.seconds["unwrap"] += work.output.unwrap_seconds;
    result.seconds["measure"] += work.output.measure_seconds;
    if (const auto warning = chevron_warning(work.output.report)) result.scene.warnings.push_back(*warning);
    result.surfaces.push_back(std::move(work.output.report));
  }
}

/// Decals and carriers, with the constants of the rules for what they lie on or stand for.
void add_object_textures(BakeResult& result, const Materials& rules) {
  const Stopwatch clock;
  std::map<std::pair<std::uint32_t, std::uint32_t>, const PartSurface*> surfaces;
  for (const PartSurface& surface : result.plan.surfaces) surfaces[{surface.part, surface.slot}] = &surface;
  ObjectTextureOptions options;
  options.constants = [&](std::uint32_t part, std::uint32_t slot) -> std::optional<MaterialTag> {
    const auto found = surfaces.find({part, slot});
    if (found == surfaces.end() || !runs(*found->second, Stage::tag)) return std::nullopt;
    return surface_tag(rules.materials.at(found->second->material), nullptr, 0);
  };
  result.object_textures = apply_object_textures(result.scene, rules, result.plan.object_textures, options);
  result.mm_per_uv.insert(result.mm_per_uv.end(), result.object_textures.mm_per_uv.begin(),
                          result.object_textures.mm_per_uv.end());
  if (has_object_textures(rules)) result.seconds["object_textures"] = clock.seconds();
}

double triangles_of_parts(const Scene& scene) {
  double triangles = 0;
  for (const Part& part : scene.parts) triangles += static_cast<double>(part.mesh.triangles.size());
  return triangles;
}

}  // namespace

StopReason ending_of(const BakeResult& result) {
  StopReason ending = result.plan.budget ? result.plan.budget->stop : StopReason::direct;
  for (const BakedSurface& surface : result.surfaces) {
    ending = worse(ending, surface.stop);
    if (surface.repaired && surface.repaired->unfinished_triangles > 0) ending = StopReason::time_limit;
  }
  return ending;
}

RepairResult repair_of(const std::vector<BakedSurface>& surfaces) {
  std::vector<RepairResult> repaired;
  for (const BakedSurface& surface : surfaces)
    if (surface.repaired) repaired.push_back(*surface.repaired);
  return total_repair(repaired);
}

SurfaceInput PreparedBake::input_of(const SurfaceWork& work) const {
  return surface_input(*work.surface, *work.rule, surface_mesh(result.scene, *work.surface),
                       result.grains.at(work.surface->material), context, unwrap);
}

PreparedBake prepare_bake(Scene scene, const Materials& rules, const BakeOptions& options, GrainMaker& maker,
                          const ProgressCallback& progress, const WholeScene* whole) {
  PreparedBake prepared;
  BakeResult& result = prepared.result;
  const double to_finish = k_seconds_to_finish * triangles_of_parts(scene);
  const StageCache* cache = options.unwrap.method.cache;
  BakePlanOptions plan = options.plan;
  plan.sides.deadline = options.plan.sides.deadline.earlier_by(to_finish);
  plan.sides.cache = cache;
  result.plan = plan_bake(std::move(scene), rules, plan, progress);
  result.scene = std::move(result.plan.scene);
  leave_without_grain(options.without_grain, result);
  const std::vector<PartSurface>& surfaces = result.plan.surfaces;
  result.seconds = {{"sides", result.plan.sides.seconds},
                    {"leave_out", result.plan.perception_seconds},
                    {"simplify", result.plan.simplify_seconds}};
  prepared.context = whole ? whole->context : unwrap_context(result.scene, {});
  if (whole && whole->keeps_triangles)
    for (PartSurface& surface : result.plan.surfaces)
      surface.plan[static_cast<std::size_t>(Stage::repair)] = {false, "the file is edited in place"};
  leave_out(result.scene, result.plan.perception);
  maker.finish_by(options.unwrap.method.deadline.earlier_by(to_finish));
  result.grains = make_grains(result.plan, maker, progress);
  for (const auto& [name, grain] : result.grains) {
    for (const std::string& warning : grain.warnings) result.scene.warnings.push_back(warning);
    result.seconds["analyze"] += grain.analyze_seconds;
    result.seconds["height"] += grain.height_seconds;
    result.seconds["normal_map"] += grain.normal_map_seconds;
  }
  double triangles = 0;
  for (const PartSurface& surface : surfaces)
    if (runs(surface, Stage::measure)) triangles += static_cast<double>(surface.triangles.size());
  prepared.unwrap = options.unwrap;
  prepared.unwrap.method.deadline = options.unwrap.method.deadline.earlier_by(k_seconds_to_finish * triangles);
  for (const PartSurface& surface : surfaces) {
    if (!runs(surface, Stage::measure)) continue;
    SurfaceWork& work = prepared.works.emplace_back();
    work.surface = &surface;
    work.rule = &rules.materials.at(surface.material);
  }
  for (std::string& warning : warn_of_unmatched_parts(prepared.works))
    result.scene.warnings.push_back(std::move(warning));
  if (options.plan.in_place && !options.plan.keep_copies) find_equal(result.scene, prepared.works);
  return prepared;
}

BakeResult bake_scene(Scene scene, const Materials& rules, const BakeOptions& options,
                      const ProgressCallback& progress) {
  GrainMaker maker(rules, options.library, options.unwrap.method.deadline, options.unwrap.method.cache);
  return bake_scene(std::move(scene), rules, options, maker, progress);
}

BakeResult bake_scene(Scene scene, const Materials& rules, const BakeOptions& options, GrainMaker& maker,
                      const ProgressCallback& progress, const WholeScene* whole) {
  PreparedBake prepared = prepare_bake(std::move(scene), rules, options, maker, progress, whole);
  BakeResult& result = prepared.result;
  std::vector<SurfaceWork>& works = prepared.works;
  const std::vector<PartSurface>& surfaces = result.plan.surfaces;
  for (const PartSurface& surface : surfaces) {
    if (surface.material.empty() || surface.is_left_out || result.environments.contains(surface.material)) continue;
    const std::filesystem::path& picture = rules.materials.at(surface.material).environment;
    if (!picture.empty())
      result.environments[surface.material] = environment_json(read_environment(picture, k_material_environment_width));
  }
  bake_surfaces(prepared, options, progress);

  if (options.plan.in_place) {
    for (SurfaceWork& work : works)
      if (work.equal_to != nullptr) take_over(*work.equal_to, work);
    for (SurfaceWork& work : works)
      if (runs(*work.surface, Stage::unwrap)) work.output.report.uv = std::move(work.output.mesh.uv);
    finish(works, result);
    return std::move(result);
  }
  SceneMaterials materials(result, rules);
  std::set<const PartSurface*> without_back;
  for (const SurfaceWork& work : works)
    if (const auto& repaired = work.output.report.repaired; repaired && !repaired->two_sided.empty())
      without_back.insert(work.surface);
  std::vector<std::pair<const PartSurface*, std::uint32_t>> chosen;
  for (const PartSurface& surface : surfaces)
    if (!surface.material.empty() && !surface.is_left_out)
      chosen.emplace_back(&surface, materials.material_of(surface, without_back.contains(&surface)));
  for (const auto& [surface, material] : chosen) {
    Part& part = result.scene.parts[surface->part];
    if (part.materials.size() <= surface->slot) part.materials.resize(surface->slot + 1, material);
    part.materials[surface->slot] = material;
  }
  materials.paint_solids(options.library, progress);
  add_object_textures(result, rules);
  drop_unused_materials(result);
  make_names_unique(result.scene.materials);
  drop_unused_textures(result.scene);
  finish(works, result);
  return std::move(result);
}

}  // namespace papilla
