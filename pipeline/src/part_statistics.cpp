// SPDX-License-Identifier: MIT
#include "papilla/pipeline/part_statistics.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "papilla/core/error.hpp"
#include "papilla/io/node_places.hpp"
#include "papilla/meshing/mesh_bounds.hpp"

namespace papilla {

std::vector<MeshStatistics> part_statistics(const Scene& scene, const ProgressCallback& progress) {
  std::vector<MeshStatistics> result(scene.parts.size());
  oneapi::tbb::parallel_for(std::size_t{0}, scene.parts.size(), [&](std::size_t i) {
    try {
      result[i] = mesh_statistics(scene.parts[i].mesh);
    } catch (const InvalidInput& error) {
      throw InvalidInput("part '" + shown_name(scene.parts[i]) + "': " + error.what());
    }
  });
  report_progress(progress, "measure", 1);
  return result;
}

Bounds3 scene_bounds(const Scene& scene) {
  Bounds3 bounds;
  for (const Instance& use : instances(scene))
    for (const Vec3& p : scene.parts[use.part].mesh.positions) bounds.add(transform_point(use.world, p));
  return bounds;
}

double single_precision_mm(const Scene& scene, bool placed) {
  const auto farthest = [](const Bounds3& bounds) {
    return bounds.is_empty() ? 0 : norm(upper(bounds.high, -bounds.low));
  };
  double distance = placed ? farthest(scene_bounds(scene)) : 0;
  if (!placed)
    for (const Part& part : scene.parts) distance = std::max(distance, farthest(bounds_of(part.mesh)));
  return std::ldexp(distance, -24);
}

std::vector<std::size_t> uses_of_parts(const Scene& scene) {
  std::vector<std::size_t> uses(scene.parts.size(), 0);
  for (const Instance& instance : instances(scene)) ++uses[instance.part];
  return uses;
}

std::vector<std::size_t> triangles_of_materials(const Scene& scene) {
  std::vector<std::size_t> triangles(scene.materials.size(), 0);
  const std::vector<std::size_t> uses = uses_of_parts(scene);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const std::uint32_t slot = part.mesh.material.empty() ? 0 : part.mesh.material[t];
      if (slot < part.materials.size() && part.materials[slot] < triangles.size())
        triangles[part.materials[slot]] += uses[i];
    }
  }
  return triangles;
}

std::vector<std::pair<std::string, std::string>> texture_names(const Scene& scene, const Material& material) {
  std::vector<std::pair<std::string, std::string>> names;
  const auto add = [&](const char* use, const std::optional<TextureReference>& reference) {
    if (!reference || reference->texture >= scene.textures.size()) return;
    const Texture& texture = scene.textures[reference->texture];
    std::string name = texture.name;
    if (texture.image && *texture.image < scene.images.size()) {
      const EncodedImage& image = scene.images[*texture.image];
      name = !image.uri.empty() ? image.uri : !image.name.empty() ? image.name : name;
    }
    names.emplace_back(use, name.empty() ? "texture " + std::to_string(reference->texture) : name);
  };
  add("base_color", material.base_color_texture);
  add("metallic_roughness", material.metallic_roughness_texture);
  add("normal", material.normal_texture);
  add("occlusion", material.occlusion_texture);
  add("emissive", material.emissive_texture);
  return names;
}

MeshStatistics total_statistics(const std::vector<MeshStatistics>& parts) {
  MeshStatistics total;
  total.has_uv = !parts.empty();
  for (const MeshStatistics& s : parts) {
    total.triangles += s.triangles;
    total.vertices += s.vertices;
    total.components += s.components;
    total.boundary_loops += s.boundary_loops;
    total.genus += s.genus;
    total.nonmanifold_edges += s.nonmanifold_edges;
    total.degenerate_triangles += s.degenerate_triangles;
    total.duplicate_triangles += s.duplicate_triangles;
    total.flipped_edges += s.flipped_edges;
    total.t_junctions += s.t_junctions;
    total.aspect_max = std::max(total.aspect_max, s.aspect_max);
    total.has_uv = total.has_uv && s.has_uv;
  }
  return total;
}

}  // namespace papilla
