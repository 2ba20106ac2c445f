// SPDX-License-Identifier: MIT
#include "tagged_scene.hpp"

#include <functional>
#include <map>
#include <optional>

#include "height_source.hpp"
#include "papilla/core/error.hpp"
#include "papilla/core/units.hpp"
#include "papilla/haptic/roughness_field.hpp"

namespace papilla::player {
namespace {

class Builder {
 public:
  Builder(const Scene& scene, const std::filesystem::path& path, double radius)
      : scene_(scene), folder_(path.parent_path()), radius_(radius) {}

  void read_materials() {
    felt_.resize(scene_.materials.size());
    tex_coord_.resize(scene_.materials.size(), 0);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      std::vector<HapticWarning> warnings;
      if (const auto tag = material_tag_of_extras(scene_.materials[i].extras_json, warnings)) {
        felt_[i] = static_cast<std::uint32_t>(result.materials.size());
        tex_coord_[i] = tag->height ? tag->height->tex_coord : 0;
        result.names.push_back(scene_.materials[i].name.empty() ? "material " + std::to_string(i)
                                                                : scene_.materials[i].name);
        result.materials.push_back({tag->stiffness, tag->damping, tag->static_friction, tag->dynamic_friction,
                                    tag->stribeck_velocity, relief_of(*tag, i, warnings)});
      }
      for (HapticWarning& warning : warnings) result.warnings.push_back({scene_.materials[i].name, std::move(warning)});
    }
  }

  void add(const Instance& instance) {
    const Part& part = scene_.parts[instance.part];
    const TriangleMesh& mesh = part.mesh;
    const auto base = static_cast<std::uint32_t>(result.mesh.positions.size());
    bool used = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t slot = mesh.material.empty() ? 0 : mesh.material[t];
      if (slot >= part.materials.size() || !felt_[part.materials[slot]]) continue;
      used = true;
      const std::uint32_t source = part.materials[slot];
      const Triangle& corner = mesh.triangles[t];
      result.mesh.triangles.push_back({base + corner[0], base + corner[1], base + corner[2]});
      result.mesh.material.push_back(*felt_[source]);
      const auto& uv = tex_coord_[source] == 1 ? mesh.uv1 : mesh.uv;
      const bool has_uv = uv.has_value(t);
      for (std::size_t k = 0; k < 3; ++k)
        result.mesh.corner_uv.push_back(has_uv ? gltf_uv(uv.values[uv.indices[t][k]]) : Vec2{});
      if (result.materials[*felt_[source]].height) check_uv(source, !has_uv);
    }
    if (!used) return;
    for (const Vec3& p : mesh.positions)
      result.mesh.positions.push_back(k_metres_per_mm * transform_point(instance.world, p));
    if (mirrors(instance.world))
      for (std::size_t t = felt_triangles_; t < result.mesh.triangles.size(); ++t) {
        std::swap(result.mesh.triangles[t][1], result.mesh.triangles[t][2]);
        std::swap(result.mesh.corner_uv[3 * t + 1], result.mesh.corner_uv[3 * t + 2]);
      }
    felt_triangles_ = result.mesh.triangles.size();
  }

  void finish() {
    for (const auto& [source, flat] : without_uv_)
      result.warnings.push_back({scene_.materials[source].name,
                                 {"uv_missing", std::to_string(flat) + " triangles have no texture coordinates " +
                                                    std::to_string(tex_coord_[source]) + ", their relief is flat"}});
    std::size_t degenerate = 0;
    for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t) {
      const Vec2* uv = &result.mesh.corner_uv[3 * t];
      if (result.materials[result.mesh.material[t]].height && cross(uv[1] - uv[0], uv[2] - uv[0]) == 0) ++degenerate;
    }
    if (degenerate > 0 && without_uv_.empty())
      result.warnings.push_back(
          {"",
           {"uv_degenerate", std::to_string(degenerate) +
                                 " triangles with a relief have no area in texture space and are flat across it"}});
  }

  TaggedScene result;

 private:
  std::optional<std::uint32_t> relief_of(const MaterialTag& tag, std::size_t material,
                                         std::vector<HapticWarning>& warnings) {
    if (!tag.height) return std::nullopt;
    std::optional<HeightField> field = find_height_map(*tag.height, scene_, folder_, warnings);
    ++(field ? result.maps_loaded : result.maps_missing);
    if (!field && tag.roughness && tag.roughness->rms_height_m > 0) {
      warnings.push_back({"height_from_roughness", "the height map is lost, the relief is made up from the roughness"});
      field = roughness_field(*tag.roughness, tag.height->metres_per_uv, material + 1);
    } else if (!field) {
      warnings.push_back({"height_lost", "the height map is lost and there is no roughness, the surface is smooth"});
      return std::nullopt;
    }
    if (radius_ > 0) try {
        field = field->dilated(radius_, tag.height->metres_per_uv);
      } catch (const InvalidInput& error) {
        warnings.push_back({"probe_dilation", std::string(error.what()) + ", the relief is felt as by a point"});
      }
    result.heights.push_back(std::move(*field));
    return static_cast<std::uint32_t>(result.heights.size() - 1);
  }

  void check_uv(std::uint32_t source, bool missing) {
    if (missing) ++without_uv_[source];
  }

  /// A scene's uv has v upwards, a height field samples as glTF does.
  static Vec2 gltf_uv(Vec2 uv) { return {uv.x, 1 - uv.y}; }

  static bool mirrors(const Transform& t) {
    return dot(Vec3{t[0], t[4], t[8]}, cross(Vec3{t[1], t[5], t[9]}, Vec3{t[2], t[6], t[10]})) < 0;
  }

  const Scene& scene_;
  std::filesystem::path folder_;
  double radius_;
  std::vector<std::optional<std::uint32_t>> felt_;  // Scene material -> material of the result.
  std::vector<int> tex_coord_;
  std::map<std::uint32_t, std::size_t> without_uv_;
  std::size_t felt_triangles_ = 0;
};

}  // namespace

TaggedScene tagged_scene(const Scene& scene, const std::filesystem::path& path, double probe_radius_m) {
  Builder builder(scene, path, probe_radius_m);
  builder.read_materials();
  if (builder.result.materials.empty()) {
    std::string reason = path.string() + ": no material has a usable haptic tag";
    if (!builder.result.warnings.empty()) reason += " (" + builder.result.warnings.front().warning.message + ")";
    throw InvalidInput(reason);
  }
  for (const Instance& instance : instances(scene)) builder.add(instance);
  builder.finish();
  if (builder.result.mesh.triangles.empty()) throw InvalidInput(path.string() + ": no triangle has a tagged material");
  return std::move(builder.result);
}

LargestMaterial largest_material(const TaggedScene& scene) {
  std::vector<double> area(scene.materials.size(), 0.0);
  std::vector<Vec3> moment(scene.materials.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const auto& corner = scene.mesh.triangles[t];
    const Vec3 a = scene.mesh.positions[corner[0]], b = scene.mesh.positions[corner[1]],
               c = scene.mesh.positions[corner[2]];
    const double size = 0.5 * norm(cross(b - a, c - a));
    const std::uint32_t m = scene.mesh.material[t];
    area[m] += size;
    moment[m] = moment[m] + (size / 3) * (a + b + c);
  }
  LargestMaterial largest;
  for (std::uint32_t m = 0; m < area.size(); ++m)
    if (area[m] > area[largest.material]) largest.material = m;
  if (area[largest.material] > 0) largest.centre = (1 / area[largest.material]) * moment[largest.material];
  return largest;
}

}  // namespace papilla::player
