// SPDX-License-Identifier: MIT
#include "papilla/io/haptic_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>

#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/friction.hpp"
#include "papilla/haptic/roughness_field.hpp"
#include "papilla/haptic/stimulus.hpp"
#include "papilla/io/gltf_triangles.hpp"
#include "papilla/io/height_source.hpp"
#include "papilla/io/tag_manifest.hpp"

namespace papilla {
namespace {

class Builder {
 public:
  Builder(const Scene& scene, const std::filesystem::path& path, const HapticSceneOptions& options)
      : scene_(scene), file_(path), options_(options) {
    result.probe_radius_m = options.probe_radius_m;
  }

  /// @param used  which materials have triangles.
  /// @throws InvalidInput when none has a tag.
  void add_materials(const std::vector<bool>& used) {
    if (const std::string sentence = survival_sentence(scene_.tags); !sentence.empty())
      result.warnings.push_back({"", {"tags_missing", sentence}});
    result.tags = scene_.tags;
    tagged_.resize(scene_.materials.size());
    tex_coord_.resize(scene_.materials.size(), 0);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      std::vector<HapticWarning> warnings = scene_.materials[i].haptic_warnings;
      if (std::optional<MaterialTag> tag = scene_.materials[i].haptic; tag && used[i]) {
        adopt_texture_transform(scene_.materials[i], *tag, warnings);
        tagged_[i] = static_cast<std::uint32_t>(result.materials.size());
        tex_coord_[i] = tex_coord_of(*tag).value_or(0);
        result.names.push_back(scene_.materials[i].name.empty() ? "material " + std::to_string(i)
                                                                : scene_.materials[i].name);
        add_material(*tag, i, warnings);
        any_shading_ = any_shading_ || tag->force_shading;
        any_uv_ = any_uv_ || needs_uv(result.materials.back());
      }
      for (HapticWarning& warning : warnings) result.warnings.push_back({scene_.materials[i].name, std::move(warning)});
    }
    if (!result.materials.empty()) return;
    std::string reason = file_.string() + ": no material has a usable haptic tag";
    if (!result.warnings.empty()) reason += " (" + result.warnings.front().warning.message + ")";
    throw InvalidInput(reason);
  }

  /// Reads the triangles of tagged materials, each primitive once for all its places.
  void add_file(GltfTriangles& file) {
    std::vector<std::vector<Transform>> places(scene_.parts.size());
    for (const Instance& instance : instances(scene_)) places[instance.part].push_back(instance.world);
    const auto for_each_tagged = [&](const auto& use) {
      for (std::uint32_t part = 0; part < scene_.parts.size(); ++part)
        for (const GltfTriangles::Primitive& primitive : file.primitives(part))
          if (!places[part].empty() && tagged_[scene_.parts[part].materials.at(primitive.slot)])
            use(part, primitive, scene_.parts[part].materials[primitive.slot]);
    };
    std::size_t vertices = 0, triangles = 0;
    for_each_tagged([&](std::uint32_t part, const GltfTriangles::Primitive& primitive, std::uint32_t) {
      vertices += std::min(primitive.most_vertices, k_most_reserved) * places[part].size();
      triangles += std::min(primitive.most_triangles, k_most_reserved) * places[part].size();
    });
    reserve(std::min(vertices, k_most_reserved), std::min(triangles, k_most_reserved));
    for_each_tagged([&](std::uint32_t part, const GltfTriangles::Primitive& primitive, std::uint32_t source) {
      const ContactMaterial& material = result.materials[*tagged_[source]];
      const auto channel = needs_uv(material) ? std::optional(tex_coord_[source]) : std::nullopt;
      const GltfPrimitive read = file.read(part, primitive, channel, material.shading);
      for (const Transform& place : places[part]) add_primitive(place, read, source);
    });
  }

  void add_instance(const Instance& instance) {
    const Part& part = scene_.parts[instance.part];
    const TriangleMesh& mesh = part.mesh;
    const auto base = static_cast<std::uint32_t>(result.mesh.positions.size());
    bool used = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t slot = mesh.material.empty() ? 0 : mesh.material[t];
      if (slot >= part.materials.size() || !tagged_[part.materials[slot]]) continue;
      const auto place = [&](std::size_t k) {
        return k_metres_per_mm * transform_point(instance.world, mesh.positions[mesh.triangles[t][k]]);
      };
      if (!options_.reach_around.empty() && !in_reach(place(0), place(1), place(2))) {
        ++result.triangles_out_of_reach;
        continue;
      }
      used = true;
      const std::uint32_t source = part.materials[slot];
      const Triangle& corner = mesh.triangles[t];
      result.mesh.triangles.push_back({base + corner[0], base + corner[1], base + corner[2]});
      result.mesh.material.push_back(*tagged_[source]);
      const auto& uv = tex_coord_[source] == 1 ? mesh.uv1 : mesh.uv;
      const bool has_uv = uv.has_value(t);
      for (std::size_t k = 0; k < 3; ++k)
        result.mesh.corner_uv.push_back(has_uv ? gltf_uv(uv.values[uv.indices[t][k]]) : Vec2{});
      if (any_shading_) add_normals(instance.world, mesh, t, result.materials[*tagged_[source]].shading);
      if (!has_uv && needs_uv(result.materials[*tagged_[source]])) ++without_uv_[source];
    }
    if (!used) return;
    for (const Vec3& p : mesh.positions)
      result.mesh.positions.push_back(k_metres_per_mm * transform_point(instance.world, p));
    if (determinant(instance.world) < 0)
      for (std::size_t t = added_triangles_; t < result.mesh.triangles.size(); ++t) {
        std::swap(result.mesh.triangles[t][1], result.mesh.triangles[t][2]);
        std::swap(result.mesh.corner_uv[3 * t + 1], result.mesh.corner_uv[3 * t + 2]);
        if (any_shading_) std::swap(result.mesh.corner_normals[3 * t + 1], result.mesh.corner_normals[3 * t + 2]);
      }
    added_triangles_ = result.mesh.triangles.size();
  }

  void add_primitive(const Transform& world, const GltfPrimitive& primitive, std::uint32_t source) {
    ContactMesh& mesh = result.mesh;
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& p : primitive.positions)
      mesh.positions.push_back(k_metres_per_mm *
                               transform_point(world, k_mm_per_metre * Vec3{double{p[0]}, double{p[1]}, double{p[2]}}));
    const std::size_t before = mesh.triangles.size();
    const bool mirrored = determinant(world) < 0;
    for (Triangle t : primitive.triangles) {
      for (Index& vertex : t) vertex += base;
      if (mirrored) std::swap(t[1], t[2]);
      if (in_reach(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]))
        mesh.triangles.push_back(t);
      else
        ++result.triangles_out_of_reach;
    }
    const std::size_t added = mesh.triangles.size() - before;
    if (added == 0) {
      mesh.positions.resize(base);
      return;
    }
    mesh.material.resize(mesh.triangles.size(), *tagged_[source]);
    if (primitive.uv.empty() && needs_uv(result.materials[*tagged_[source]])) without_uv_[source] += added;
    if (any_uv_) {
      mesh.vertex_uv.insert(mesh.vertex_uv.end(), primitive.uv.begin(), primitive.uv.end());
      mesh.vertex_uv.resize(mesh.positions.size());
    }
    if (!any_shading_) return;
    for (const auto& n : primitive.normals) {
      const Vec3 turned = turned_normal(world, {double{n[0]}, double{n[1]}, double{n[2]}});
      mesh.vertex_normals.push_back(
          {static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z)});
    }
    mesh.vertex_normals.resize(mesh.positions.size());
  }

  /// Corner normals of a triangle in the frame of the scene; zero, which means the face normal, where there are none.
  void add_normals(const Transform& world, const TriangleMesh& mesh, std::size_t t, bool shaded) {
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 n;
      if (shaded && mesh.normals.has_value(t)) n = mesh.normals.values[mesh.normals.indices[t][k]];
      result.mesh.corner_normals.push_back(turned_normal(world, n));
    }
  }

  /// Normals transform by the cofactors of the matrix.
  static Vec3 turned_normal(const Transform& world, Vec3 n) {
    const Vec3 x{world[0], world[4], world[8]}, y{world[1], world[5], world[9]}, z{world[2], world[6], world[10]};
    const double side = determinant(world) < 0 ? -1 : 1;
    return side * normalized(n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y));
  }

  void finish() {
    for (const auto& [source, flat] : without_uv_)
      result.warnings.push_back({scene_.materials[source].name,
                                 {"uv_missing", std::to_string(flat) + " triangles have no texture coordinates " +
                                                    std::to_string(tex_coord_[source]) +
                                                    ", their relief is flat and their maps are those of one place"}});
    std::size_t degenerate = 0;
    const ContactMesh& mesh = result.mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      degenerate += result.materials[mesh.material[t]].height &&
                    cross(mesh.uv(t, 1) - mesh.uv(t, 0), mesh.uv(t, 2) - mesh.uv(t, 0)) == 0;
    if (mesh.triangles.empty()) throw InvalidInput(file_.string() + ": no triangle has a tagged material");
    if (degenerate > 0 && without_uv_.empty())
      result.warnings.push_back(
          {"",
           {"uv_degenerate", std::to_string(degenerate) +
                                 " triangles with a relief have no area in texture space and are flat across it"}});
  }

  HapticScene result;

 private:
  static constexpr std::size_t k_most_reserved = std::size_t{1} << 24;  // A file may promise what it doesn't hold.

  void reserve(std::size_t vertices, std::size_t triangles) {
    result.mesh.positions.reserve(vertices);
    if (any_uv_) result.mesh.vertex_uv.reserve(vertices);
    if (any_shading_) result.mesh.vertex_normals.reserve(vertices);
    result.mesh.triangles.reserve(triangles);
    result.mesh.material.reserve(triangles);
  }

  static bool needs_uv(const ContactMaterial& material) {
    return material.height || material.stimulus || material.channels;
  }

  /// A material whose pictures are decoded, and what that had to warn of.
  struct Felt {
    MaterialTag tag;
    std::vector<HapticWarning> warnings;
  };

  /// Materials that differ in colour feel the same: their pictures are decoded and kept once.
  void add_material(const MaterialTag& tag, std::size_t material, std::vector<HapticWarning>& warnings) {
    std::size_t like = 0;
    while (like < felt_.size() && !same_feel(felt_[like].tag, tag)) ++like;
    Felt felt{tag, {}};
    for (PlacedPicture* picture : pictures_of(felt.tag)) picture->uri.clear();
    if (like < felt_.size()) {
      felt.warnings = felt_[like].warnings;
      result.materials.push_back(ContactMaterial(result.materials[like]));
    } else {
      result.materials.push_back(contact_material(tag, material, felt.warnings));
    }
    warnings.insert(warnings.end(), felt.warnings.begin(), felt.warnings.end());
    felt_.push_back(std::move(felt));
  }

  ContactMaterial contact_material(const MaterialTag& tag, std::size_t material, std::vector<HapticWarning>& warnings) {
    ContactMaterial made;
    made.stiffness = tag.stiffness;
    made.damping = tag.damping;
    made.static_friction = tag.static_friction;
    made.dynamic_friction = tag.dynamic_friction;
    made.stribeck_velocity = tag.stribeck_velocity;
    if (tag.friction_model) {
      made.friction = friction_model(tag.friction_model->name).value_or(FrictionModel::coulomb);
      made.bristle_stiffness = tag.friction_model->stiffness;
    }
    made.shading = tag.force_shading;
    if (tag.backing) {
      made.backing_stiffness = tag.backing->stiffness;
      made.backing_depth_m = tag.backing->depth_m;
    }
    if (tag.height) made.height = add_relief(tag, material, warnings);
    if (tag.maps) made.channels = add_channels(tag, material, warnings);
    if (!tag.force_model) return made;
    made.model = model_of(tag);
    made.amplitude = tag.force_model->amplitude;
    made.literal_sign = tag.force_model->literal;
    made.form = stimulus_form(made.model, tag.force_model->form).value_or(StimulusForm::usual);
    made.level = tag.force_model->level;
    if (tag.roughness && tag.roughness->fractal_dimension) made.hurst = 3 - *tag.roughness->fractal_dimension;
    if (is_stimulus(made.model)) std::swap(made.height, made.stimulus);
    return made;
  }

  std::optional<std::uint32_t> add_channels(const MaterialTag& tag, std::size_t material,
                                            std::vector<HapticWarning>& warnings) {
    std::optional<ChannelField> field = find_maps(*tag.maps, scene_, file_, material, warnings, options_.probe_radius_m,
                                                  tag.height ? tag.height->metres_per_uv : Vec2{});
    ++(field ? result.channels_loaded : result.channels_missing);
    if (!field) {
      warnings.push_back({"maps_lost", "the maps of stiffness, friction and damping are lost, the constants are used"});
      return std::nullopt;
    }
    result.channels.push_back(std::move(*field));
    return static_cast<std::uint32_t>(result.channels.size() - 1);
  }

  std::optional<std::uint32_t> add_relief(const MaterialTag& tag, std::size_t material,
                                          std::vector<HapticWarning>& warnings) {
    std::optional<HeightField> field = find_height_map(*tag.height, scene_, file_, material, warnings);
    ++(field ? result.maps_loaded : result.maps_missing);
    if (!field && tag.roughness && tag.roughness->rms_height_m > 0) {
      warnings.push_back({"height_from_roughness", "the height map is lost, the relief is made up from the roughness"});
      field = roughness_field(*tag.roughness, tag.height->metres_per_uv, material + 1);
    } else if (!field) {
      warnings.push_back({"height_lost", "the height map is lost and there is no roughness, the surface is smooth"});
      return std::nullopt;
    } else if (tag.roughness && tag.roughness->overlay && options_.overlay) {
      *field = with_roughness(*field, *tag.roughness, tag.height->metres_per_uv, material + 1);
      ++result.roughness_overlays;
    }
    *field = coarsened(std::move(*field), tag.height->metres_per_uv);
    if (is_stimulus(model_of(tag))) {
      result.heights.push_back(std::move(*field));
      return static_cast<std::uint32_t>(result.heights.size() - 1);
    }
    const double steep = steep_share(*field, tag);
    *field = felt(std::move(*field), model_of(tag), tag.height->metres_per_uv, warnings);
    if (steep > 0) warnings.push_back(steep_warning(tag, steep, steep_share(*field, tag)));
    result.heights.push_back(std::move(*field));
    return static_cast<std::uint32_t>(result.heights.size() - 1);
  }

  static ForceModel model_of(const MaterialTag& tag) {
    if (!tag.force_model) return ForceModel::heightfield;
    return force_model(tag.force_model->name).value_or(ForceModel::heightfield);
  }

  /// Share of the map that is steeper than the cone of friction.
  static double steep_share(const HeightField& field, const MaterialTag& tag) {
    const double friction = largest_static_friction(tag);
    return friction > 0 ? field.share_steeper(1 / friction, tag.height->metres_per_uv) : 0;
  }

  HapticWarning steep_warning(const MaterialTag& tag, double share, double felt_share) const {
    const double friction = largest_static_friction(tag);
    char text[256];
    std::snprintf(
        text, sizeof text,
        "haptic.height: %.3g %% of the map is steeper than %.3g, the limit of friction %.3g: a point does not "
        "slide there; as a ball of %.3g mm feels it, %.3g %% is",
        100 * share, 1 / friction, friction, 1e3 * options_.probe_radius_m, 100 * felt_share);
    return {"relief_steep", text};
  }

  /// The relief as the probe feels it. The closest point of `textured-normal` is that of the relief as it is.
  HeightField felt(HeightField field, ForceModel model, Vec2 metres_per_uv,
                   std::vector<HapticWarning>& warnings) const {
    const double peak = options_.felt_depth_m - options_.probe_radius_m;
    if (peak > 0 && model == ForceModel::heightfield) field = field.rounded(peak, metres_per_uv);
    if (options_.probe_radius_m > 0) try {
        field = field.dilated(options_.probe_radius_m, metres_per_uv);
      } catch (const InvalidInput& error) {
        warnings.push_back({"probe_dilation", std::string(error.what()) + ", the relief is felt as by a point"});
      }
    return field;
  }

  /// Tools that change texture coordinates update the transform of the textures, not the tag.
  static void adopt_texture_transform(const Material& material, MaterialTag& tag,
                                      std::vector<HapticWarning>& warnings) {
    const auto& reference = material.normal_texture ? material.normal_texture : material.base_color_texture;
    const std::vector<PlacedPicture*> pictures = pictures_of(tag);
    if (pictures.empty() || !reference || !reference->transform || reference->tex_coord != *tex_coord_of(tag)) return;
    const UvTransform found = *reference->transform, known = pictures.front()->uv_transform;
    if (found == known || found.scale.x == 0 || found.scale.y == 0 || known.scale.x == 0 || known.scale.y == 0) return;
    if (tag.height) {
      // The length of a unit of uv changes with the scale.
      Vec2& metres = tag.height->metres_per_uv;
      metres = {metres.x * std::abs(found.scale.x / known.scale.x), metres.y * std::abs(found.scale.y / known.scale.y)};
    }
    for (PlacedPicture* picture : pictures)
      if (picture->uv_transform == known) picture->uv_transform = found;
    warnings.push_back(
        {"uv_transform", "the tag's pictures follow the texture's KHR_texture_transform, not the tag's"});
  }

  HeightField coarsened(HeightField field, Vec2 metres_per_uv) {
    const auto pitch = [&] {
      const auto texels = field.texels_per_uv();
      return std::min(metres_per_uv.x / norm(texels[0]), metres_per_uv.y / norm(texels[1]));
    };
    // Two new texels must fit into the shortest wavelength.
    bool coarser = false;
    while (4 * pitch() <= options_.shortest_wave_m && field.width() >= 4 && field.height() >= 4 &&
           field.width() % 2 == 0 && field.height() % 2 == 0) {
      field = field.halved();
      coarser = true;
    }
    result.maps_coarsened += coarser;
    return field;
  }

  bool in_reach(Vec3 a, Vec3 b, Vec3 c) const {
    if (options_.reach_around.empty()) return true;
    // Bounding ball of the triangle against the ball around each point.
    const Vec3 middle = (1.0 / 3) * (a + b + c);
    const double radius = std::max({norm(a - middle), norm(b - middle), norm(c - middle)});
    return std::any_of(options_.reach_around.begin(), options_.reach_around.end(),
                       [&](Vec3 p) { return norm(p - middle) <= options_.reach_m + radius; });
  }

  /// From uv with v upwards to that of glTF.
  static Vec2 gltf_uv(Vec2 uv) { return {uv.x, 1 - uv.y}; }

  const Scene& scene_;
  std::filesystem::path file_;
  HapticSceneOptions options_;
  std::vector<std::optional<std::uint32_t>> tagged_;  // Index in result.materials of a scene material with a tag.
  std::vector<int> tex_coord_;
  std::vector<Felt> felt_;
  std::map<std::uint32_t, std::size_t> without_uv_;
  std::size_t added_triangles_ = 0;
  bool any_shading_ = false, any_uv_ = false;
};

}  // namespace

HapticScene haptic_scene(const Scene& scene, const std::filesystem::path& path, const HapticSceneOptions& options) {
  std::vector<bool> used(scene.materials.size(), false);
  for (const Part& part : scene.parts)
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const std::uint32_t slot = part.mesh.material.empty() ? 0 : part.mesh.material[t];
      if (slot < part.materials.size()) used[part.materials[slot]] = true;
    }
  Builder builder(scene, path, options);
  builder.add_materials(used);
  for (const Instance& instance : instances(scene)) builder.add_instance(instance);
  builder.finish();
  return std::move(builder.result);
}

HapticScene load_haptic_scene(const std::filesystem::path& path, const HapticSceneOptions& options) {
  GltfTriangles file(path, options.tags);
  std::vector<bool> used(file.scene.materials.size(), false);
  for (const Part& part : file.scene.parts)
    for (const std::uint32_t material : part.materials) used[material] = true;
  Builder builder(file.scene, path, options);
  builder.add_materials(used);
  file.scene.images = std::vector<EncodedImage>();  // Not {}, which keeps the memory.
  builder.add_file(file);
  builder.finish();
  return std::move(builder.result);
}

LargestMaterial largest_material(const HapticScene& scene) {
  std::vector<double> area(scene.materials.size(), 0.0);
  std::vector<Vec3> moment(scene.materials.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const Vec3 a = scene.mesh.corner(t, 0), b = scene.mesh.corner(t, 1), c = scene.mesh.corner(t, 2);
    const double size = 0.5 * norm(cross(b - a, c - a));
    const std::uint32_t m = scene.mesh.material_of(t);
    area[m] += size;
    moment[m] = moment[m] + (size / 3) * (a + b + c);
  }
  LargestMaterial largest;
  for (std::uint32_t m = 0; m < area.size(); ++m)
    if (area[m] > area[largest.material]) largest.material = m;
  if (area[largest.material] > 0) largest.centre = (1 / area[largest.material]) * moment[largest.material];
  return largest;
}

}  // namespace papilla
