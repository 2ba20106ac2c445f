// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "object_textures/box_clip.hpp"
#include "object_textures/carrier_frame.hpp"
#include "object_textures/part_picture.hpp"
#include "object_textures/piece.hpp"
#include "object_textures/shown_picture.hpp"
#include "papilla/core/bounds.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/io/image_file.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/mesh_assembly.hpp"
#include "papilla/pipeline/grain.hpp"
#include "papilla/pipeline/object_textures.hpp"
#include "papilla/pipeline/part_statistics.hpp"
#include "papilla/texture/normal_map.hpp"
#include "scene_textures.hpp"

namespace papilla {
namespace {

/// Surfaces of one node: its slots that a rule means.
struct SelectedUse {
  std::uint32_t node = 0, part = 0;
  Transform world = k_identity;
  std::vector<std::uint32_t> slots;  ///< Ascending.
};

/// The node that shows now what `node` showed: itself, or the child that sharing identical parts gave it.
std::uint32_t shown_at(const Scene& scene, std::uint32_t node, std::size_t nodes_before) {
  if (scene.nodes[node].part) return node;
  for (const std::uint32_t child : scene.nodes[node].children)
    if (child >= nodes_before && scene.nodes[child].part) return child;
  return node;
}

std::vector<SelectedUse> selected_uses(const Scene& scene, const std::vector<PlacedSurface>& places,
                                       std::size_t nodes_before) {
  std::map<std::uint32_t, std::set<std::uint32_t>> slots;
  for (const PlacedSurface& place : places) slots[shown_at(scene, place.node, nodes_before)].insert(place.slot);
  std::vector<SelectedUse> uses;
  for (const Instance& use : instances(scene))
    if (const auto found = slots.find(use.node); found != slots.end())
      uses.push_back({use.node, use.part, use.world, {found->second.begin(), found->second.end()}});
  return uses;
}

std::vector<Index> triangles_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& slots) {
  std::vector<Index> triangles;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    if (std::binary_search(slots.begin(), slots.end(), mesh.material.empty() ? 0 : mesh.material[t]))
      triangles.push_back(t);
  return triangles;
}

/// The slot with the largest area.
std::uint32_t largest_slot(const TriangleMesh& mesh, const std::vector<Index>& triangles) {
  std::map<std::uint32_t, double> area;
  for (const Index t : triangles)
    area[mesh.material.empty() ? 0 : mesh.material[t]] +=
        norm(cross(mesh.corner(t, 1) - mesh.corner(t, 0), mesh.corner(t, 2) - mesh.corner(t, 0)));
  return std::max_element(area.begin(), area.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// A point of the scene in the coordinates of a use.
Vec3 point_before(const Transform& t, Vec3 p) {
  const Vec3 x{t[0], t[4], t[8]}, y{t[1], t[5], t[9]}, z{t[2], t[6], t[10]}, d = p - Vec3{t[3], t[7], t[11]};
  const double det = dot(x, cross(y, z));
  return (1 / det) * Vec3{dot(d, cross(y, z)), dot(d, cross(z, x)), dot(d, cross(x, y))};
}

Vec3 direction_before(const Transform& t, Vec3 d) { return point_before(t, d) - point_before(t, {}); }

/// What a decal or carrier looks and feels like where it lies on one material.
struct PictureLook {
  std::string name, kind;  ///< Of the rule; "decal" or "carrier".
  const EncodedImage* picture = nullptr;
  const EncodedImage* normal_map = nullptr;
  std::string alpha_mode;
  std::optional<double> roughness, metallic;
};

/// Adds materials, pictures and nodes to a scene, each once.
class SceneAdditions {
 public:
  SceneAdditions(Scene& scene, ObjectTextures& result)
      : scene_(scene), result_(result), textures_(scene, SceneTextures::k_clamp_to_edge) {}

  /// @param below  Material of what is below, or replaced, if it has any.
  std::uint32_t add_material(const PictureLook& look, std::optional<std::uint32_t> below,
                             std::optional<MaterialTag> tag, Vec2 size_mm) {
    Material material;
    material.name = look.name;
    if (below) {
      material.roughness = scene_.materials[*below].roughness;
      material.metallic = scene_.materials[*below].metallic;
    }
    if (look.roughness) material.roughness = *look.roughness;
    if (look.metallic) material.metallic = *look.metallic;
    material.alpha_mode = look.alpha_mode;
    if (look.picture) material.base_color_texture = reference_to(*look.picture);
    if (look.normal_map) material.normal_texture = reference_to(*look.normal_map);
    material.haptic = std::move(tag);
    material.extras_json = nlohmann::ordered_json{{"papilla", {{look.kind, look.name}}}}.dump();
    scene_.materials.push_back(std::move(material));
    result_.mm_per_uv.push_back(size_mm);
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
  }

  std::uint32_t add_part(Part part) {
    scene_.parts.push_back(std::move(part));
    return static_cast<std::uint32_t>(scene_.parts.size() - 1);
  }

  /// @param parent  nothing: a root.
  void add_node(const std::string& name, std::uint32_t part, std::optional<std::uint32_t> parent) {
    const auto number = static_cast<std::uint32_t>(scene_.nodes.size());
    Node node;
    node.name = name;
    node.part = part;
    scene_.nodes.push_back(std::move(node));
    (parent ? scene_.nodes[*parent].children : scene_.roots).push_back(number);
  }

 private:
  TextureReference reference_to(const EncodedImage& image) {
    TextureReference reference;
    reference.texture = textures_.add(image);
    return reference;
  }

  Scene& scene_;
  ObjectTextures& result_;
  SceneTextures textures_;
};

EncodedImage png_image(const std::string& name, std::vector<std::byte> bytes) {
  EncodedImage image;
  image.name = name;
  image.mime_type = "image/png";
  image.bytes = std::move(bytes);
  return image;
}

std::vector<std::byte> png_of(const RgbaImage& image) {
  if (has_alpha(image)) return encode_png(image);
  ColorImage color{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (i % 4 != 3) color.pixels.push_back(image.pixels[i]);
  return encode_png(color);
}

/// The tag of a picture with relief: constants of the surface, heights of the picture.
MaterialTag tag_with(MaterialTag constants, const FeltRelief& felt) {
  constants.height = felt.tag;
  constants.maps.reset();
  constants.roughness.reset();
  return constants;
}

double max_slope_of(const std::optional<double>& wanted, const MaterialTag& constants) {
  return wanted.value_or(default_max_slope(largest_static_friction(constants)));
}

class Application {
 public:
  Application(Scene& scene, const Bounds3& whole, const Materials& rules, const ObjectTexturePlaces& places,
              const ObjectTextureOptions& options)
      : scene_(scene),
        rules_(rules),
        places_(places),
        options_(options),
        pyramids_(scene),
        additions_(scene, result_),
        bounds_(whole) {}

  ObjectTextures run() {
    for (std::size_t i = 0; i < rules_.replace.size() && !options_.decal; ++i)
      named(rules_.replace[i].name, "replace", i, [&] { replace(rules_.replace[i], places_.carriers[i]); });
    for (std::size_t i = 0; i < rules_.decals.size(); ++i)
      if (options_.decal.value_or(i) == i)
        named(rules_.decals[i].name, "decals", i, [&] { add_decal(rules_.decals[i], places_.decals[i]); });
    return std::move(result_);
  }

 private:
  template <class Work>
  void named(const std::string& name, const char* list, std::size_t number, const Work& work) const {
    const std::string where = fmt::format("{}: /{}/{} '{}': ", rules_.source, list, number, name);
    try {
      work();
    } catch (const InvalidInput& error) {
      throw InvalidInput(where + error.what());
    } catch (const IoError& error) {
      throw IoError(where + error.what());
    }
  }

  std::optional<MaterialTag> constants_of(std::uint32_t part, std::uint32_t slot) const {
    return options_.constants ? options_.constants(part, slot) : MaterialTag{};
  }

  std::optional<std::uint32_t> material_of(const Part& part, std::uint32_t slot) const {
    if (slot >= part.materials.size() || part.materials[slot] >= scene_.materials.size()) return std::nullopt;
    return part.materials[slot];
  }

  // Decals.

  void add_decal(const DecalRule& rule, const std::vector<PlacedSurface>& places) {
    DecalReport report;
    report.name = rule.name;
    report.offset_mm = rule.offset_mm.value_or(
        std::max(k_least_offset_mm, k_offset_share * options_.diagonal_mm.value_or(bounds_.diagonal())));
    std::shared_ptr<const DecalPicture> picture;
    EncodedImage shown;
    HeightMap relief;
    if (options_.pictures) {
      picture = options_.decal_picture ? options_.decal_picture(rule.picture)
                                       : std::make_shared<const DecalPicture>(read_decal_picture(rule.picture));
      shown = png_image(fmt::format("decal.{}.{}", rule.name, result_.decals.size() + 1), picture->png);
      if (rule.height)
        relief = relief_of_shown_picture(*rule.height, picture->pixels, rule.box.width_mm, rule.box.height_mm);
    }
    const BoxFrame frame(rule.box);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;  // By part and slot.
    for (const SelectedUse& use : selected_uses(scene_, places, places_.nodes)) {
      if (determinant(use.world) == 0) continue;
      DecalPatch patch =
          cut_decal(scene_.parts[use.part].mesh, use.slots, use.world, frame, rule.max_angle_deg, report.offset_mm);
      report.turned_off += patch.turned_off;
      if (patch.mesh.triangles.empty()) continue;
      report.triangles += patch.mesh.triangles.size();
      report.area_mm2 += patch.area_mm2;
      report.surfaces += std::set(patch.mesh.material.begin(), patch.mesh.material.end()).size();
      Part part;
      part.name = rule.name;
      part.id = scene_.parts[use.part].id + "/" + rule.name;
      std::map<std::uint32_t, std::uint32_t> slot_of;
      for (std::uint32_t& slot : patch.mesh.material) {
        const auto [it, is_new] = slot_of.try_emplace(slot, static_cast<std::uint32_t>(part.materials.size()));
        if (is_new) {
          const auto [known, is_new_material] = made.try_emplace({use.part, slot}, 0);
          if (is_new_material)
            known->second = decal_material(rule, use.part, slot, picture.get(), shown, relief, report);
          part.materials.push_back(known->second);
        }
        slot = it->second;
      }
      part.mesh = std::move(patch.mesh);
      additions_.add_node(rule.name, additions_.add_part(std::move(part)), use.node);
    }
    if (report.triangles == 0 && !places.empty())
      scene_.warnings.push_back(fmt::format("decal '{}': {}", rule.name,
                                            report.turned_off > 0
                                                ? "all that lies in its box is turned away from it"
                                                : "nothing of the surfaces that it is for lies in its box"));
    result_.decals.push_back(std::move(report));
  }

  std::uint32_t decal_material(const DecalRule& rule, std::uint32_t part, std::uint32_t slot,
                               const DecalPicture* picture, const EncodedImage& shown, const HeightMap& relief,
                               DecalReport& report) {
    const Vec2 size{rule.box.width_mm, rule.box.height_mm};
    PictureLook look{rule.name, "decal", nullptr, nullptr, "OPAQUE", rule.roughness, rule.metallic};
    if (picture == nullptr) return additions_.add_material(look, std::nullopt, std::nullopt, size);
    look.picture = &shown;
    look.alpha_mode = alpha_mode_of(picture->pixels);
    std::optional<MaterialTag> tag;
    EncodedImage normals;
    if (rule.height) {
      // Relief is to be felt, also where nothing is said of the surface below.
      const MaterialTag constants = constants_of(original_of(part), slot).value_or(MaterialTag{});
      const double max_slope = max_slope_of(rule.height->max_slope, constants);
      // Its lowest place is level with the surface below, of which it is pushed out.
      const FeltRelief felt = felt_relief(relief, max_slope, -std::min(report.offset_mm, rule.height->depth_mm));
      report.relief_mm = felt.tag.scale_m / k_metres_per_mm;
      normals = png_image(fmt::format("{}.normal {:g}", shown.name, max_slope), encode_png(normal_map(felt.relief)));
      look.normal_map = &normals;
      tag = tag_with(constants, felt);
    }
    return additions_.add_material(look, material_of(scene_.parts[part], slot), std::move(tag), size);
  }

  // Carriers.

  void replace(const CarrierRule& rule, const std::vector<PlacedSurface>& places) {
    CarrierReport report;
    report.name = rule.name;
    const std::vector<SelectedUse> uses = selected_uses(scene_, places, places_.nodes);
    if (rule.box)
      replace_region(rule, uses, report);
    else
      replace_parts(rule, uses, report);
    if (report.triangles == 0 && !places.empty())
      scene_.warnings.push_back(
          fmt::format("carrier '{}': no triangle of the surfaces that it is for lies in its box", rule.name));
    result_.carriers.push_back(std::move(report));
  }

  /// A part without some of its triangles, where nodes show it; the same for all with the same triangles.
  void remove_triangles(std::uint32_t node, const std::vector<Index>& gone) {
    const std::uint32_t number = scene_.nodes[node].part.value();
    const std::size_t all = scene_.parts[number].mesh.triangles.size();
    const auto [it, is_new] = reduced_.try_emplace({number, gone}, std::nullopt);
    if (is_new && gone.size() < all) {
      Part part = scene_.parts[number];
      part.levels.clear();
      std::vector<Index> kept;
      for (Index t = 0, next = 0; t < all; ++t)
        if (next < gone.size() && gone[next] == t)
          ++next;
        else
          kept.push_back(t);
      part.mesh = extract_triangles(part.mesh, kept);
      it->second = additions_.add_part(std::move(part));
      original_[*it->second] = original_of(number);
    }
    scene_.nodes[node].part = it->second;
    empty_unused(number);
  }

  /// The part of the bake that a part was made of.
  std::uint32_t original_of(std::uint32_t part) const {
    const auto found = original_.find(part);
    return found == original_.end() ? part : found->second;
  }

  void empty_unused(std::uint32_t part) {
    if (std::any_of(scene_.nodes.begin(), scene_.nodes.end(), [&](const Node& node) { return node.part == part; }))
      return;
    scene_.parts[part].mesh = {};
    scene_.parts[part].levels.clear();
    scene_.parts[part].materials.clear();
  }

  void replace_parts(const CarrierRule& rule, const std::vector<SelectedUse>& uses, CarrierReport& report) {
    const Transform turn = to_y_up(scene_.up);
    const Vec3 up = rule.up.value_or(direction_before(turn, {0, 1, 0}));
    std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::uint32_t> made;  // By part and slots.
    for (const SelectedUse& use : uses) {
      if (determinant(use.world) == 0) continue;
      const std::vector<Index> gone = triangles_of(scene_.parts[use.part].mesh, use.slots);
      if (gone.empty()) continue;
      const auto [it, is_new] = made.try_emplace({use.part, use.slots}, 0);
      if (is_new) {
        CarrierWish wish;
        if (rule.direction) wish.direction = direction_before(use.world, *rule.direction);
        wish.up = direction_before(use.world, up);
        wish.seen_from = point_before(use.world, bounds_.middle());
        CarrierFrame frame = fit_carrier(scene_.parts[use.part].mesh, gone, wish);
        const CarrierFrame covering = frame;
        frame.width_mm *= rule.scale[0], frame.height_mm *= rule.scale[1];
        it->second =
            carrier_part(rule, use.part, gone, {frame, covering},
                         constants_of(original_of(use.part), largest_slot(scene_.parts[use.part].mesh, gone)), report);
      }
      report.triangles += gone.size();
      ++report.carriers;
      remove_triangles(use.node, gone);
      if (scene_.nodes[use.node].part)
        additions_.add_node(rule.name, it->second, use.node);
      else
        scene_.nodes[use.node].part = it->second;
    }
  }

  void replace_region(const CarrierRule& rule, const std::vector<SelectedUse>& uses, CarrierReport& report) {
    const BoxFrame box(*rule.box);
    Part all;  // What goes, in the scene's coordinates.
    std::map<std::uint32_t, std::uint32_t> slot_of;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> below;
    for (const SelectedUse& use : uses) {
      const TriangleMesh& mesh = scene_.parts[use.part].mesh;
      std::vector<Index> gone = triangles_of(mesh, use.slots);
      std::erase_if(gone, [&](Index t) { return !is_within(mesh, t, use.world, box); });
      if (gone.empty()) continue;
      if (!below) below = {original_of(use.part), largest_slot(mesh, gone)};
      append_in_scene(use, gone, all, slot_of);
      report.triangles += gone.size();
      remove_triangles(use.node, gone);
    }
    if (report.triangles == 0) return;
    const CarrierFrame frame{rule.box->at, box.axes(), rule.box->width_mm, rule.box->height_mm};
    const std::uint32_t number = additions_.add_part(std::move(all));
    std::vector<Index> triangles(scene_.parts[number].mesh.triangles.size());
    for (Index t = 0; t < triangles.size(); ++t) triangles[t] = t;
    const std::uint32_t carrier =
        carrier_part(rule, number, triangles, {frame, frame}, constants_of(below->first, below->second), report);
    empty_unused(number);
    ++report.carriers;
    additions_.add_node(rule.name, carrier, std::nullopt);
  }

  /// Appends triangles to a part whose slots are materials of the scene.
  void append_in_scene(const SelectedUse& use, const std::vector<Index>& triangles, Part& all,
                       std::map<std::uint32_t, std::uint32_t>& slot_of) const {
    const Part& part = scene_.parts[use.part];
    TriangleMesh piece = extract_triangles(part.mesh, triangles);
    const Vec3 origin = transform_point(use.world, {});
    const bool is_mirrored = determinant(use.world) < 0;
    for (Vec3& p : piece.positions) p = transform_point(use.world, p);
    for (Vec3& n : piece.normals.values) n = normalized(transform_point(use.world, n) - origin);
    piece.material.resize(piece.triangles.size(), 0);
    for (std::uint32_t& slot : piece.material) {
      const std::uint32_t material = material_of(part, slot).value_or(k_no_material);
      const auto [it, is_new] = slot_of.try_emplace(material, static_cast<std::uint32_t>(all.materials.size()));
      if (is_new) all.materials.push_back(material);
      slot = it->second;
    }
    if (is_mirrored) {
      const auto turn = [](Triangle& corners) { std::swap(corners[1], corners[2]); };
      std::for_each(piece.triangles.begin(), piece.triangles.end(), turn);
      for (auto* attribute : {&piece.uv.indices, &piece.uv1.indices, &piece.normals.indices})
        std::for_each(attribute->begin(), attribute->end(), turn);
    }
    append_mesh(all.mesh, piece);
  }

  struct CarrierFrames {
    CarrierFrame carrier;
    CarrierFrame covering;  ///< What a picture of the part shows.
  };

  /// A part that is one carrier. @param tag  of the constants.
  std::uint32_t carrier_part(const CarrierRule& rule, std::uint32_t number, const std::vector<Index>& gone,
                             const CarrierFrames& frames, std::optional<MaterialTag> tag, CarrierReport& report) {
    const CarrierFrame& frame = frames.carrier;
    const std::uint32_t slot = largest_slot(scene_.parts[number].mesh, gone);
    const Vec2 size{frame.width_mm, frame.height_mm};
    PictureLook look{rule.name, "carrier", nullptr, nullptr, "OPAQUE", rule.roughness, rule.metallic};
    EncodedImage shown, normals;
    const std::string name = fmt::format("carrier.{}.{}", rule.name, ++pictures_);
    if (options_.pictures) {
      std::optional<FeltRelief> felt;
      if (rule.picture.empty()) {
        const Part& part = scene_.parts[number];
        const PartPicture picture =
            picture_of_part(scene_, pyramids_, part.mesh, gone, part.materials, frames.covering, rule.pixels);
        shown = png_image(name, png_of(picture.color));
        normals = png_image(name + ".normal", encode_png(picture.normals));
        look.alpha_mode = has_alpha(picture.color) ? "MASK" : "OPAQUE";
        if (rule.felt && tag) felt = felt_relief(scaled(picture.relief, size), max_slope_of(std::nullopt, *tag), 0);
        look.normal_map = &normals;
      } else {
        const RgbaImage picture = read_carrier_picture(rule);
        shown = png_image(name, png_of(picture));
        look.alpha_mode = alpha_mode_of(picture);
        if (rule.height) {
          if (!tag) tag.emplace();
          felt = felt_relief(relief_of_shown_picture(*rule.height, picture, size.x, size.y),
                             max_slope_of(rule.height->max_slope, *tag), 0);
          normals = png_image(name + ".normal", encode_png(normal_map(felt->relief)));
          look.normal_map = &normals;
        }
      }
      look.picture = &shown;
      if (felt) report.relief_mm = std::max(report.relief_mm, felt->tag.scale_m / k_metres_per_mm);
      if (felt) tag = tag_with(std::move(*tag), *felt);
    }
    Part part;
    part.name = rule.name;
    part.id = scene_.parts[number].id.empty() ? rule.name : scene_.parts[number].id + "/" + rule.name;
    part.mesh = carrier_mesh(frame);
    part.materials = {additions_.add_material(look, material_of(scene_.parts[number], slot), std::move(tag), size)};
    return additions_.add_part(std::move(part));
  }

  /// Over a rectangle of another size.
  static HeightMap scaled(HeightMap relief, Vec2 size_mm) {
    relief.pitch_mm_x = size_mm.x / relief.width, relief.pitch_mm_y = size_mm.y / relief.height;
    return relief;
  }

  static constexpr double k_least_offset_mm = 0.02, k_offset_share = 1e-4;
  static constexpr std::uint32_t k_no_material = 0xffffffffu;

  Scene& scene_;
  const Materials& rules_;
  const ObjectTexturePlaces& places_;
  const ObjectTextureOptions& options_;
  ObjectTextures result_;
  Pyramids pyramids_;
  SceneAdditions additions_;
  Bounds3 bounds_;
  std::size_t pictures_ = 0;
  std::map<std::pair<std::uint32_t, std::vector<Index>>, std::optional<std::uint32_t>> reduced_;
  std::map<std::uint32_t, std::uint32_t> original_;
};

std::vector<PlacedSurface> places_of(const SurfaceSelector& rule, const std::vector<SurfacePlace>& places,
                                     RuleUse& use) {
  std::vector<PlacedSurface> found;
  std::set<std::pair<std::uint32_t, std::uint32_t>> surfaces;
  for (const SurfacePlace& place : places) {
    if (!place.node || !fits(rule, place)) continue;
    found.push_back({*place.node, place.slot});
    surfaces.emplace(place.part, place.slot);
  }
  use.selector = rule.is_empty() ? "all surfaces" : text_of(rule);
  use.surfaces = surfaces.size();
  use.uses = found.size();
  if (found.empty()) use.problem = rule.is_empty() ? "the scene shows no surface" : reason_for_nothing(rule, places);
  return found;
}

}  // namespace

DecalPicture read_decal_picture(const std::filesystem::path& file) {
  DecalPicture picture;
  picture.pixels = read_rgba_image(file);
  picture.png = png_of(picture.pixels);
  return picture;
}

bool has_object_textures(const Materials& rules) { return !rules.decals.empty() || !rules.replace.empty(); }

ObjectTexturePlaces find_object_textures(const Scene& scene, const Materials& rules) {
  ObjectTexturePlaces result;
  result.nodes = scene.nodes.size();
  if (!has_object_textures(rules)) return result;
  const std::vector<SurfacePlace> places = surface_places(scene);
  for (const DecalRule& rule : rules.decals)
    result.decals.push_back(places_of(rule, places, result.decal_uses.emplace_back()));
  for (const CarrierRule& rule : rules.replace)
    result.carriers.push_back(places_of(rule, places, result.carrier_uses.emplace_back()));
  return result;
}

ObjectTextures apply_object_textures(Scene& scene, const Materials& rules, const ObjectTexturePlaces& places,
                                     const ObjectTextureOptions& options) {
  return has_object_textures(rules) ? apply_to_piece(scene, scene_bounds(scene), rules, places, options)
                                    : ObjectTextures{};
}

ObjectTextures apply_to_piece(Scene& piece, const Bounds3& whole, const Materials& rules,
                              const ObjectTexturePlaces& places, const ObjectTextureOptions& options) {
  return Application(piece, whole, rules, places, options).run();
}

}  // namespace papilla
